#include "cam/plan/choose_up.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cam/plan/plan.h"
#include "cam/plan/up_directions.h"
#include "core/base/error_details.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr int kSteps = 4;  // of the places at which a face is looked at, along u and v of each patch

double Seen(const UpDirection& direction) { return direction.facing_area - direction.hidden_area; }

std::string BestText(const std::vector<UpDirection>& directions, UpAxis best) {
  const auto chosen =
      std::find_if(directions.begin(), directions.end(), [&](const UpDirection& d) { return d.up == best; });
  const UpDirection* next = nullptr;
  for (const UpDirection& d : directions) {
    if (d.up != best && (next == nullptr || Seen(d) > Seen(*next))) next = &d;
  }
  std::string text = fmt::format(
      "{} points up, of the six axes the one that shows most: {:.1f} mm2 look up, {:.1f} of them are hidden, "
      "{} level face{}",
      Name(best), chosen->facing_area, chosen->hidden_area, chosen->level_face_count,
      chosen->level_face_count == 1 ? "" : "s");
  if (next != nullptr) text += fmt::format("; {} would show {:.1f} mm2", Name(next->up), Seen(*next));
  return text;
}

absl::StatusOr<ChosenUp> ShowMost(const PatchModel& model, Setup setup, const RunContext& run) {
  if (model.faces.empty()) {
    return FieldError(
        "setup.up",
        "is automatic; the model must have faces, as CAD files do, whose normals point out of it: "
        "name an axis");
  }
  Setup plain;
  plain.placement.scale = setup.placement.scale;
  PM_ASSIGN_OR_RETURN(const Surface surface, BuildPlacedSurface(model, plain, run));
  PM_ASSIGN_OR_RETURN(const std::vector<UpDirection> directions,
                      MeasureUpDirections(surface, plain.placement, run));
  setup.placement.up = BestUp(directions);
  return ChosenUp{std::move(setup), {MakeInfo("UP_CHOSEN", BestText(directions, BestUp(directions)))}};
}

// A face looked at in places of all its patches.
struct SampledFace {
  std::vector<Vec3> points;
  Vec3 area = Vec3::Zero();  // about, mm^2, along the normal
};

SampledFace Sample(const PatchModel& model, FaceId face) {
  SampledFace sampled;
  for (const Patch& patch : model.patches) {
    if (patch.face != face) continue;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; j <= kSteps; ++j) {
        const double u = static_cast<double>(i) / kSteps;
        const double v = static_cast<double>(j) / kSteps * (IsTriangle(patch.shape) ? 1.0 - u : 1.0);
        const SurfaceJet jet = Evaluate(patch.shape, u, v);
        sampled.points.push_back(jet.p);
        sampled.area += jet.du.cross(jet.dv);
      }
    }
  }
  return sampled;
}

// The unit normal of a plane face, or what is wrong with it: "must be ...".
struct FaceNormal {
  std::optional<Vec3> normal;
  std::string wrong;
};
FaceNormal NormalOf(const PatchModel& model, FaceId id) {
  const ModelFace& face = model.faces[id.index()];
  if (face.kind != SurfaceKind::kPlane)
    return {std::nullopt, fmt::format("must be a plane face: it is a {}", Name(face.kind))};
  if (face.skipped) return {std::nullopt, "must be a face that is read: it is skipped"};
  const SampledFace sampled = Sample(model, id);
  if (!(sampled.area.norm() > 0.0)) return {std::nullopt, "must be a face that has patches"};
  const Vec3 normal = sampled.area.normalized();
  double low = kInfinity, high = -kInfinity;
  for (const Vec3& p : sampled.points) {
    low = std::min(low, normal.dot(p));
    high = std::max(high, normal.dot(p));
  }
  if (high - low > kDefaultJoinTolerance * ControlBox(model).Diagonal()) {
    return {
        std::nullopt,
        fmt::format("must be a plane face: the model calls it one, but its height along its normal varies "
                    "by {:.3g} mm",
                    high - low)};
  }
  return {normal, ""};
}

// The smallest rotation that takes the unit vector n to +z, for n.z >= 0.
Mat3 TurnToZ(const Vec3& n) {
  const double k = 1.0 / (1.0 + n.z());
  Mat3 turn;
  turn << 1.0 - k * n.x() * n.x(), -k * n.x() * n.y(), -n.x(),  //
      -k * n.x() * n.y(), 1.0 - k * n.y() * n.y(), -n.y(),      //
      n.x(), n.y(), n.z();
  return turn;
}

void TurnUp(const Vec3& n, Placement& placement) {
  constexpr std::pair<UpAxis, std::array<double, 3>> kAxes[] = {
      {UpAxis::kZ, {0, 0, 1}},     {UpAxis::kY, {0, 1, 0}},     {UpAxis::kX, {1, 0, 0}},
      {UpAxis::kNegZ, {0, 0, -1}}, {UpAxis::kNegY, {0, -1, 0}}, {UpAxis::kNegX, {-1, 0, 0}}};
  for (const auto& [axis, a] : kAxes) {
    if ((n - Vec3(a[0], a[1], a[2])).cwiseAbs().maxCoeff() > kSnapToAxis) continue;
    placement.up = axis;
    return;
  }
  // A normal that points down is turned around the x axis first, as UpAxis::kNegZ does.
  const Vec3 above(n.x(), n.z() < 0.0 ? -n.y() : n.y(), std::abs(n.z()));
  Mat3 turn = TurnToZ(above);
  if (n.z() < 0.0) {
    turn.col(1) = -turn.col(1);
    turn.col(2) = -turn.col(2);
  }
  placement.turn = turn;
}

absl::StatusOr<ChosenUp> TurnFaceUp(const PatchModel& model, Setup setup) {
  const auto found = std::find_if(model.faces.begin(), model.faces.end(),
                                  [&](const ModelFace& face) { return face.id == setup.up_face; });
  const auto wrong = [&](std::string_view text) {
    return FieldError("setup.up_face", fmt::format("= \"{}\"; {}", setup.up_face, text));
  };
  if (model.faces.empty()) return wrong("must be unset for a model without faces: name an axis");
  if (found == model.faces.end()) {
    return wrong(
        fmt::format("must be a plane face of the model, whose faces are {} to {}; axes are x, y, z, "
                    "-x, -y and -z",
                    model.faces.front().id, model.faces.back().id));
  }
  const FaceNormal face = NormalOf(model, FaceId(static_cast<std::size_t>(found - model.faces.begin())));
  if (!face.normal) return wrong(face.wrong);
  const Vec3& n = *face.normal;
  TurnUp(n, setup.placement);
  Diagnostic finding = MakeInfo(
      "UP_CHOSEN",
      fmt::format("face {} points up: the model is turned by {:.4f} degrees, which takes its "
                  "direction X{:.6f} Y{:.6f} Z{:.6f} to +Z",
                  Title(*found), Degrees(std::atan2(std::hypot(n.x(), n.y()), n.z())), n.x(), n.y(), n.z()),
      {.face_id = found->id});
  return ChosenUp{std::move(setup), {std::move(finding)}};
}

}  // namespace

absl::StatusOr<ChosenUp> ChooseUp(const PatchModel& model, Setup setup, const RunContext& run) {
  if (!setup.up_face.empty()) return TurnFaceUp(model, std::move(setup));
  if (setup.up_auto) return ShowMost(model, std::move(setup), run);
  return ChosenUp{std::move(setup), {}};
}

}  // namespace patchmill
