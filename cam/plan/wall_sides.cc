#include "cam/plan/wall_sides.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "cam/plan/patch_selection.h"
#include "core/base/error_details.h"
#include "core/base/status.h"
#include "core/surface/air_sides.h"
#include "core/surface/closest.h"
#include "core/surface/part.h"

namespace patchmill {
namespace {

constexpr double kOnWall = 1e-3;  // mm: points nearer to the wall are on no side of it

// 1 if the point lies on the side of du x dv of the patch, -1 if on the other, 0 if on the patch.
absl::StatusOr<int> SideOf(const Surface& surface, PatchId patch, const Vec3& point, const RunContext& run) {
  std::vector<bool> alone(surface.network.model.patches.size(), false);
  alone[patch.index()] = true;
  PM_ASSIGN_OR_RETURN(const Surface wall, PartOf(surface, alone, run));
  const auto nearest = ClosestToPoint(wall, point, kInfinity, 0.1 * kOnWall);
  PM_CHECK(nearest.has_value());
  const Piece& piece = wall.piece(nearest->at.piece);
  const SurfaceJet jet = Evaluate(piece, nearest->at.u, nearest->at.v);
  const double distance =
      OrientationOf(piece) * (point - nearest->at.p).dot(jet.du.cross(jet.dv).normalized());
  if (!(std::abs(distance) > kOnWall)) return 0;
  return distance > 0.0 ? 1 : -1;
}

}  // namespace

absl::StatusOr<Surface> WithWallSides(Surface surface, const std::vector<WallSide>& sides,
                                      const RunContext& run) {
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const std::string field = fmt::format("setup.wall_sides[{}]", k);
    PM_ASSIGN_OR_RETURN(const std::vector<bool> named,
                        SelectPatches(surface.network, {sides[k].name}, field + ".patch_id", run));
    std::vector<PatchId> walls, others;
    for (const PatchId id : surface.two_sided_walls) (named[id.index()] ? walls : others).push_back(id);
    if (walls.empty()) {
      return FieldError(
          field + ".patch_id",
          fmt::format("= \"{}\"; is no upright wall with two sides: what it is joined to decides "
                      "its side",
                      sides[k].name));
    }
    for (const PatchId wall : walls) {
      PM_ASSIGN_OR_RETURN(const int side, SideOf(surface, wall, sides[k].air, run));
      if (side == 0) return FieldError(field + ".air", "lies on the wall; must be a point on one side of it");
      SetAirSide(wall, side, surface.pieces);
    }
    surface.two_sided_walls = std::move(others);
  }
  return surface;
}

}  // namespace patchmill
