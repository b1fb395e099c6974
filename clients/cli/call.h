// Calls a method with one request and one answer.
#pragma once

#include "clients/cli/uploading.h"

namespace patchmill::cli {

// Calls `method` of a service, e.g. &v1::ModelService::Stub::CheckModel. Errors are those of SendRequest.
template <class Stub, class Request, class Response>
absl::StatusOr<Response> Call(const CommonOptions& options, InterruptWatch& watch,
                              grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                              Request request) {
  Response response;
  const absl::Status status =
      SendRequest(options, watch, request, [&](const Connection& connection, const CommonOptions& left) {
        CallScope call(left, watch);
        response.Clear();
        Stub stub(connection.channel);
        return (stub.*method)(call.context(), request, &response);
      });
  if (!status.ok()) return status;
  return response;
}

}  // namespace patchmill::cli
