#include "cam/region/split_regions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "cam/limits/reach_tolerance.h"
#include "cam/region/border/border_arcs.h"
#include "cam/region/border/border_lines.h"
#include "cam/region/border/region_border.h"
#include "cam/region/figures/describe_regions.h"
#include "cam/region/figures/probe_region.h"
#include "cam/region/figures/region_labels.h"
#include "cam/region/merge/merge_regions.h"
#include "cam/region/merge/raw_regions.h"
#include "cam/region/merge/triangle_regions.h"
#include "cam/region/watershed/catchments.h"
#include "cam/region/watershed/watershed_lines.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/base/union_find.h"

namespace patchmill {
namespace {

// In ball radii. A region is neutral if the integral of its contour curvature is smaller than this
// [regions, section 5].
constexpr double kMinCurvature = 1.0 / 6.0;

// At middle detail a strip joins its sides if its normal turns by less than twice this across it.
constexpr double kBorderTurn = 0.1;  // rad
constexpr int kMostRegions = 40;     // reachable regions at full detail

// In ball radii, and in cells of the split. A summit or pit with less persistence than this gets no mountain
// or basin of its own. Triangles may miss a summit that is lower than this part of a cell.
constexpr double kPersistence = 0.1;

// Largest cell of the split in diagonals of the surface's box, unless 0.6 R is more (RegionMeshParams).
constexpr double kCell = 0.02;

// Smaller details count as this one.
constexpr double kCoarsest = 0.05;

// How much coarser the regions are than at middle detail: 1 at detail 0.5, 0 for the raw split.
double Coarseness(const RegionParams& params) {
  const double detail = std::clamp(params.detail, kCoarsest, 1.0);
  return (1.0 - detail) / detail;
}

// Largest number of reachable regions. The raw split has no such limit.
std::size_t MostRegions(const RegionParams& params) {
  return std::max<std::size_t>(1,
                               static_cast<std::size_t>(kMostRegions * std::max(params.detail, kCoarsest)));
}

// A split along the watersheds, and what each of its triangles belongs to.
struct Divided {
  SplitSurface split;
  Watersheds watersheds;
};

// Divides the meshes along the watersheds of the summits that persist, then along those of the pits. Does not
// divide the raw split. `max_cell` is the largest cell of the split, mm.
absl::StatusOr<Divided> Divide(SplitSurface split, const RegionParams& params,
                               std::span<const ZeroField> fields, double max_cell, const RunContext& run) {
  const double persistence =
      std::max({2.0 * params.tolerance, kPersistence * params.radius, kPersistence * max_cell}) *
      std::max(1.0, Coarseness(params));
  WatershedParams line;
  line.tolerance = params.border_tolerance;
  line.spacing = params.radius;
  line.steep_angle = params.steep_angle;
  line.fields = fields;
  constexpr double kSigns[] = {1.0, -1.0};
  HeightExtrema tops[2];
  if (params.detail < 1.0) {
    PM_ASSIGN_OR_RETURN(const HeightGraph graph, HeightGraph::Make(split, run));
    absl::StatusOr<HeightExtrema> heights[2];
    PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, 2, [&](std::size_t k) {
      heights[k] = graph.Find(kSigns[k], persistence, MostRegions(params), run);
    }));
    PM_ASSIGN_OR_RETURN(tops[0], std::move(heights[0]));
    PM_ASSIGN_OR_RETURN(tops[1], std::move(heights[1]));
    PM_ASSIGN_OR_RETURN(split, CutWatersheds(std::move(split), {tops[0].passes, tops[1].passes}, line, run));
  }
  absl::StatusOr<PerTriangle<int>> found[2];
  PM_RETURN_IF_ERROR(ParallelFor(
      run, nullptr, 2, [&](std::size_t k) { found[k] = Catchments(split, tops[k].tops, kSigns[k], run); }));
  Watersheds watersheds;
  PM_ASSIGN_OR_RETURN(watersheds.summit, std::move(found[0]));
  PM_ASSIGN_OR_RETURN(watersheds.pit, std::move(found[1]));
  return Divided{std::move(split), std::move(watersheds)};
}

// Mean contour curvature that counts as flat, 1/mm: its sagitta over the ball's diameter is the tolerance.
double FlatBend(const RegionParams& params) {
  return 8.0 * params.tolerance / (4.0 * params.radius * params.radius);
}

MergedRegions Merge(const RawRegions& raw, const RegionParams& params) {
  MergeParams p;
  if (params.detail >= 1.0) {
    p.border_turn = p.border_slope = p.flat = p.min_area = p.min_width = p.min_curvature = 0.0;
    p.sliver = 0.0;
    p.max_regions = std::numeric_limits<int>::max();
  } else {
    const double coarse = Coarseness(params);
    p.border_turn = kBorderTurn * coarse;
    p.border_slope = p.border_turn * params.radius;
    p.flat = FlatBend(params);
    p.flat_cost = 0.5 * kBorderTurn / params.radius;
    p.min_area = 2.0 * kPi * params.radius * params.radius * coarse;
    p.min_width = params.radius * coarse;
    p.min_curvature = kMinCurvature * params.radius;
    p.sliver = params.tolerance;
    p.max_regions = static_cast<int>(MostRegions(params));
  }
  return MergeRegions(raw.regions, raw.contacts, p);
}

Region FromLabel(const SplitLabel& label) {
  Region region;
  region.reason = label.reason;
  const bool reached =
      label.reason == UnreachableReason::kNone || label.reason == UnreachableReason::kStrategy;
  region.kind = !reached              ? RegionKind::kUnreachable
                : label.curvature < 0 ? RegionKind::kMountain
                : label.curvature > 0 ? RegionKind::kBasin
                                      : RegionKind::kNeutral;
  region.slope = region.kind == RegionKind::kUnreachable ? SlopeClass::kUnspecified
                 : label.steep                           ? SlopeClass::kSteep
                                                         : SlopeClass::kGentle;
  return region;
}

// What each triangle belongs to; id_of_raw[raw region] is known.
template <class Id>
PerTriangle<Id> Labelled(const RawRegions& raw, const std::vector<Id>& id_of_raw) {
  PerTriangle<Id> id_of;
  for (const std::vector<int>& piece : raw.of) {
    std::vector<Id>& own = id_of.emplace_back();
    own.reserve(piece.size());
    for (const int region : piece) own.push_back(id_of_raw[static_cast<std::size_t>(region)]);
  }
  return id_of;
}

// The groups of merged regions as regions in their final order. Their borders follow the true curves.
struct Numbered {
  std::vector<Region> regions;
  TriangleRegions triangles;
  BorderArcs arcs;
};

// Numbers the connected components of each region, by region and then by their first raw region. An
// unreachable region is one component even if it is not connected, because nothing is cut there.
// id_of_raw[raw region] is its region.
TriangleRegions WithComponents(const RawRegions& raw, const std::vector<RegionId>& id_of_raw,
                               const std::vector<Region>& regions) {
  UnionFind sets(raw.regions.size());
  for (const RawContact& contact : raw.contacts) {
    const auto a = static_cast<std::size_t>(contact.a), b = static_cast<std::size_t>(contact.b);
    if (id_of_raw[a] == id_of_raw[b]) sets.Join(a, b);
  }
  std::vector<int> first(regions.size(), -1);
  for (std::size_t i = 0; i < id_of_raw.size(); ++i) {
    const std::size_t id = id_of_raw[i].index();
    if (regions[id].kind != RegionKind::kUnreachable) continue;
    if (first[id] < 0) first[id] = static_cast<int>(i);
    sets.Join(static_cast<std::size_t>(first[id]), i);
  }
  std::vector<std::size_t> order(raw.regions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return id_of_raw[a] < id_of_raw[b]; });
  TriangleRegions triangles;
  triangles.region_count = regions.size();
  std::vector<ComponentId> component(raw.regions.size(), kNoComponent);
  for (const std::size_t i : order) {
    if (sets.Find(i) != i) continue;  // the root of a set is its smallest member
    component[i] = ComponentId(triangles.component_region.size());
    triangles.component_region.push_back(id_of_raw[i]);
  }
  for (std::size_t i = 0; i < component.size(); ++i) component[i] = component[sets.Find(i)];
  triangles.region_of = Labelled(raw, id_of_raw);
  triangles.component_of = Labelled(raw, component);
  return triangles;
}

absl::StatusOr<Numbered> Number(const SplitSurface& split, const RawRegions& raw,
                                std::span<const ZeroField> fields, const RegionParams& params,
                                const RunContext& run) {
  const MergedRegions merged = Merge(raw, params);
  // The order of the regions depends on their areas along the true borders. Until these are known, regions
  // have the numbers of their groups.
  std::vector<RegionId> group_of_raw;
  for (const int group : merged.group) group_of_raw.push_back(RegionId(group));
  const PerTriangle<RegionId> group_of = Labelled(raw, group_of_raw);
  PM_ASSIGN_OR_RETURN(BorderArcs arcs, FindBorderArcs(split, group_of, fields, params.border_tolerance, run));
  std::vector<double> flat(merged.label.size(), 0.0), curvature = flat, steepness = flat;
  for (std::size_t i = 0; i < raw.regions.size(); ++i) {
    const std::size_t group = group_of_raw[i].index();
    flat[group] += raw.regions[i].area;
    curvature[group] += raw.regions[i].curvature;
    steepness[group] += raw.regions[i].steepness;
  }
  PM_ASSIGN_OR_RETURN(BentBorders bent, BendAreas(split, group_of, flat, std::move(arcs), run));
  std::vector<Region> groups;
  for (std::size_t k = 0; k < merged.label.size(); ++k) {
    SplitLabel label = merged.label[k];
    if (label.reason == UnreachableReason::kStrategy) {
      const bool bends =
          std::abs(curvature[k]) >= std::max(kMinCurvature * params.radius, FlatBend(params) * flat[k]);
      label.curvature = static_cast<std::int8_t>(!bends ? 0 : curvature[k] < 0.0 ? -1 : 1);
      label.steep = steepness[k] > 0.0;
    }
    groups.push_back(FromLabel(label));
    groups.back().area = flat[k] + bent.gained[k];
  }
  std::vector<std::size_t> order(groups.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const bool ua = groups[a].kind == RegionKind::kUnreachable,
               ub = groups[b].kind == RegionKind::kUnreachable;
    return ua != ub ? ub : groups[a].area > groups[b].area;
  });
  Numbered numbered;
  std::vector<RegionId> id_of(groups.size());
  for (const std::size_t group : order) {
    const RegionId id(numbered.regions.size());
    id_of[group] = id;
    numbered.regions.push_back(groups[group]);
    numbered.regions.back().id = id;
  }
  std::vector<RegionId> id_of_raw;
  for (const RegionId group : group_of_raw) id_of_raw.push_back(id_of[group.index()]);
  numbered.triangles = WithComponents(raw, id_of_raw, numbered.regions);
  numbered.arcs = std::move(bent.arcs);
  return numbered;
}

}  // namespace

absl::StatusOr<RegionMap> SplitRegions(const Surface& surface, const RegionParams& params,
                                       const RunContext& run) {
  PM_ASSIGN_OR_RETURN(
      const Locator free_ball,
      Locator::Make(surface, std::max(params.radius - ReachTolerance(params.tolerance), 0.5 * params.radius),
                    run));
  const ReachTest reach(free_ball, params, run);
  PM_RETURN_IF_ERROR(run.Check());
  const std::vector<ZeroField> fields = RegionFields(reach, params);
  const ZeroMeshParams mesh_params = RegionMeshParams(surface, params, kCell, run);
  std::vector<SplitMesh> meshes(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "regions", meshes.size(), [&](std::size_t i) {
    meshes[i] = BuildSplitMesh(surface.pieces[i], fields, params.steep_angle, mesh_params);
  }));
  PM_ASSIGN_OR_RETURN(SplitSurface whole, JoinMeshes(surface, std::move(meshes), run));
  PM_ASSIGN_OR_RETURN(const Divided divided,
                      Divide(std::move(whole), params, fields, mesh_params.max_cell, run));
  const SplitSurface& split = divided.split;
  PM_ASSIGN_OR_RETURN(const RawRegions raw, FindRawRegions(split, divided.watersheds, run));
  PM_ASSIGN_OR_RETURN(const Numbered numbered, Number(split, raw, fields, params, run));
  const TriangleRegions& triangles = numbered.triangles;
  PM_ASSIGN_OR_RETURN(const BorderPoints border,
                      FindBorderPoints(split, numbered.arcs, params.border_tolerance, run));
  const auto unreachable = UnreachableTriangles(triangles, numbered.regions);
  // The largest regions come first, so that no thread is left with one of them at the end.
  std::vector<std::size_t> probed;
  for (std::size_t id = 0; id < unreachable.size(); ++id) {
    if (!unreachable[id].empty()) probed.push_back(id);
  }
  std::stable_sort(probed.begin(), probed.end(), [&](std::size_t a, std::size_t b) {
    return unreachable[a].size() > unreachable[b].size();
  });
  // The figures of the regions do not depend on each other and are computed in parallel.
  std::vector<RegionProbe> probes(unreachable.size());  // [region]
  absl::StatusOr<BorderNet> net;
  absl::StatusOr<std::vector<std::vector<std::vector<Vec3>>>> borders;
  absl::StatusOr<RegionLabels> grid;
  PM_RETURN_IF_ERROR(ParallelFor(run, "regions: figures", 3 + probed.size(), [&](std::size_t k) {
    if (k >= 3) {
      const std::size_t id = probed[k - 3];
      probes[id] = ProbeRegion(split, reach, params, {numbered.regions[id].reason, unreachable[id]}, run);
    } else if (k == 0) {
      net = FindBorderLines(split, triangles, border, numbered.regions, run);
    } else if (k == 1) {
      borders = RegionBorders(split, triangles, border, params.border_tolerance, run);
    } else {
      grid = LabelCells(split.meshes, triangles, run);
    }
  }));
  for (const absl::Status& status : {net.status(), borders.status(), grid.status()})
    PM_RETURN_IF_ERROR(status);
  RegionMap map;
  map.regions = numbered.regions;
  map.border_lines = std::move(net->lines);
  map.nodes = std::move(net->nodes);
  map.cells = grid->cells;
  map.labels = std::move(grid->labels);
  map.component_region = triangles.component_region;
  map.components = std::move(grid->components);
  const std::vector<RegionPlace> places = PlaceRegions(split, triangles, map);
  std::vector<std::vector<PatchId>> patches = PatchesOfRegions(surface, triangles);
  for (std::size_t id = 0; id < map.regions.size(); ++id) {
    Region& region = map.regions[id];
    region.inside = places[id].inside;
    region.z_min = places[id].z_min;
    region.z_max = places[id].z_max;
    region.deepest_leftover = probes[id].deepest_leftover;
    region.largest_tool_diameter = probes[id].largest_tool_diameter;
    region.border = std::move((*borders)[id]);
    region.patches = std::move(patches[id]);
  }
  return map;
}

}  // namespace patchmill
