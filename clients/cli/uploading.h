// Requests whose models may be too large for one message.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "clients/cli/connection.h"
#include "patchmill/v1/model.pb.h"

namespace patchmill::cli {

// The models of a request: that of the part, and that of its stock.
template <class Request>
std::vector<v1::ModelSource*> ModelsOf(Request& request) {
  std::vector<v1::ModelSource*> models;
  const auto add = [&models](auto& from) {
    if constexpr (requires { from.mutable_source(); }) models.push_back(from.mutable_source());
    if constexpr (requires { from.mutable_setup()->mutable_stock(); }) {
      if (from.setup().stock().has_model())
        models.push_back(from.mutable_setup()->mutable_stock()->mutable_model());
    }
  };
  if constexpr (requires { request.mutable_job(); }) {
    add(*request.mutable_job());
  } else {
    add(request);
  }
  return models;
}

// Sends a model in pieces (ModelService.UploadModel), and returns its digest. INVALID_ARGUMENT if it cannot
// be used, with what is wrong with it.
absl::StatusOr<std::string> Upload(const CommonOptions& options, InterruptWatch& watch,
                                   const Connection& connection, const v1::ModelFile& file);

// Whether a server has forgotten the model that a request names, or never had it: another one may have taken
// the upload.
bool LacksModel(const grpc::Status& status);

// A model that is sent in pieces, and its place in the request.
struct LargeModel {
  v1::ModelSource* source = nullptr;
  v1::ModelFile file;
};

// Connects to the service and calls `send(connection)`, which makes the call. If the request is too large for
// one message, its models are uploaded first and the request names them by their digests. Where the server
// lacks one, all are uploaded again, up to three times in all. INVALID_ARGUMENT if the request is too large
// even then. Any error of the server is worded for a user.
template <class Request, class Send>
absl::Status SendRequest(const CommonOptions& options, InterruptWatch& watch, Request& request,
                         const Send& send) {
  constexpr int kUploads = 3;
  const bool fits = FitsMessage(request.ByteSizeLong());
  const absl::StatusOr<Connection> connection = Connect(options, fits ? KeepModels::kNo : KeepModels::kYes);
  if (!connection.ok()) return connection.status();
  std::vector<LargeModel> large;
  if (!fits) {
    for (v1::ModelSource* source : ModelsOf(request))
      if (source->has_file()) large.push_back({source, std::move(*source->mutable_file())});
  }
  for (int upload = 1;; ++upload) {
    for (const LargeModel& model : large) {
      absl::StatusOr<std::string> digest = Upload(options, watch, *connection, model.file);
      if (!digest.ok()) return digest.status();
      model.source->set_model_sha256(*std::move(digest));
    }
    if (absl::Status small = CheckRequestSize(request.ByteSizeLong()); !small.ok()) return small;
    const grpc::Status status = send(*connection);
    if (large.empty() || upload == kUploads || !LacksModel(status)) return FromGrpc(status, options, watch);
  }
}

}  // namespace patchmill::cli
