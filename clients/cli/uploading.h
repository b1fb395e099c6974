// Requests whose models may be too large for one message.
#pragma once

#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "clients/cli/connection.h"
#include "clients/cli/retrying.h"
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

// Whether a server has forgotten the model that a request names, or never had it: another one may have taken
// the upload.
bool LacksModel(const grpc::Status& status);

// A model that is sent in pieces, and its place in the request.
struct LargeModel {
  v1::ModelSource* source = nullptr;
  v1::ModelFile file;
};

// Sends the models in pieces (ModelService.UploadModel), and names them in the request by their digests.
// INVALID_ARGUMENT if one of them cannot be used, with what is wrong with it.
grpc::Status UploadAll(const CommonOptions& options, InterruptWatch& watch, const Connection& connection,
                       const std::vector<LargeModel>& models);

// Says that a call is made again, and waits.
void WaitForNextTry(const CommonOptions& options, const absl::Status& why, std::chrono::milliseconds wait);

// Connects to the service and calls `send(connection, options)`, which makes the call; `send` may be called
// again after it failed, and forgets what it has received. If the request is too large for one message, its
// models are uploaded first and the request names them by their digests. Where the server lacks one, all are
// uploaded again, up to three times in all. Where the server is lost, the call is made again as Tries allows.
// INVALID_ARGUMENT if the request is too large even then. Any error of the server is worded for a user.
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
  Tries tries(options);
  for (int uploads_left = kUploads;;) {
    const CommonOptions left = tries.Left();
    grpc::Status status = UploadAll(left, watch, *connection, large);
    if (status.ok()) {
      if (absl::Status small = CheckRequestSize(request.ByteSizeLong()); !small.ok()) return small;
      status = send(*connection, left);
    }
    if (status.ok()) return absl::OkStatus();
    if (!large.empty() && LacksModel(status) && --uploads_left > 0) continue;
    const std::optional<std::chrono::milliseconds> wait =
        watch.interrupted() ? std::nullopt : tries.WaitAfter(status);
    if (!wait) return FromGrpc(tries.Reported(status), options, watch);
    WaitForNextTry(options, FromGrpc(status, options, watch), *wait);
  }
}

}  // namespace patchmill::cli
