// Calls a method with one request and one answer.
#pragma once

#include "clients/cli/uploading.h"

namespace patchmill::cli {

// Calls `method` of a service, e.g. &v1::ModelService::Stub::CheckModel. A model that is too large for one
// message is uploaded first. Any error of the server is worded for a user.
template <class Stub, class Request, class Response>
absl::StatusOr<Response> Call(const CommonOptions& options, InterruptWatch& watch,
                              grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                              Request request) {
  absl::StatusOr<Connection> connection = ConnectFor(options, watch, request);
  if (!connection.ok()) return connection.status();
  CallScope call(options, watch);
  Stub stub(connection->channel);
  Response response;
  const grpc::Status status = (stub.*method)(call.context(), request, &response);
  if (!status.ok()) return FromGrpc(status, options, watch);
  return response;
}

}  // namespace patchmill::cli
