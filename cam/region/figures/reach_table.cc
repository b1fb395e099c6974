#include "cam/region/figures/reach_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "cam/limits/reach_tolerance.h"
#include "cam/region/border/border_arcs.h"
#include "cam/region/split/region_fields.h"
#include "cam/region/split/split_mesh.h"
#include "core/base/parallel.h"
#include "core/base/share_progress.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr double kCell = 0.005;   // largest cell in diagonals of the surface's box, unless 0.6 R is more
constexpr double kBorder = 0.01;  // in R: accuracy of the limits of reach, unless border_tolerance is less

absl::Status Check(const ReachTableParams& params) {
  if (params.radii.empty() || params.radii.size() > kMaxReachRadii) {
    return absl::InvalidArgumentError(
        fmt::format("radii: {} given; must be 1 to {}", params.radii.size(), kMaxReachRadii));
  }
  for (std::size_t i = 0; i < params.radii.size(); ++i) {
    const double least = i == 0 ? 0.0 : params.radii[i - 1];
    if (!(params.radii[i] > least && std::isfinite(params.radii[i]))) {
      return absl::InvalidArgumentError(
          fmt::format("radii[{}] = {:g}; must be finite and above {:g}", i, params.radii[i], least));
    }
  }
  if (!(params.tolerance > 0.0 && params.tolerance < 0.5 * params.radii[0])) {
    return absl::InvalidArgumentError(
        fmt::format("tolerance = {:g}; must be in (0, {:g})", params.tolerance, 0.5 * params.radii[0]));
  }
  return absl::OkStatus();
}

struct Areas {
  double all = 0.0, unreachable = 0.0;
};

// Splits the surface like the region map, but along the limits of reach alone. Borders follow the true
// limits.
absl::StatusOr<Areas> MeasureReach(const Surface& surface, const RegionParams& params, const RunContext& run,
                                   ShareProgress& progress) {
  PM_ASSIGN_OR_RETURN(const Locator free_ball,
                      Locator::Make(surface, params.radius - ReachTolerance(params.tolerance), run));
  progress.Add(0);
  const ReachTest reach(free_ball, params, run);
  progress.Add(0);
  PM_RETURN_IF_ERROR(run.Check());
  const std::vector<ZeroField> fields = ReachFields(reach, params);
  const ZeroMeshParams mesh_params = RegionMeshParams(surface, params, kCell, run);
  std::vector<SplitMesh> meshes(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, meshes.size(), [&](std::size_t i) {
    meshes[i] = BuildSplitMesh(surface.pieces[i], fields, params.steep_angle, mesh_params);
    progress.Add(0);
  }));
  PM_ASSIGN_OR_RETURN(const SplitSurface split, JoinMeshes(surface, std::move(meshes), run));
  PerTriangle<RegionId> region_of;  // 0 is reachable, 1 is not
  std::vector<double> flat(2, 0.0);
  for (const SplitMesh& mesh : split.meshes) {
    std::vector<RegionId>& of = region_of.emplace_back();
    for (const SplitTriangle& t : mesh.triangles) {
      of.push_back(RegionId(t.label.reason == UnreachableReason::kNone ? 0 : 1));
      flat[of.back().index()] += t.area;
    }
  }
  PM_ASSIGN_OR_RETURN(BorderArcs arcs,
                      FindBorderArcs(split, region_of, fields, params.border_tolerance, run));
  PM_ASSIGN_OR_RETURN(const BentBorders bent, BendAreas(split, region_of, flat, std::move(arcs), run));
  return Areas{flat[0] + flat[1], flat[1] + bent.gained[1]};
}

}  // namespace

absl::StatusOr<ReachTableResult> ReachTable(const Surface& surface, const ReachTableParams& params,
                                            const RunContext& run) {
  PM_RETURN_IF_ERROR(Check(params));
  ReachTableResult table;
  ShareProgress progress(run, "reach", params.radii.size() * (surface.pieces.size() + 2));
  for (std::size_t k = 0; k < params.radii.size(); ++k) {
    RegionParams region;
    region.radius = params.radii[k];
    region.tolerance = params.tolerance;
    region.floor_z = params.floor_z;
    region.border_tolerance = std::min(region.border_tolerance, kBorder * region.radius);
    PM_ASSIGN_OR_RETURN(const Areas areas, MeasureReach(surface, region, run, progress));
    if (k == 0) table.area = areas.all;
    // A larger ball reaches no more [regions T14]; the clamp hides errors of measurement.
    const double before = k == 0 ? 0.0 : table.unreachable.back();
    table.unreachable.push_back(std::clamp(areas.unreachable, before, table.area));
    if (k > 0) table.largest.push_back(table.unreachable[k] - before);
  }
  table.largest.push_back(table.area - table.unreachable.back());
  return table;
}

}  // namespace patchmill
