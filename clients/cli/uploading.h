// Models that are too large for one message.
#pragma once

#include "clients/cli/connection.h"
#include "patchmill/v1/model.pb.h"

namespace patchmill::cli {

// The model of a request, if it has one.
template <class Request>
v1::ModelSource* SourceOf(Request& request) {
  if constexpr (requires { request.mutable_job()->mutable_source(); }) {
    return request.mutable_job()->mutable_source();
  } else if constexpr (requires { request.mutable_source(); }) {
    return request.mutable_source();
  } else {
    return nullptr;
  }
}

// Sends the model in pieces (ModelService.UploadModel). `source` names it by its digest afterwards.
// INVALID_ARGUMENT if it cannot be used, with what is wrong with it.
absl::Status Upload(const CommonOptions& options, InterruptWatch& watch, const Connection& connection,
                    v1::ModelSource& source);

// Connects to the service. If the request is too large for one message, its model is uploaded first.
// INVALID_ARGUMENT if the request is too large even then.
template <class Request>
absl::StatusOr<Connection> ConnectFor(const CommonOptions& options, InterruptWatch& watch, Request& request) {
  const bool fits = FitsMessage(request.ByteSizeLong());
  absl::StatusOr<Connection> connection = Connect(options, fits ? KeepModels::kNo : KeepModels::kYes);
  if (!connection.ok() || fits) return connection;
  v1::ModelSource* source = SourceOf(request);
  if (source != nullptr && source->has_file()) {
    if (absl::Status sent = Upload(options, watch, *connection, *source); !sent.ok()) return sent;
  }
  if (absl::Status small = CheckRequestSize(request.ByteSizeLong()); !small.ok()) return small;
  return connection;
}

}  // namespace patchmill::cli
