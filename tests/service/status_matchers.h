// Matchers for both kinds of status, printing code and message.
#pragma once

#include <string>

#include <absl/status/status.h>
#include <gmock/gmock.h>
#include <grpcpp/support/status.h>

#include "patchmill/v1/status.pb.h"

namespace patchmill::testing {

MATCHER_P2(StatusIs, code, message, "") {
  *result_listener << arg.ToString();
  return arg.code() == code &&
         ::testing::ExplainMatchResult(message, std::string(arg.message()), result_listener);
}

MATCHER_P2(RpcStatusIs, code, message, "") {
  *result_listener << arg.error_code() << " " << arg.error_message();
  return arg.error_code() == code &&
         ::testing::ExplainMatchResult(message, arg.error_message(), result_listener);
}

// The ErrorInfo in the details of a status; empty when there is none.
inline v1::ErrorInfo InfoOf(const grpc::Status& status) {
  v1::Status wire;
  v1::ErrorInfo info;
  if (wire.ParseFromString(status.error_details()) && wire.details_size() >= 1)
    wire.details(0).UnpackTo(&info);
  return info;
}

}  // namespace patchmill::testing
