// Requests whose model may be too large for one message.
#pragma once

#include <utility>

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

// Sends a model in pieces (ModelService.UploadModel), and returns its digest. INVALID_ARGUMENT if it cannot
// be used, with what is wrong with it.
absl::StatusOr<std::string> Upload(const CommonOptions& options, InterruptWatch& watch,
                                   const Connection& connection, const v1::ModelFile& file);

// Whether a server has forgotten the model that a request names, or never had it: another one may have taken
// the upload.
bool LacksModel(const grpc::Status& status);

// Connects to the service and calls `send(connection)`, which makes the call. If the request is too large for
// one message, its model is uploaded first and the request names it by its digest; again, up to three times,
// where the server lacks it. INVALID_ARGUMENT if the request is too large even then. Any error of the server
// is worded for a user.
template <class Request, class Send>
absl::Status SendRequest(const CommonOptions& options, InterruptWatch& watch, Request& request,
                         const Send& send) {
  constexpr int kUploads = 3;
  const bool fits = FitsMessage(request.ByteSizeLong());
  const absl::StatusOr<Connection> connection = Connect(options, fits ? KeepModels::kNo : KeepModels::kYes);
  if (!connection.ok()) return connection.status();
  v1::ModelSource* source = fits ? nullptr : SourceOf(request);
  v1::ModelFile file;
  if (source != nullptr && source->has_file()) file = std::move(*source->mutable_file());
  for (int upload = 1;; ++upload) {
    const bool is_large = source != nullptr && !file.content().empty();
    if (is_large) {
      absl::StatusOr<std::string> digest = Upload(options, watch, *connection, file);
      if (!digest.ok()) return digest.status();
      source->set_model_sha256(*std::move(digest));
    }
    if (absl::Status small = CheckRequestSize(request.ByteSizeLong()); !small.ok()) return small;
    const grpc::Status status = send(*connection);
    if (!is_large || upload == kUploads || !LacksModel(status)) return FromGrpc(status, options, watch);
  }
}

}  // namespace patchmill::cli
