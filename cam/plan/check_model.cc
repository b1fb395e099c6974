#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "cam/plan/plan.h"
#include "core/base/error_details.h"
#include "core/base/status.h"
#include "core/surface/concave_radius.h"
#include "core/surface/extent.h"

namespace patchmill {

absl::StatusOr<PatchNetwork> BuildPlacedNetwork(PatchModel model, const Setup& setup, const RunContext& run) {
  const Placement& p = setup.placement;
  if (!(p.scale > 0.0) || !(p.scale <= 1e9)) {
    return FieldError("setup.scale", fmt::format("= {:.6g}; must be in (0, 1e9]", p.scale));
  }
  if (!p.translation.allFinite() || p.translation.norm() > 1e6) {
    return FieldError("setup.translation_mm", "must be finite and within 1e6 mm");
  }
  return BuildNetwork(Place(p, std::move(model)), run);
}

absl::StatusOr<Surface> BuildPlacedSurface(PatchModel model, const Setup& setup, const RunContext& run) {
  PM_ASSIGN_OR_RETURN(PatchNetwork network, BuildPlacedNetwork(std::move(model), setup, run));
  PM_RETURN_IF_ERROR(run.Check());
  PM_ASSIGN_OR_RETURN(Surface surface, BuildSurface(std::move(network), SurfaceParams{}, run));
  return WithWallSides(std::move(surface), setup.wall_sides, run);
}

Diagnostics WallsWithoutSide(const Surface& surface) {
  const PatchModel& model = surface.network.model;
  Diagnostics found;
  std::set<FaceId> reported;
  for (const PatchId id : surface.two_sided_walls) {
    if (IsSkipped(model, id)) continue;  // nothing of it is milled
    const std::optional<FaceId>& face = model.patches[id.index()].face;
    if (face && !reported.insert(*face).second) continue;  // one finding for all patches of a face
    found.push_back(MakeWarning(
        "WALL_WITHOUT_SIDE",
        fmt::format("the {} stands upright, and nothing that it is joined to says which of its sides is air: "
                    "both are milled; --wall-side picks one",
                    face ? "face" : "patch"),
        WhereOf(model, id)));
  }
  return found;
}

absl::StatusOr<ModelCheck> CheckModel(const Surface& surface, const std::optional<Tool>& tool,
                                      double reach_tolerance, const RunContext& run) {
  ModelCheck check;
  check.findings = surface.network.findings;
  check.box = TightBox(surface);
  PM_RETURN_IF_ERROR(run.Check());
  const Diagnostics walls = WallsWithoutSide(surface);
  check.findings.insert(check.findings.end(), walls.begin(), walls.end());
  PM_ASSIGN_OR_RETURN(const ConcaveSpot spot, SmallestConcaveRadius(surface, run));
  check.min_concave_radius = spot.radius;
  if (tool && spot.radius < BallRadius(*tool) - reach_tolerance) {
    const Piece& piece = surface.piece(spot.at.piece);
    Where where = WhereOf(surface.network.model, piece.patch);
    where.uv = NativeParameters(piece, spot.at.u, spot.at.v);
    where.point = spot.at.p;
    check.findings.push_back(MakeWarning(
        "CONCAVE_RADIUS_BELOW_TOOL",
        fmt::format(
            "smallest concave radius {:.4g} mm is below the ball radius {:.4g} mm: what lies there is left",
            spot.radius, BallRadius(*tool)),
        std::move(where)));
  }
  return check;
}

}  // namespace patchmill
