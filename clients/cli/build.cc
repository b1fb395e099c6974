#include <filesystem>
#include <map>
#include <memory>

#include <absl/strings/ascii.h>
#include <fmt/format.h>

#include "clients/cli/call.h"
#include "clients/cli/commands.h"
#include "clients/cli/files_in_json.h"
#include "clients/cli/input_file.h"
#include "clients/cli/job_options.h"
#include "clients/cli/length_units.h"
#include "clients/cli/model_file.h"
#include "clients/cli/text.h"
#include "patchmill/v1/model_service.grpc.pb.h"
#include "proto/json/json_message.h"

namespace patchmill::cli {
namespace {

struct BuildOptions {
  CommonOptions common;
  std::vector<std::string> inputs;
  std::string output, network, length_unit;
  bool divide = false, fewest = false, all_findings = false;
  std::vector<int> parts;
  std::optional<double> tolerance, crease_angle;
  std::vector<double> direction;
  bool refuse_free_ends = false;
};

std::string EndingOf(const std::string& path) {
  const std::string ending = absl::AsciiStrToLower(std::filesystem::path(path).extension().native());
  return ending.empty() ? ending : ending.substr(1);
}

// A model of one spline or Bezier patch is a surface to divide; a model with a network is that network.
absl::Status TakeModel(const v1::PatchModel& model, const std::string& input,
                       v1::BuildModelRequest& request) {
  request.set_length_unit(model.length_unit());
  if (model.has_network()) {
    *request.mutable_network() = model.network();
    return absl::OkStatus();
  }
  if (model.patches_size() == 1 && model.patches(0).has_bspline()) {
    *request.mutable_surface() = model.patches(0).bspline();
    return absl::OkStatus();
  }
  if (model.patches_size() == 1 && model.patches(0).has_bezier()) {
    const v1::BezierPatch& bezier = model.patches(0).bezier();
    v1::BsplinePatch& to = *request.mutable_surface();
    to.set_degree_u(bezier.degree_u());
    to.set_degree_v(bezier.degree_v());
    for (int k = 0; k < 2 * (bezier.degree_u() + 1); ++k) to.add_knots_u(k > bezier.degree_u());
    for (int k = 0; k < 2 * (bezier.degree_v() + 1); ++k) to.add_knots_v(k > bezier.degree_v());
    *to.mutable_points() = bezier.points();
    *to.mutable_weights() = bezier.weights();
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      fmt::format("{}: a model of {} patches; a surface to divide is one B-spline or Bezier patch", input,
                  model.patches_size()));
}

absl::Status ReadJson(const std::string& input, v1::BuildModelRequest& request) {
  const absl::StatusOr<std::string> text = ReadWholeFile(input);
  if (!text.ok()) return text.status();
  const absl::StatusOr<std::string> json =
      PutFilesIntoJson(*text, std::filesystem::path(input).parent_path());
  if (!json.ok()) {
    return absl::Status(json.status().code(),
                        fmt::format("{}: {}", input, std::string(json.status().message())));
  }
  const absl::Status status = ReadJsonMessage(*json, request);
  if (status.ok()) return status;
  request.Clear();
  v1::PatchModel model;
  if (ReadJsonMessage(*json, model).ok()) return TakeModel(model, input, request);
  return absl::InvalidArgumentError(
      fmt::format("{}: not an outline in JSON: {}", input, std::string(status.message())));
}

// Several files are sections of a skin, each with one curve.
absl::Status ReadSections(const std::vector<std::string>& inputs, v1::BuildModelRequest& request) {
  for (const std::string& input : inputs) {
    absl::StatusOr<std::string> bytes = ReadWholeFile(input);
    if (!bytes.ok()) return bytes.status();
    v1::CurveInFile& file = *request.mutable_sections()->add_curves()->mutable_file();
    file.set_content(*std::move(bytes));
    file.set_format(WireText(EndingOf(input), 20));
  }
  return absl::OkStatus();
}

absl::Status ReadInputs(const BuildOptions& options, v1::BuildModelRequest& request) {
  if (options.inputs.size() > 1) return ReadSections(options.inputs, request);
  const std::string& input = options.inputs[0];
  const std::string ending = EndingOf(input);
  if (ending != "obj" && ending != "curves") return ReadJson(input, request);
  absl::StatusOr<std::string> bytes = ReadWholeFile(input);
  if (!bytes.ok()) return bytes.status();
  (ending == "obj" ? *request.mutable_mesh()->mutable_content()
                   : *request.mutable_crossing()->mutable_strokes()) = *std::move(bytes);
  return absl::OkStatus();
}

absl::Status SetOptions(const BuildOptions& options, v1::BuildModelRequest& request) {
  const auto needs = [](const char* option, const char* what) {
    return absl::InvalidArgumentError(fmt::format("{} belongs to {}", option, what));
  };
  const bool surface = request.has_sections() || request.has_boundary() || request.has_surface();
  const bool divide = options.divide || options.fewest || !options.parts.empty();
  if (divide && !surface) {
    return needs("a division (--divide, --fewest-faces, --parts)", "sections, boundaries and surfaces");
  }
  if (divide) request.mutable_division();
  if (options.fewest) request.mutable_division()->set_lines(v1::DIVISION_LINES_FEWEST);
  if (!options.parts.empty()) {
    request.mutable_division()->set_parts_u(options.parts[0]);
    request.mutable_division()->set_parts_v(options.parts[1]);
  }
  if (options.tolerance) {
    if (request.has_crossing()) {
      request.mutable_crossing()->set_tolerance_mm(*options.tolerance);
    } else if (request.has_division() || request.has_surface()) {
      request.mutable_division()->set_tolerance_mm(*options.tolerance);
    } else {
      return needs("--tolerance", "curves that cross and surfaces that are divided");
    }
  }
  if (options.crease_angle) {
    if (request.has_crossing()) {
      request.mutable_crossing()->set_crease_angle_deg(*options.crease_angle);
    } else if (request.has_mesh()) {
      request.mutable_mesh()->set_crease_angle_deg(*options.crease_angle);
    } else {
      return needs("--crease-angle", "curves that cross and meshes");
    }
  }
  if (!request.has_crossing() && (!options.direction.empty() || options.refuse_free_ends)) {
    return needs("--direction and --refuse-free-ends", "curves that cross");
  }
  for (const double x : options.direction) request.mutable_crossing()->add_direction(x);
  if (options.refuse_free_ends) request.mutable_crossing()->set_refuse_free_ends(true);
  if (!options.length_unit.empty()) {
    if (request.length_unit() != v1::LENGTH_UNIT_UNSPECIFIED) {
      return absl::InvalidArgumentError(
          fmt::format("--length-unit: {} states its own unit", options.inputs[0]));
    }
    request.set_length_unit(LengthUnits().at(options.length_unit));
  } else if (request.has_mesh() || !request.crossing().strokes().empty() || options.inputs.size() > 1) {
    request.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);  // these files state none
  }
  return absl::OkStatus();
}

absl::StatusOr<v1::BuildModelRequest> MakeRequest(const BuildOptions& options) {
  v1::BuildModelRequest request;
  if (const absl::Status status = ReadInputs(options, request); !status.ok()) return status;
  if (const absl::Status status = SetOptions(options, request); !status.ok()) return status;
  if (!options.network.empty() &&
      (!request.has_network() || request.outline_case() == v1::BuildModelRequest::OUTLINE_NOT_SET)) {
    return absl::InvalidArgumentError(
        fmt::format("--network {}: {} has no network beside a surface", options.network, options.inputs[0]));
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
  const std::string& input = options.inputs[0];
  if (!options.common.quiet) {
    for (const std::string& line : FindingLines(response->diagnostics(), options.all_findings))
      fmt::print(stderr, "  {}\n", line);
  }
  if (const int errors = CountErrors(response->diagnostics()); errors > 0) {
    return absl::FailedPreconditionError(fmt::format("{}: {} errors; no file was written", input, errors));
  }
  const bool with_surface =
      request->has_network() && request->outline_case() != v1::BuildModelRequest::OUTLINE_NOT_SET;
  SetModel(response->has_network_model() && !with_surface ? response->network_model() : response->model(),
           output);
  SetModel(response->network_model(), network);
  if (const absl::Status written = Commit({&network, &output}); !written.ok()) return written;
  if (options.common.quiet || !response->has_network_model()) return absl::OkStatus();
  const v1::CurveNetwork& made = response->network_model().network();
  if (with_surface) {
    fmt::print(stderr, "{}: {} vertices, at most {:.4g} mm from the surface (vertex {})\n", input,
               request->network().vertices_size(), response->max_distance_mm(), response->farthest_vertex());
  } else {
    fmt::print(stderr, "{}: {} vertices, {} edges, {} faces\n", input, made.vertices_size(),
               made.edges_size(), made.faces_size());
    if (request->has_crossing() || request->has_division() || request->has_surface()) {
      fmt::print(stderr, "  at most {:.3g} mm from the {}\n", response->max_distance_mm(),
                 request->has_crossing() ? "curves" : "surface");
    }
  }
  return absl::OkStatus();
}

}  // namespace

Command AddBuild(CLI::App& app) {
  auto options = std::make_shared<BuildOptions>();
  app.add_option(
         "OUTLINE", options->inputs,
         "what the model is made from: a BuildModelRequest as .json (sections, boundary curves, crossing "
         "curves, a surface, a network\n"
         "whose edges name files); a model of one spline as .json, which is divided; strokes as .curves; a "
         "mesh "
         "as .obj; or several\n"
         "files with one section each (.csv, .dat, or .json of the command fair)")
      ->required();
  app.add_option("-o,--output", options->output,
                 "the model, .json or .pb: the network that was made, which mills and edits, or the surface")
      ->required();
  app.add_option("--network", options->network,
                 "write the network of OUTLINE with normals of the surface: .json or .pb");
  app.add_flag("--divide", options->divide,
               "divide the surface into a network, with a face between its knots");
  app.add_flag("--fewest-faces", options->fewest,
               "divide the surface into as few faces as keep --tolerance; they need not end at knots");
  app.add_option("--parts", options->parts,
                 "U,V: divide each rectangle between knots into this many parts at least, 1 to 64")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(1, 64));
  AddNumber(app, "--tolerance", options->tolerance,
            "mm. Curves nearer than this meet (default: a thousandth of the diagonal); or distance of a "
            "divided network "
            "from its surface\n"
            "(default 0.001)");
  AddNumber(
      app, "--crease-angle", options->crease_angle,
      "degrees: faces of curves (default 40) or of a mesh (default 180) that meet at more have a crease");
  app.add_option(
         "--direction", options->direction,
         "X,Y,Z: put curves in order around vertices as they are seen along this direction; default: in the "
         "plane of their tangents")
      ->delimiter(',')
      ->expected(3);
  app.add_flag("--refuse-free-ends", options->refuse_free_ends,
               "ends of curves beyond their last meeting are errors; default: they are cut off");
  std::vector<std::string> units;
  for (const auto& [name, unit] : LengthUnits()) units.push_back(name);
  app.add_option("--length-unit", options->length_unit, "unit of files that state none; default mm")
      ->check(CLI::IsMember(units));
  app.add_flag("--all-findings", options->all_findings,
               "list every finding; default: three of each code, and how many more there are");
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
