// What holds for every request, whatever its bytes: it ends with a code and, if it fails, with a reason.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include "patchmill/v1/status.pb.h"
#include "server/errors.h"
#include "server/handlers/get_capabilities.h"
#include "server/handlers/handlers.h"
#include "server/wire_count.h"
#include "server/wire_limits.h"

namespace patchmill::testing {

inline void CheckEnd(const absl::Status& status) {
  if (status.ok()) return;
  const grpc::Status wire = ToGrpcStatus(status);
  v1::Status details;
  v1::ErrorInfo info;
  if (!details.ParseFromString(wire.error_details()) || details.details_size() < 1 ||
      !details.details(0).UnpackTo(&info) || info.reason().empty() || info.reason() == "INTERNAL")
    std::abort();
}

// Counts and parses the bytes as the service does, and calls the handler.
template <class Request, class Handle>
void CheckRequest(const std::string& bytes, const Handle& handle) {
  google::protobuf::io::ArrayInputStream wire(bytes.data(), static_cast<int>(bytes.size()));
  constexpr std::size_t kMemory = std::size_t{64} << 20;
  const auto count = CountWire(wire, bytes.size(), *Request::descriptor(), ListLimits(kMemory));
  if (!count.ok()) return CheckEnd(count.status());
  Request request;
  if (!request.ParseFromString(bytes)) return;
  static auto* const env = [] {
    ServerOptions options;
    options.threads = 1;
    options.store_mib = 0;
    options.max_job_seconds = 0.5;
    return new ServerEnv(options);
  }();
  Call call;
  call.env = env;
  CheckEnd(handle(call, request));
}

template <class Request, class Response>
void CheckUnary(absl::Status (*handler)(const Call&, const Request&, Response*), const std::string& bytes) {
  CheckRequest<Request>(bytes, [&](const Call& call, const Request& request) {
    Response response;
    return handler(call, request, &response);
  });
}

template <class Request, class Response>
void CheckStream(absl::Status (*handler)(const Call&, const Request&, const Sink<Response>&),
                 const std::string& bytes) {
  CheckRequest<Request>(bytes, [&](const Call& call, const Request& request) {
    return handler(call, request, [](const Response&) { return true; });
  });
}

// The first byte says which RPC the others are a request of.
inline void CheckAnyRequest(std::string bytes) {
  if (bytes.empty()) return;
  const auto which = static_cast<unsigned char>(bytes[0]) % 16;
  bytes.erase(0, 1);
  switch (which) {
    case 0:
      return CheckUnary(HandleCheckModel, bytes);
    case 1:
      return CheckUnary(HandleConvertModel, bytes);
    case 2:
      return CheckUnary(HandleBuildModel, bytes);
    case 3:
      return CheckUnary(HandleEditModel, bytes);
    case 4:
      return CheckUnary(HandleFairCurve, bytes);
    case 5:
      return CheckUnary(HandleFairNet, bytes);
    case 6:
      return CheckUnary(HandleSplitRegions, bytes);
    case 7:
      return CheckUnary(HandleTabulateReach, bytes);
    case 8:
      return CheckUnary(HandleTraceLines, bytes);
    case 9:
      return CheckUnary(HandleEvaluateSurface, bytes);
    case 10:
      return CheckUnary(HandleListPosts, bytes);
    case 11:
      return CheckUnary(HandleForgetModel, bytes);
    case 12:
      return CheckUnary(HandleGetCapabilities, bytes);
    case 13:
      return CheckUnary(HandlePreview, bytes);
    case 14:
      return CheckStream(HandleGenerateProgram, bytes);
    default:
      return CheckStream(HandleVerifyProgram, bytes);
  }
}

}  // namespace patchmill::testing
