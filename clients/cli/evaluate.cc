#include <cmath>
#include <memory>
#include <sstream>

#include <fmt/format.h>

#include "clients/cli/call.h"
#include "clients/cli/commands.h"
#include "clients/cli/job_options.h"
#include "clients/cli/output_file.h"
#include "clients/cli/text.h"
#include "patchmill/v1/analysis_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

struct EvaluateOptions {
  CommonOptions common;
  SetupOptions setup;
  ReadingOptions reading;
  std::string model, output;
  std::vector<std::string> at;
};

// Reads "PATCH,U,V".
absl::Status AddPlace(const std::string& text, v1::EvaluateSurfaceRequest& request) {
  std::istringstream in(text);
  int patch = -1;
  double u = 0.0, v = 0.0;
  char comma[2] = {};
  if (!(in >> patch >> comma[0] >> u >> comma[1] >> v) || comma[0] != ',' || comma[1] != ',' ||
      in.peek() != std::istringstream::traits_type::eof() || patch < 0) {
    return absl::InvalidArgumentError(fmt::format("--at {}; must be PATCH,U,V, patches from 0", text));
  }
  request.add_patch_index(patch);
  request.add_uv(u);
  request.add_uv(v);
  return absl::OkStatus();
}

absl::StatusOr<v1::EvaluateSurfaceRequest> MakeRequest(const EvaluateOptions& options) {
  v1::EvaluateSurfaceRequest request;
  for (const std::string& text : options.at) {
    if (const absl::Status added = AddPlace(text, request); !added.ok()) return added;
  }
  absl::StatusOr<v1::ModelSource> source = ReadModel(options.model, options.reading);
  if (!source.ok()) return source.status();
  absl::StatusOr<v1::Setup> setup = MakeSetup(options.setup);
  if (!setup.ok()) return setup.status();
  *request.mutable_source() = *std::move(source);
  *request.mutable_setup() = *std::move(setup);
  request.set_max_threads(options.common.threads);
  return request;
}

void Print(const v1::EvaluateSurfaceRequest& request, const v1::EvaluateSurfaceResponse& response) {
  for (int k = 0; k < request.patch_index_size(); ++k) {
    const auto three = [&](const google::protobuf::RepeatedField<double>& values) {
      return fmt::format("{:.9g} {:.9g} {:.9g}", values[3 * k], values[3 * k + 1], values[3 * k + 2]);
    };
    const double low = response.principal_curvatures_per_mm(2 * k),
                 high = response.principal_curvatures_per_mm(2 * k + 1);
    fmt::print("patch {} at {:.9g}, {:.9g}\n", request.patch_index(k), request.uv(2 * k),
               request.uv(2 * k + 1));
    fmt::print("  point        {} mm\n  S_u          {}\n  S_v          {}\n", three(response.points_mm()),
               three(response.du_mm()), three(response.dv_mm()));
    fmt::print("  normal       {}\n  E F G        {} mm2\n  L M N        {} mm\n", three(response.normals()),
               three(response.first_form_mm2()), three(response.second_form_mm()));
    fmt::print("  curvatures   {:.9g} {:.9g} per mm; Gauss {:.9g}, mean {:.9g}\n", low, high, low * high,
               0.5 * (low + high));
  }
}

absl::Status Run(const EvaluateOptions& options, InterruptWatch& watch) {
  OutputFile output(options.output, {".json"});
  absl::StatusOr<v1::EvaluateSurfaceRequest> request = MakeRequest(options);
  if (!request.ok()) return request.status();
  if (const absl::Status writable = CheckWritable({&output}); !writable.ok()) return writable;
  absl::StatusOr<v1::EvaluateSurfaceResponse> response =
      Call(options.common, watch, &v1::AnalysisService::Stub::EvaluateSurface, *request);
  if (!response.ok()) return response.status();
  if (output.wanted()) output.Set(Json(*response));
  if (const absl::Status written = Commit({&output}); !written.ok()) return written;
  if (!options.common.quiet) Print(*request, *response);
  return absl::OkStatus();
}

}  // namespace

Command AddEvaluate(CLI::App& app) {
  auto options = std::make_shared<EvaluateOptions>();
  app.add_option("MODEL", options->model, kModelHelp)->required();
  app.add_option(
         "--at", options->at,
         "PATCH,U,V: index of the patch, from 0, and parameters in [0,1]; several are separated by blanks")
      ->required();
  app.add_option("-o,--output", options->output, "write the values, too: .json");
  AddReadingOptions(app, options->reading);
  AddSetupOptions(app, options->setup);
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
