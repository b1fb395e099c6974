#include "cam/plan/up_directions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "cam/picture/depth_map.h"
#include "cam/picture/view.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr double kDots = 400.0;      // of the grid along each side
constexpr double kHidden = 5e-3;     // of the diagonal: what hides a place is nearer to the eye by this much
constexpr double kMostFacets = 2e5;  // of the surface
const double kFacing = std::cos(Radians(89.0)), kLevel = std::cos(Radians(0.5));

// A small part of the surface.
struct Sample {
  Vec3 p, normal;
  double area = 0.0;
};

std::vector<Sample> SamplesOf(const Surface& surface, int cells) {
  std::vector<Sample> samples;
  samples.reserve(surface.pieces.size() * static_cast<std::size_t>(cells * cells));
  for (const Piece& piece : surface.pieces) {
    if (IsSkipped(surface.network.model, piece.patch)) continue;
    for (int k = 0; k < cells * cells; ++k) {
      const SurfaceJet jet = Evaluate(piece, (k / cells + 0.5) / cells, (k % cells + 0.5) / cells);
      const Vec3 normal = jet.du.cross(jet.dv);
      const double length = normal.norm();
      if (length > 0.0) samples.push_back({jet.p, normal / length, length / (cells * cells)});
    }
  }
  return samples;
}

// The normals of plane faces.
std::vector<Vec3> PlaneNormals(const Surface& surface) {
  const PatchModel& model = surface.network.model;
  std::vector<std::optional<Vec3>> normals(model.faces.size());
  for (const Piece& piece : surface.pieces) {
    const std::optional<FaceId>& face = model.patches[piece.patch.index()].face;
    if (!face || IsSkipped(model, piece.patch) || normals[face->index()] ||
        model.faces[face->index()].kind != SurfaceKind::kPlane)
      continue;
    const SurfaceJet jet = Evaluate(piece, 0.5, 0.5);
    const Vec3 normal = jet.du.cross(jet.dv);
    if (normal.norm() > 0.0) normals[face->index()] = normal.normalized();
  }
  std::vector<Vec3> known;
  for (const std::optional<Vec3>& normal : normals) {
    if (normal) known.push_back(*normal);
  }
  return known;
}

// The axis as a direction of the placed surface.
Vec3 DirectionOf(UpAxis axis, const Placement& placement) {
  constexpr std::array<std::array<double, 3>, 6> kAxes = {
      {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}, {0, -1, 0}, {-1, 0, 0}}};
  const auto& [x, y, z] = kAxes[static_cast<std::size_t>(axis)];
  Placement turn = placement;
  turn.scale = 1.0;
  turn.translation = Vec3::Zero();
  return Place(turn, Vec3(x, y, z));
}

View Along(const Vec3& toward, const Box3& box) {
  View view;
  view.toward = toward;
  const Vec3 beside = std::abs(toward.x()) > 0.5 ? Vec3::UnitY() : Vec3::UnitX();
  view.right = (beside - beside.dot(toward) * toward).normalized();
  view.up = view.toward.cross(view.right);
  return FitView(view, box, Vec2::Zero(), kDots, kDots);
}

}  // namespace

absl::StatusOr<std::vector<UpDirection>> MeasureUpDirections(const Surface& surface,
                                                             const Placement& placement,
                                                             const RunContext& run) {
  std::vector<UpDirection> directions;
  if (surface.network.model.faces.empty()) return directions;
  const double pieces = static_cast<double>(surface.pieces.size());
  const int cells = static_cast<int>(std::clamp(std::sqrt(kMostFacets / pieces), 2.0, 16.0));
  const std::vector<Sample> samples = SamplesOf(surface, cells);
  const std::vector<Vec3> planes = PlaneNormals(surface);
  const double slack = kHidden * surface.box.Diagonal();
  for (const UpAxis axis :
       {UpAxis::kZ, UpAxis::kY, UpAxis::kX, UpAxis::kNegZ, UpAxis::kNegY, UpAxis::kNegX}) {
    PM_RETURN_IF_ERROR(run.Check());
    const Vec3 toward = DirectionOf(axis, placement);
    const DepthMap map(surface, Along(toward, surface.box), {Vec2::Zero(), kDots, kDots, 1.0}, cells);
    UpDirection direction;
    direction.up = axis;
    for (const Sample& sample : samples) {
      if (sample.normal.dot(toward) <= kFacing) continue;
      direction.facing_area += sample.area;
      if (!map.Visible(sample.p, slack)) direction.hidden_area += sample.area;
    }
    direction.level_face_count = static_cast<int>(std::count_if(
        planes.begin(), planes.end(), [&](const Vec3& normal) { return normal.dot(toward) > kLevel; }));
    directions.push_back(direction);
  }
  return directions;
}

UpAxis BestUp(const std::vector<UpDirection>& directions) {
  double all = 0.0;
  for (const UpDirection& d : directions) all += d.facing_area;
  const auto seen = [](const UpDirection& d) { return d.facing_area - d.hidden_area; };
  UpDirection best = directions.front();
  for (const UpDirection& d : directions) {
    if (seen(d) > seen(best) + 0.01 * all) best = d;
  }
  return best.up;
}

}  // namespace patchmill
