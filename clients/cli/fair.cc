#include <algorithm>
#include <iterator>
#include <memory>

#include <fmt/format.h>

#include "clients/cli/call.h"
#include "clients/cli/commands.h"
#include "clients/cli/fair_options.h"
#include "clients/cli/job_options.h"
#include "clients/cli/length_units.h"
#include "clients/cli/output_file.h"
#include "clients/cli/text.h"
#include "patchmill/v1/model_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

// Text with one point a line. Each number has the shortest form that reads back as the same value.
template <class Response>
std::string PointText(const Numbers& xyz, bool commas, const Response& response) {
  const char* separator = commas ? "," : " ";
  std::string text = response.title();
  if (text.empty() || text.front() == '#') {
    text = commas ? (response.planar() ? "x,y" : "x,y,z") : "faired curve";
  }
  text += '\n';
  for (int i = 0; i + 2 < xyz.size(); i += 3) {
    fmt::format_to(std::back_inserter(text), "{}{}{}", xyz[i], separator, xyz[i + 1]);
    if (!response.planar()) fmt::format_to(std::back_inserter(text), "{}{}", separator, xyz[i + 2]);
    text += '\n';
  }
  return text;
}

template <class Response>
void SetPoints(const Numbers& xyz, const Response& response, OutputFile& file) {
  file.Set(file.EndsIn(".json") ? Json(response) : PointText(xyz, file.EndsIn(".csv"), response));
}

template <class Response>
void PrintSummary(const FairOptions& options, const Response& response) {
  const Numbers& energies = response.energies();
  fmt::print(stderr, "{}: {} points, {} iterations{}\n", options.output, response.points_mm_size() / 3,
             response.iteration_count(), response.settled() || options.fit ? "" : ", not settled");
  fmt::print(stderr, "  energy    {:.6g} -> {:.6g}\n", energies[0], energies[energies.size() - 1]);
  fmt::print(stderr, "  moved     at most {:.4g}, point {}\n", response.max_moved_mm(),
             response.max_moved_point_index());
}

absl::Status Run(const FairOptions& options, InterruptWatch& watch) {
  OutputFile output(options.output, {".csv", ".dat", ".json"}), polyline(options.polyline, {".csv", ".dat"}),
      preview(options.preview, {".svg"});
  absl::StatusOr<v1::FairCurveRequest> request = MakeFairRequest(options);
  if (!request.ok()) return request.status();
  if (const absl::Status writable = CheckWritable({&output, &polyline, &preview}); !writable.ok())
    return writable;
  absl::StatusOr<v1::FairCurveResponse> response =
      Call(options.common, watch, &v1::ModelService::Stub::FairCurve, *request);
  if (!response.ok()) return response.status();
  SetPoints(response->polyline_mm(), *response, polyline);
  preview.Set(response->picture().data());
  response->clear_picture();
  SetPoints(response->points_mm(), *response, output);
  if (const absl::Status written = Commit({&polyline, &preview, &output}); !written.ok()) return written;
  if (options.common.quiet) return absl::OkStatus();
  PrintSummary(options, *response);
  if (response->polyline_mm_size() > 0) {
    fmt::print(stderr, "  polyline  {} points\n", response->polyline_mm_size() / 3);
  }
  return absl::OkStatus();
}

// Several files: sections of a skin, each faired by itself.
absl::Status RunSections(FairOptions options, InterruptWatch& watch) {
  OutputFile output(options.output, {".json"});
  if (options.net > 0 || !options.polyline.empty() || !options.preview.empty()) {
    return absl::InvalidArgumentError("--net, --polyline and --preview are for one file of points");
  }
  std::vector<v1::FairCurveRequest> requests;
  for (const std::string& file : options.files) {
    options.points = file;
    absl::StatusOr<v1::FairCurveRequest> request = MakeFairRequest(options);
    if (!request.ok()) return request.status();
    requests.push_back(*std::move(request));
  }
  if (const absl::Status writable = CheckWritable({&output}); !writable.ok()) return writable;
  v1::BuildModelRequest outline;
  outline.set_length_unit(LengthUnits().at(options.length_unit));
  for (std::size_t k = 0; k < requests.size(); ++k) {
    absl::StatusOr<v1::FairCurveResponse> response =
        Call(options.common, watch, &v1::ModelService::Stub::FairCurve, requests[k]);
    if (!response.ok()) return response.status();
    v1::OutlineCurve& curve = *outline.mutable_sections()->add_curves();
    curve.set_id(WireText(options.files[k], 200));
    *curve.mutable_bspline() = response->curve();
    if (options.common.quiet) continue;
    options.output = options.files[k];
    PrintSummary(options, *response);
  }
  const auto& curves = outline.sections().curves();
  const bool alike = std::ranges::all_of(curves, [&](const v1::OutlineCurve& curve) {
    return curve.bspline().points_size() == curves[0].bspline().points_size();
  });
  if (alike) outline.mutable_sections()->set_common_knots(true);
  output.Set(Json(outline));
  return Commit({&output});
}

absl::Status RunNet(const FairOptions& options, InterruptWatch& watch) {
  OutputFile output(options.output, {".csv", ".dat", ".json"});
  absl::StatusOr<v1::FairNetRequest> request = MakeFairNetRequest(options);
  if (!request.ok()) return request.status();
  if (const absl::Status writable = CheckWritable({&output}); !writable.ok()) return writable;
  absl::StatusOr<v1::FairNetResponse> response =
      Call(options.common, watch, &v1::ModelService::Stub::FairNet, *request);
  if (!response.ok()) return response.status();
  SetPoints(response->points_mm(), *response, output);
  if (const absl::Status written = Commit({&output}); !written.ok()) return written;
  if (!options.common.quiet) PrintSummary(options, *response);
  return absl::OkStatus();
}

}  // namespace

Command AddFair(CLI::App& app) {
  auto options = std::make_shared<FairOptions>();
  AddFairOptions(app, *options);
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) {
    if (options->files.size() > 1) return RunSections(*options, watch);
    options->points = options->files[0];
    return options->net > 0 ? RunNet(*options, watch) : Run(*options, watch);
  };
}

}  // namespace patchmill::cli
