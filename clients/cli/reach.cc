#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "clients/cli/call.h"
#include "clients/cli/commands.h"
#include "clients/cli/job_options.h"
#include "clients/cli/output_file.h"
#include "clients/cli/text.h"
#include "patchmill/v1/analysis_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

struct ReachOptions {
  CommonOptions common;
  SetupOptions setup;
  ReadingOptions reading;
  OperationOptions operation;
  std::string model, output;
  std::vector<double> diameters = {1, 2, 3, 4, 6, 8, 10, 12};
};

absl::StatusOr<v1::TabulateReachRequest> MakeRequest(const ReachOptions& options) {
  v1::TabulateReachRequest request;
  absl::StatusOr<v1::ModelSource> source = ReadModel(options.model, options.reading);
  if (!source.ok()) return source.status();
  absl::StatusOr<v1::Setup> setup = MakeSetup(options.setup, options.reading.length_unit);
  if (!setup.ok()) return setup.status();
  v1::Job& job = *request.mutable_job();
  *job.mutable_source() = *std::move(source);
  *job.mutable_setup() = *std::move(setup);
  absl::StatusOr<v1::Operation> operation = MakeOperation(options.operation);
  if (!operation.ok()) return operation.status();
  *job.add_operations() = *std::move(operation);
  job.set_name(WireText(std::filesystem::path(options.model).filename().string(), 100));
  for (const double diameter : options.diameters) request.add_tool_diameters_mm(diameter);
  request.set_max_threads(options.common.threads);
  return request;
}

void Print(const v1::TabulateReachResponse& response) {
  fmt::print("{:>12} {:>20} {:>8} {:>20}\n", "diameter, mm", "unreachable, mm2", "share",
             "largest tool of, mm2");
  for (const v1::ReachEntry& entry : response.entries()) {
    fmt::print("{:>12g} {:>20.3f} {:>7.2f}% {:>20.3f}\n", entry.tool_diameter_mm(),
               entry.unreachable_area_mm2(), 100.0 * entry.unreachable_area_mm2() / response.area_mm2(),
               entry.largest_tool_area_mm2());
  }
}

absl::Status Run(const ReachOptions& options, InterruptWatch& watch) {
  OutputFile output(options.output, {".json"});
  absl::StatusOr<v1::TabulateReachRequest> request = MakeRequest(options);
  if (!request.ok()) return request.status();
  if (const absl::Status writable = CheckWritable({&output}); !writable.ok()) return writable;
  absl::StatusOr<v1::TabulateReachResponse> response =
      Call(options.common, watch, &v1::AnalysisService::Stub::TabulateReach, *request);
  if (!response.ok()) return response.status();
  if (output.wanted()) output.Set(Json(*response));
  if (const absl::Status written = Commit({&output}); !written.ok()) return written;
  if (!output.is_standard() && (!options.common.quiet || !output.wanted())) Print(*response);
  return absl::OkStatus();
}

}  // namespace

Command AddReach(CLI::App& app) {
  auto options = std::make_shared<ReachOptions>();
  OperationOptions& op = options->operation;
  app.add_option("MODEL", options->model, kModelHelp)->required();
  app.add_option("-o,--output", options->output, "write the table: .json");
  app.add_option("--tool-diameters", options->diameters,
                 "diameters of the balls, mm, rising, separated by commas")
      ->delimiter(',')
      ->capture_default_str();
  AddNumber(app, "--tolerance", op.tolerance, "whole error budget of the job, mm");
  AddNumber(app, "--leave", op.leave, "stock to leave along the normal, mm");
  AddNumber(app, "--floor", op.floor, "lowest tip, mm, program frame; default: lowest point of the model");
  AddReadingOptions(app, options->reading);
  AddSetupOptions(app, options->setup);
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
