// Calls a method with one request and one answer.
#pragma once

#include "clients/cli/connection.h"

namespace patchmill::cli {

// Calls `method` of a service, e.g. &v1::ModelService::Stub::CheckModel. INVALID_ARGUMENT if the request is
// too large for the wire. Any other error is that of the server, worded for a user.
template <class Stub, class Request, class Response>
absl::StatusOr<Response> Call(const CommonOptions& options, InterruptWatch& watch,
                              grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                              const Request& request) {
  if (const absl::Status fits = CheckRequestSize(request.ByteSizeLong()); !fits.ok()) return fits;
  absl::StatusOr<Connection> connection = Connect(options);
  if (!connection.ok()) return connection.status();
  CallScope call(options, watch);
  Stub stub(connection->channel);
  Response response;
  const grpc::Status status = (stub.*method)(call.context(), request, &response);
  if (!status.ok()) return FromGrpc(status, options, watch);
  return response;
}

}  // namespace patchmill::cli
