#include <memory>
#include <vector>

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

struct EditOptions {
  CommonOptions common;
  std::string model, edits, output, patches;
  std::vector<std::string> pushes, moves;
  int continuity = 100;
};

absl::Status ReadEdits(const std::string& path, v1::EditModelRequest& request) {
  absl::StatusOr<std::string> text = ReadWholeFile(path);
  if (!text.ok()) return text.status();
  const absl::Status status = ReadJsonMessage(*text, request);
  if (!status.ok()) {
    return absl::InvalidArgumentError(
        fmt::format("{}: not edits in JSON: {}", path, std::string(status.message())));
  }
  v1::EditModelRequest rest = request;
  rest.clear_edits();
  if (rest.ByteSizeLong() == 0) return absl::OkStatus();
  return absl::InvalidArgumentError(fmt::format("{}: has other fields than \"edits\"", path));
}

// FACE,U,V,LENGTH.
struct FacePlace {
  int face = 0;
  double u = 0.0, v = 0.0, length = 0.0;
};
absl::StatusOr<FacePlace> ReadPlace(const std::string& text, const char* option, const char* length) {
  std::vector<double> numbers;
  for (const std::string& part : CLI::detail::split(text, ',')) {
    double number = 0.0;
    if (!CLI::detail::lexical_cast(part, number)) break;
    numbers.push_back(number);
  }
  const std::size_t parts = CLI::detail::split(text, ',').size();
  if (parts != 4 || numbers.size() != 4 || numbers[0] != static_cast<int>(numbers[0])) {
    return absl::InvalidArgumentError(fmt::format("{} {}; must be FACE,U,V,{}", option, text, length));
  }
  return FacePlace{static_cast<int>(numbers[0]), numbers[1], numbers[2], numbers[3]};
}

absl::Status ReadPush(const std::string& text, v1::EditModelRequest& request) {
  const absl::StatusOr<FacePlace> place = ReadPlace(text, "--push", "AMOUNT");
  if (!place.ok()) return place.status();
  v1::PushFace& push = *request.add_edits()->mutable_push_face();
  push.set_face(place->face);
  push.mutable_push()->set_u(place->u);
  push.mutable_push()->set_v(place->v);
  push.mutable_push()->set_amount(place->length);
  return absl::OkStatus();
}

// All moves are goals of one edit.
absl::Status ReadMoves(const std::vector<std::string>& texts, v1::EditModelRequest& request) {
  if (texts.empty()) return absl::OkStatus();
  v1::ReachGoals& goals = *request.add_edits()->mutable_reach_goals();
  for (const std::string& text : texts) {
    const absl::StatusOr<FacePlace> place = ReadPlace(text, "--move", "DISTANCE");
    if (!place.ok()) return place.status();
    v1::PointGoal& goal = *goals.add_points();
    goal.set_face(place->face);
    goal.set_u(place->u);
    goal.set_v(place->v);
    goal.set_distance(place->length);
  }
  return absl::OkStatus();
}

absl::StatusOr<v1::EditModelRequest> MakeRequest(const EditOptions& options) {
  v1::EditModelRequest request;
  if (!options.edits.empty()) {
    if (const absl::Status read = ReadEdits(options.edits, request); !read.ok()) return read;
  }
  for (const std::string& push : options.pushes) {
    if (const absl::Status read = ReadPush(push, request); !read.ok()) return read;
  }
  if (const absl::Status read = ReadMoves(options.moves, request); !read.ok()) return read;
  absl::StatusOr<v1::ModelSource> source = ReadModel(options.model);
  if (!source.ok()) return source.status();
  *request.mutable_source() = *std::move(source);
  request.set_continuity_steps(options.continuity);
  request.set_with_patches(!options.patches.empty());
  request.set_max_threads(options.common.threads);
  return request;
}

void PrintSummary(const EditOptions& options, const v1::EditModelResponse& response) {
  if (options.common.quiet) return;
  fmt::print(stderr, "{}: {} of {} faces changed\n", options.output, response.changed_faces_size(),
             response.model().network().faces_size());
  for (const v1::ReachedGoal& goal : response.goals()) {
    if (goal.reached_size() != 3) continue;
    fmt::print(stderr, "  {}: at ({:.6g}, {:.6g}, {:.6g}), {:.3g} from the goal\n", goal.field(),
               goal.reached(0), goal.reached(1), goal.reached(2), goal.distance());
  }
  double gap = 0.0, angle = 0.0;
  int equal = 0;
  for (const v1::EdgeContinuity& joint : response.joints()) {
    gap = std::max(gap, joint.max_gap_mm());
    angle = std::max(angle, joint.max_angle_deg());
    if (joint.max_curvature_per_mm() > 0.0 &&
        joint.max_curvature_gap_per_mm() <= 1e-9 * joint.max_curvature_per_mm()) {
      ++equal;
    }
  }
  if (response.joints_size() > 0) {
    fmt::print(
        stderr,
        "  {} joints: gaps up to {:.3g} mm, normals up to {:.3g} degrees apart, {} with equal curvature\n",
        response.joints_size(), gap, angle, equal);
  }
  for (const v1::Diagnostic& finding : response.diagnostics()) fmt::print(stderr, "  {}\n", Line(finding));
}

absl::Status Run(const EditOptions& options, InterruptWatch& watch) {
  OutputFile output = ModelFile(options.output), patches = ModelFile(options.patches);
  absl::StatusOr<v1::EditModelRequest> request = MakeRequest(options);
  if (!request.ok()) return request.status();
  if (const absl::Status writable = CheckWritable({&output, &patches}); !writable.ok()) return writable;
  absl::StatusOr<v1::EditModelResponse> response =
      Call(options.common, watch, &v1::ModelService::Stub::EditModel, *request);
  if (!response.ok()) return response.status();
  if (const int errors = CountErrors(response->diagnostics()); errors > 0) {
    for (const v1::Diagnostic& finding : response->diagnostics()) fmt::print(stderr, "  {}\n", Line(finding));
    return absl::FailedPreconditionError(
        fmt::format("{}: {} errors after the edits; no file was written", options.model, errors));
  }
  SetModel(response->model(), output);
  SetModel(response->patches(), patches);
  if (const absl::Status written = Commit({&patches, &output}); !written.ok()) return written;
  PrintSummary(options, *response);
  return absl::OkStatus();
}

}  // namespace

Command AddEdit(CLI::App& app) {
  auto options = std::make_shared<EditOptions>();
  app.add_option("MODEL", options->model, "model with a curve network: .json or .pb")->required();
  app.add_option("-o,--output", options->output, "the edited model, .json or .pb")->required();
  app.add_option("--edits", options->edits, "edits: a .json file {\"edits\": [ModelEdit, ...]}");
  app.add_option(
      "--push", options->pushes,
      "FACE,U,V,AMOUNT: push a face in or out at this place, after the edits; repeat it for more pushes");
  app.add_option(
      "--move", options->moves,
      "FACE,U,V,DISTANCE: move this place of a face along the surface normal, in the unit of the model; "
      "repeat it for more places, which are solved together after all other edits");
  app.add_option("--patches", options->patches, "write the patches of the edited model, .json or .pb");
  app.add_option("--continuity", options->continuity,
                 "measure every joint at this many equal steps of its edge")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
