#include "clients/cli/uploading.h"

#include <algorithm>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include "clients/cli/text.h"
#include "core/base/digest.h"
#include "patchmill/v1/model_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;

grpc::Status Unusable(const v1::UploadModelResponse& response) {
  std::string message = "the model cannot be used";
  for (const v1::Diagnostic& finding : response.diagnostics())
    if (finding.severity() == v1::SEVERITY_ERROR) message += "\n  " + Line(finding);
  return {grpc::StatusCode::INVALID_ARGUMENT, message};
}

grpc::Status Upload(const CommonOptions& options, InterruptWatch& watch, const Connection& connection,
                    const LargeModel& model) {
  const v1::ModelFile& file = model.file;
  const std::string& content = file.content();
  v1::UploadModelRequest message;
  v1::UploadStart& start = *message.mutable_start();
  start.set_size_bytes(static_cast<std::int64_t>(content.size()));
  start.set_content_sha256(Sha256(content));
  start.set_format(file.format());
  start.set_length_unit(file.length_unit());
  if (file.has_import_options()) *start.mutable_import_options() = file.import_options();

  CallScope call(options, watch);
  const auto stub = v1::ModelService::NewStub(connection.channel);
  v1::UploadModelResponse response;
  const auto writer = stub->UploadModel(call.context(), &response);
  bool open = writer->Write(message);
  for (std::size_t at = 0; open && at < content.size(); at += kPiece) {
    message.set_chunk(content.substr(at, kPiece));
    open = writer->Write(message);
  }
  writer->WritesDone();
  grpc::Status status = writer->Finish();
  if (!status.ok()) return status;
  if (response.model_sha256().empty()) return Unusable(response);
  model.source->set_model_sha256(std::move(*response.mutable_model_sha256()));
  return status;
}

}  // namespace

grpc::Status UploadAll(const CommonOptions& options, InterruptWatch& watch, const Connection& connection,
                       const std::vector<LargeModel>& models) {
  for (const LargeModel& model : models) {
    if (grpc::Status status = Upload(options, watch, connection, model); !status.ok()) return status;
  }
  return grpc::Status::OK;
}

void WaitForNextTry(const CommonOptions& options, const absl::Status& why, std::chrono::milliseconds wait) {
  if (!options.quiet) fmt::print(stderr, "patchmill: {}; trying again\n", std::string(why.message()));
  std::this_thread::sleep_for(wait);
}

bool LacksModel(const grpc::Status& status) {
  return status.error_code() == grpc::StatusCode::NOT_FOUND && ReasonOf(status) == "MODEL_NOT_CACHED";
}

}  // namespace patchmill::cli
