#include <filesystem>
#include <map>
#include <memory>

#include <absl/strings/ascii.h>
#include <fmt/format.h>

#include "clients/cli/call.h"
#include "clients/cli/commands.h"
#include "clients/cli/input_file.h"
#include "clients/cli/job_options.h"
#include "clients/cli/model_file.h"
#include "clients/cli/text.h"
#include "patchmill/v1/model_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

struct ConvertOptions {
  CommonOptions common;
  ReadingOptions reading;
  std::string model, output;
  double scale = 1.0;
  std::optional<double> chord;
};

// The formats of files for other systems, by their endings.
const std::map<std::string, std::string> kFileFormats = {
    {".igs", "iges"}, {".iges", "iges"}, {".stp", "step"}, {".step", "step"},
    {".p21", "step"}, {".stl", "stl"},   {".obj", "obj"}};

std::string FormatOf(const std::string& path) {
  const auto at = kFileFormats.find(absl::AsciiStrToLower(std::filesystem::path(path).extension().native()));
  return at == kFileFormats.end() ? "" : at->second;
}

OutputFile OutputOf(const std::string& path) {
  std::vector<std::string> endings = {".json", ".pb"};
  for (const auto& [ending, format] : kFileFormats) endings.push_back(ending);
  return OutputFile(path, std::move(endings));
}

void PrintSummary(const ConvertOptions& options, const v1::ConvertModelResponse& response) {
  // Warnings are said, whatever --quiet says.
  for (const v1::Diagnostic& finding : response.diagnostics()) {
    if (options.common.quiet && finding.severity() == v1::SEVERITY_INFO) continue;
    fmt::print(stderr, "  {}\n", Line(finding));
  }
  if (options.common.quiet) return;
  const v1::PatchModel& model = response.model();
  if (const std::string format = FormatOf(options.output); !format.empty()) {
    const bool triangles = format == "stl" || format == "obj";
    fmt::print(stderr, "{}: {} {}, in mm\n", options.output, response.file_item_count(),
               triangles ? "triangles" : "B-spline surfaces");
  } else if (model.has_network()) {
    fmt::print(stderr, "{}: a curve network of {} faces\n", options.output, model.network().faces_size());
  } else {
    fmt::print(stderr, "{}: {} patches of {} faces, in mm\n", options.output, model.patches_size(),
               model.faces_size());
  }
}

absl::Status Run(const ConvertOptions& options, InterruptWatch& watch) {
  OutputFile output = OutputOf(options.output);
  v1::ConvertModelRequest request;
  request.set_file_format(FormatOf(options.output));
  if (options.chord) request.set_chord_mm(*options.chord);
  absl::StatusOr<v1::ModelSource> source = ReadModel(options.model, options.reading);
  if (!source.ok()) return source.status();
  if (const absl::Status writable = CheckWritable({&output}); !writable.ok()) return writable;
  *request.mutable_source() = *std::move(source);
  request.set_scale(options.scale);
  request.set_max_threads(options.common.threads);
  absl::StatusOr<v1::ConvertModelResponse> response =
      Call(options.common, watch, &v1::ModelService::Stub::ConvertModel, request);
  if (!response.ok()) return response.status();
  if (const int errors = CountErrors(response->diagnostics()); errors > 0) {
    for (const v1::Diagnostic& finding : response->diagnostics()) fmt::print(stderr, "  {}\n", Line(finding));
    return absl::FailedPreconditionError(
        fmt::format("{}: {} errors; no file was written", options.model, errors));
  }
  if (request.file_format().empty()) {
    SetModel(response->model(), output);
  } else {
    output.Set(response->file());
  }
  if (output.size() > kMaxFileBytes) {
    return absl::FailedPreconditionError(
        fmt::format("{} would have {} MiB, and no command reads more than {}; {}", options.output,
                    output.size() >> 20, kMaxFileBytes >> 20,
                    output.EndsIn(".pb") ? "convert the part in pieces" : "write a .pb, which is smaller"));
  }
  if (const absl::Status written = Commit({&output}); !written.ok()) return written;
  PrintSummary(options, *response);
  return absl::OkStatus();
}

}  // namespace

Command AddConvert(CLI::App& app) {
  auto options = std::make_shared<ConvertOptions>();
  app.add_option("IN", options->model, kModelHelp)->required();
  app.add_option(
         "OUT", options->output,
         "the model that gives the same jobs: .pb (its bytes, small) or .json; or a file for other systems: "
         ".step, .stp, .p21,\n"
         ".igs or .iges (B-spline surfaces), .stl or .obj (triangles); an existing file is replaced")
      ->required();
  AddReadingOptions(app, options->reading);
  AddNumber(app, "--scale", options->scale, "factor that all coordinates are multiplied by");
  AddNumber(app, "--chord", options->chord,
            "mm: distance of the triangles of .stl and .obj from the surface; 0.0001 to 10, default 0.01");
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
