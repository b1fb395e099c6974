#include <memory>

#include <fmt/format.h>

#include "clients/cli/call.h"
#include "clients/cli/commands.h"
#include "clients/cli/input_file.h"
#include "clients/cli/job_options.h"
#include "clients/cli/model_file.h"
#include "clients/cli/text.h"
#include "patchmill/v1/model_service.grpc.pb.h"
#include "proto/json/json_message.h"

namespace patchmill::cli {
namespace {

struct BuildOptions {
  CommonOptions common;
  std::string outline, output, network;
};

absl::StatusOr<v1::BuildModelRequest> MakeRequest(const BuildOptions& options) {
  absl::StatusOr<std::string> text = ReadWholeFile(options.outline);
  if (!text.ok()) return text.status();
  v1::BuildModelRequest request;
  const absl::Status status = ReadJsonMessage(*text, request);
  if (!status.ok()) {
    return absl::InvalidArgumentError(
        fmt::format("{}: not an outline in JSON: {}", options.outline, std::string(status.message())));
  }
  if (!options.network.empty() && !request.has_network()) {
    return absl::InvalidArgumentError(
        fmt::format("--network {}: {} has no network", options.network, options.outline));
  }
  request.set_max_threads(options.common.threads);
  return request;
}

absl::Status Run(const BuildOptions& options, InterruptWatch& watch) {
  OutputFile output = ModelFile(options.output), network = ModelFile(options.network);
  absl::StatusOr<v1::BuildModelRequest> request = MakeRequest(options);
  if (!request.ok()) return request.status();
  if (const absl::Status writable = CheckWritable({&output, &network}); !writable.ok()) return writable;
  absl::StatusOr<v1::BuildModelResponse> response =
      Call(options.common, watch, &v1::ModelService::Stub::BuildModel, *request);
  if (!response.ok()) return response.status();
  if (!options.common.quiet) {
    for (const v1::Diagnostic& finding : response->diagnostics()) fmt::print(stderr, "  {}\n", Line(finding));
  }
  if (const int errors = CountErrors(response->diagnostics()); errors > 0) {
    return absl::FailedPreconditionError(
        fmt::format("{}: {} errors; no file was written", options.outline, errors));
  }
  SetModel(response->model(), output);
  SetModel(response->network_model(), network);
  if (const absl::Status written = Commit({&network, &output}); !written.ok()) return written;
  if (request->has_network() && !options.common.quiet) {
    fmt::print(stderr, "{}: {} vertices, at most {:.4g} mm from the surface (vertex {})\n", options.outline,
               request->network().vertices_size(), response->max_distance_mm(), response->farthest_vertex());
  }
  return absl::OkStatus();
}

}  // namespace

Command AddBuild(CLI::App& app) {
  auto options = std::make_shared<BuildOptions>();
  app.add_option("OUTLINE", options->outline,
                 "file with sections or boundary curves: a BuildModelRequest as .json")
      ->required();
  app.add_option("-o,--output", options->output, "the surface as a model, .json or .pb")->required();
  app.add_option("--network", options->network,
                 "write the network of OUTLINE with normals of the surface: .json or .pb");
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
