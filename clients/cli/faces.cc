#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "clients/cli/call.h"
#include "clients/cli/commands.h"
#include "clients/cli/job_options.h"
#include "clients/cli/output_file.h"
#include "clients/cli/text.h"
#include "patchmill/v1/model_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

struct FacesOptions {
  CommonOptions common;
  SetupOptions setup;
  ReadingOptions reading;
  std::string model, output;
};

std::string Range(double from, double to, int decimals) {
  const std::string low = fmt::format("{:.{}f}", from, decimals), high = fmt::format("{:.{}f}", to, decimals);
  return low == high ? low : low + " to " + high;
}

// "cylinder R 4, hollow".
std::string KindText(const v1::Face& face) {
  std::string text = Short(face.kind());
  if (face.radius_mm() > 0.0) text += fmt::format(" R {:.6g}", face.radius_mm());
  if (face.hollow()) text += ", hollow";
  return text;
}

// "body PLATE, layer 3, #ff0000, \"pocket floor\"": what the file says of the face.
std::string LabelText(const v1::Face& face) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (!face.name().empty()) add(fmt::format("\"{}\"", Printable(face.name())));
  if (!face.body().empty()) add("body " + Printable(face.body()));
  if (!face.layer().empty()) add("layer " + Printable(face.layer()));
  if (face.has_rgb()) add(fmt::format("#{:06x}", face.rgb()));
  return text;
}

void Print(const v1::CheckModelResponse& response) {
  std::size_t id_width = 4, kind_width = 4;
  for (const v1::FaceInfo& info : response.faces()) {
    id_width = std::max(id_width, Printable(info.face().id()).size());
    kind_width = std::max(kind_width, KindText(info.face()).size());
  }
  fmt::print("{:<{}}  {:<{}}  {:>12}  {:<14}  {:<20}  {}\n", "face", id_width, "kind", kind_width,
             "area, mm2", "tilt, degrees", "Z, mm", "in the file");
  for (const v1::FaceInfo& info : response.faces()) {
    const std::string tilt = Range(info.min_tilt_deg(), info.max_tilt_deg(), 1);
    const std::string shown = info.face().skipped() ? "skipped" : info.patch_count() > 0 ? tilt : "lost";
    const std::string z = info.has_box() ? Range(info.box().min().z_mm(), info.box().max().z_mm(), 3) : "";
    fmt::print("{:<{}}  {:<{}}  {:>12.4f}  {:<14}  {:<20}  {}\n", Printable(info.face().id()), id_width,
               KindText(info.face()), kind_width, info.area_mm2(), shown, z, LabelText(info.face()));
  }
}

absl::Status Run(const FacesOptions& options, InterruptWatch& watch) {
  OutputFile output(options.output, {".json", ".svg"});
  v1::CheckModelRequest request;
  absl::StatusOr<v1::ModelSource> source = ReadModel(options.model, options.reading);
  if (!source.ok()) return source.status();
  absl::StatusOr<v1::Setup> setup = MakeSetup(options.setup);
  if (!setup.ok()) return setup.status();
  *request.mutable_source() = *std::move(source);
  *request.mutable_setup() = *std::move(setup);
  request.set_max_threads(options.common.threads);
  request.set_with_faces(true);
  request.set_with_faces_picture(output.EndsIn(".svg"));
  if (const absl::Status writable = CheckWritable({&output}); !writable.ok()) return writable;
  absl::StatusOr<v1::CheckModelResponse> response =
      Call(options.common, watch, &v1::ModelService::Stub::CheckModel, request);
  if (!response.ok()) return response.status();
  if (response->faces().empty()) {
    for (const v1::Diagnostic& finding : response->diagnostics()) {
      if (finding.severity() == v1::SEVERITY_ERROR) fmt::print(stderr, "{}\n", Line(finding));
    }
    return absl::FailedPreconditionError(CountErrors(response->diagnostics()) > 0
                                             ? options.model + ": the model cannot be used"
                                             : options.model + ": the model has patches, but no faces");
  }
  if (output.wanted()) output.Set(response->has_picture() ? response->picture().data() : Json(*response));
  if (const absl::Status written = Commit({&output}); !written.ok()) return written;
  if (!output.is_standard() && (!options.common.quiet || !output.wanted())) Print(*response);
  return absl::OkStatus();
}

}  // namespace

Command AddFaces(CLI::App& app) {
  auto options = std::make_shared<FacesOptions>();
  app.add_option("MODEL", options->model, kModelHelp)->required();
  app.add_option("-o,--output", options->output,
                 "the faces: .json with their figures, or .svg, a picture with their ids");
  AddReadingOptions(app, options->reading);
  AddSetupOptions(app, options->setup);
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
