#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "clients/cli/commands.h"
#include "clients/cli/job_options.h"
#include "clients/cli/limit_options.h"
#include "clients/cli/output_file.h"
#include "clients/cli/text.h"
#include "patchmill/v1/analysis_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

struct RegionsOptions {
  CommonOptions common;
  SetupOptions setup;
  OperationOptions operation;
  LimitOptions limits;
  std::string model, output;
};

absl::Status Run(const RegionsOptions& options, InterruptWatch& watch) {
  const std::string ending = std::filesystem::path(options.output).extension().string();
  if (ending != ".json" && ending != ".svg") {
    return absl::InvalidArgumentError(fmt::format("-o {}; must end in .json or .svg", options.output));
  }
  OutputFile output(options.output);
  if (const absl::Status writable = output.CheckWritable(); !writable.ok()) return writable;
  v1::SplitRegionsRequest request;
  absl::StatusOr<v1::ModelSource> source = ReadModel(options.model);
  if (!source.ok()) return source.status();
  absl::StatusOr<v1::Setup> setup = MakeSetup(options.setup);
  if (!setup.ok()) return setup.status();
  v1::Job& job = *request.mutable_job();
  *job.mutable_source() = *std::move(source);
  *job.mutable_setup() = *std::move(setup);
  v1::Operation& operation = *job.add_operations();
  operation = MakeOperation(options.operation);
  v1::Selection selection;
  if (const absl::Status set = SetLimits(options.limits, *job.mutable_setup(), selection); !set.ok())
    return set;
  if (Selects(options.limits)) *operation.mutable_selection() = std::move(selection);
  if (options.limits.top) operation.mutable_heights()->set_top_z_mm(*options.limits.top);
  job.set_name(WireText(std::filesystem::path(options.model).filename().string(), 100));
  request.add_outputs(ending == ".svg" ? v1::OUTPUT_PICTURE : v1::OUTPUT_REGIONS);
  request.set_max_threads(options.common.threads);
  if (const absl::Status fits = CheckRequestSize(request.ByteSizeLong()); !fits.ok()) return fits;
  absl::StatusOr<Connection> connection = Connect(options.common);
  if (!connection.ok()) return connection.status();

  CallScope call(options.common, watch);
  v1::SplitRegionsResponse response;
  const grpc::Status status =
      v1::AnalysisService::NewStub(connection->channel)->SplitRegions(call.context(), request, &response);
  if (!status.ok()) return FromGrpc(status, options.common, watch);
  output.Set(ending == ".svg" ? response.picture().data() : Json(response));
  return output.Commit();
}

}  // namespace

Command AddRegions(CLI::App& app) {
  auto options = std::make_shared<RegionsOptions>();
  OperationOptions& op = options->operation;
  app.add_option("MODEL", options->model, kModelHelp)->required();
  app.add_option("-o,--output", options->output, "the region map: .json or .svg")->required();
  AddNumber(app, "--tool-diameter", op.tool_diameter, "ball diameter, mm");
  AddNumber(app, "--scallop", op.scallop, "largest ridge between passes, mm");
  AddNumber(app, "--tolerance", op.tolerance, "whole error budget, mm");
  AddNumber(app, "--leave", op.leave, "material left along the normal, mm");
  AddNumber(app, "--steep-angle", op.steep_angle, "above this a region is steep, degrees");
  AddNumber(app, "--floor", op.floor, "lowest tip, mm, program frame; default: the model's lowest point");
  AddLimitOptions(app, options->limits);
  AddSetupOptions(app, options->setup);
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
