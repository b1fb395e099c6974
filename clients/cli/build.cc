#include <memory>

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include "clients/cli/commands.h"
#include "clients/cli/input_file.h"
#include "clients/cli/job_options.h"
#include "clients/cli/output_file.h"
#include "clients/cli/text.h"
#include "patchmill/v1/model_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

struct BuildOptions {
  CommonOptions common;
  std::string outline, output, network;
};

absl::Status CheckEnding(const std::string& path) {
  if (path.empty() || path.ends_with(".json") || path.ends_with(".pb")) return absl::OkStatus();
  return absl::InvalidArgumentError(fmt::format("{}; must end in .json or .pb", path));
}

std::string Bytes(const v1::PatchModel& model, const std::string& path) {
  return path.ends_with(".pb") ? model.SerializeAsString() : ShortJson(model);
}

absl::StatusOr<v1::BuildModelRequest> MakeRequest(const BuildOptions& options) {
  absl::StatusOr<std::string> text = ReadWholeFile(options.outline);
  if (!text.ok()) return text.status();
  v1::BuildModelRequest request;
  const auto status = google::protobuf::util::JsonStringToMessage(*text, &request);
  if (!status.ok()) {
    return absl::InvalidArgumentError(
        fmt::format("{}: not an outline in JSON: {}", options.outline, std::string(status.message())));
  }
  if (!options.network.empty() && !request.has_network()) {
    return absl::InvalidArgumentError(
        fmt::format("--network {}: {} has no network", options.network, options.outline));
  }
  request.set_max_threads(options.common.threads);
  if (const absl::Status fits = CheckRequestSize(request.ByteSizeLong()); !fits.ok()) return fits;
  return request;
}

absl::Status Run(const BuildOptions& options, InterruptWatch& watch) {
  OutputFile output(options.output), network(options.network);
  for (const OutputFile* file : {&output, &network}) {
    if (!file->wanted()) continue;
    if (const absl::Status ending = CheckEnding(file->path()); !ending.ok()) return ending;
    if (const absl::Status writable = file->CheckWritable(); !writable.ok()) return writable;
  }
  absl::StatusOr<v1::BuildModelRequest> request = MakeRequest(options);
  if (!request.ok()) return request.status();
  absl::StatusOr<Connection> connection = Connect(options.common);
  if (!connection.ok()) return connection.status();

  CallScope call(options.common, watch);
  v1::BuildModelResponse response;
  const grpc::Status status =
      v1::ModelService::NewStub(connection->channel)->BuildModel(call.context(), *request, &response);
  if (!status.ok()) return FromGrpc(status, options.common, watch);
  int errors = 0;
  for (const v1::Diagnostic& finding : response.diagnostics()) {
    if (finding.severity() == v1::SEVERITY_ERROR) ++errors;
    if (!options.common.quiet) fmt::print(stderr, "  {}\n", Line(finding));
  }
  if (errors > 0) {
    return absl::FailedPreconditionError(
        fmt::format("{}: {} errors; nothing is written", options.outline, errors));
  }
  output.Set(Bytes(response.model(), options.output));
  network.Set(Bytes(response.network_model(), options.network));
  for (const OutputFile* file : {&network, &output}) {
    if (!file->wanted()) continue;
    if (const absl::Status written = file->Commit(); !written.ok()) return written;
  }
  if (request->has_network() && !options.common.quiet) {
    fmt::print(stderr, "{}: {} vertices, at most {:.4g} mm from the surface (vertex {})\n", options.outline,
               request->network().vertices_size(), response.max_distance_mm(), response.farthest_vertex());
  }
  return absl::OkStatus();
}

}  // namespace

Command AddBuild(CLI::App& app) {
  auto options = std::make_shared<BuildOptions>();
  app.add_option("OUTLINE", options->outline, "sections or boundary curves, .json: a BuildModelRequest")
      ->required();
  app.add_option("-o,--output", options->output, "the surface as a model, .json or .pb")->required();
  app.add_option("--network", options->network,
                 "the outline's network with normals of the surface, .json or .pb");
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
