#include "server/operate/caller_errors.h"

#include <string>

#include <absl/strings/cord.h>
#include <fmt/format.h>

#include "patchmill/v1/status.pb.h"

namespace patchmill {
namespace {

// As in server/errors.cc, which makes the status of gRPC of them.
constexpr char kInfoUrl[] = "type.googleapis.com/patchmill.v1.ErrorInfo";
constexpr char kRetryUrl[] = "type.googleapis.com/google.rpc.RetryInfo";

}  // namespace

absl::Status UnauthenticatedError(std::string_view reason, std::string_view message) {
  v1::ErrorInfo info;
  info.set_reason(std::string(reason));
  absl::Status status(absl::StatusCode::kUnauthenticated, {message.data(), message.size()});
  status.SetPayload(kInfoUrl, absl::Cord(info.SerializeAsString()));
  return status;
}

absl::Status QuotaError(std::string_view limit, double limit_value, double actual_value,
                        std::optional<std::chrono::milliseconds> delay) {
  v1::ErrorInfo info;
  info.set_reason("QUOTA_EXCEEDED");
  info.set_limit(std::string(limit));
  info.set_limit_value(limit_value);
  info.set_actual_value(actual_value);
  const std::string later =
      delay ? fmt::format("; try again in {:.3g} s", static_cast<double>(delay->count()) / 1000.0) : "";
  absl::Status status = absl::ResourceExhaustedError(fmt::format(
      "{} = {:.10g}; the quota of this caller is {:.10g}{}", limit, actual_value, limit_value, later));
  status.SetPayload(kInfoUrl, absl::Cord(info.SerializeAsString()));
  if (delay) {
    v1::RetryInfo retry;
    retry.mutable_retry_delay()->set_seconds(delay->count() / 1000);
    retry.mutable_retry_delay()->set_nanos(static_cast<int>(delay->count() % 1000) * 1'000'000);
    status.SetPayload(kRetryUrl, absl::Cord(retry.SerializeAsString()));
  }
  return status;
}

}  // namespace patchmill
