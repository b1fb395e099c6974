// The surface split by what it is: mountain, basin, neutral x steep, gentle; and what no ball of this size
// reaches [regions].
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/limits/operation_limits.h"
#include "cam/location/locator.h"
#include "core/base/run_context.h"

namespace patchmill {

enum class RegionKind { kMountain, kBasin, kNeutral, kUnreachable };
enum class SlopeClass { kUnspecified, kSteep, kGentle };
enum class UnreachableReason {
  kNone,
  kUndercut,
  kConcave,
  kFloor,
  kAvoided,
  kStrategy,
  kHolder,
  kShank,
  kOutside
};

// What makes a line a border of regions.
enum class BorderKind {
  kOpenEdge,    // the surface ends
  kReach,       // limit of reach
  kSlope,       // slope = steep angle
  kCurvature,   // contour curvature 0: contours turn from bending outward to bending inward
  kSilhouette,  // the surface is upright, and its contours bend the other way beyond
  kWatershed,   // between two mountains or two basins
  kSeam,        // a border of patches across which slope or curvature jump
  kStrategy,    // limit of what forced passes finish
};

const char* Name(RegionKind kind);
const char* Name(SlopeClass slope);
const char* Name(UnreachableReason reason);
const char* Name(BorderKind kind);

struct RegionParams {
  double radius = 3.0;      // mm, ball + stock to leave
  double tolerance = 0.01;  // mm: the whole budget; reachable is what cam/limits/reach_tolerance.h says
  double steep_angle = Radians(45.0);
  double floor_z = -kInfinity;     // mm, lowest tip
  double border_tolerance = 0.01;  // mm, sagitta of border polylines on the true loci
  // How finely the surface is divided, 0 (coarse) to 1 (the raw split: nothing is merged). Of less than 1, at
  // detail d: regions below 2 pi R^2 (1-d)/d, or narrower than R (1-d)/d, join a neighbour, borders cost in
  // the same proportion (merge_regions.h), summits and pits that persist divide mountains and basins
  // (height_tops.h), and at most 40 d reachable regions remain, those without a neighbour not counted.
  double detail = 0.5;
  // Where it allows no centre the reason is kOutside if the centre is only forbidden beside the part, kShank
  // if only the shank is in the way, else kAvoided; null: allows all.
  const OperationLimits* operation_limits = nullptr;
  // > 0 where forced passes finish the ground, continuous; where they do not the reason is kStrategy. Empty:
  // nothing is forced.
  std::function<double(const SurfaceJet&)> finished = nullptr;
};

// Ground that forced passes do not finish (kStrategy) is a region apart, of the kind and the slope that most
// of it has: reached all the same, and cut like any other. The other reasons make it kUnreachable.
struct Region {
  int id = 0;
  RegionKind kind = RegionKind::kNeutral;
  SlopeClass slope = SlopeClass::kGentle;
  UnreachableReason reason = UnreachableReason::kNone;
  double area = 0.0;           // mm^2 on the surface
  Vec3 inside = Vec3::Zero();  // a point of the region
  double z_min = 0.0, z_max = 0.0;
  double step_min = 0.0, step_max = 0.0;  // mm between passes for the scallop; filled by cam/plan, else 0
  double wanted_share = 1.0;              // of its area, selected; filled by cam/plan
  double otherwise_share = 0.0;           // of its area, of the other slope and cut like that; by cam/plan
  double deepest_leftover = 0.0;          // mm, regions with a reason: how much stays (leftover.h)
  double largest_tool_diameter = 0.0;     // mm, unreachable CONCAVE ones: reaches all of it (0: none does)
  std::vector<std::vector<Vec3>> border;  // closed polylines on the surface
  std::vector<PatchId> patches;           // those it has a part of, rising
};

// A line on the surface between two regions, or where one ends.
struct BorderLine {
  BorderKind kind = BorderKind::kSlope;
  int region = -1, other = -1;               // ids, the lower one first; other = -1: the surface ends
  int component = -1, other_component = -1;  // of those regions, on its sides
  bool closed = false;                       // the last point joins the first and is not repeated
  int from = -1, to = -1;                    // nodes of the map, of lines that are not closed
  std::vector<Vec3> points;
};

struct RegionMap {
  std::vector<Region>
      regions;  // ids are positions; reachable ones first, by falling area; then unreachable ones
  std::vector<BorderLine> border_lines;  // each once
  std::vector<Vec3> nodes;               // where lines end: three or more meet, or two of different kinds
  // Labels for lookup: per piece a grid of cells x cells, label of the cell's centre (id into regions, -1
  // none).
  int cells = 0;
  std::vector<std::vector<int>> labels;  // [piece][i * cells + j], i along u
  // Regions may fall into components, each of which hangs together: the regions of these, rising, and the
  // components of cells like `labels`, which are empty where every region is one component.
  std::vector<int> component_region;
  std::vector<std::vector<int>> components;

  // -1: none.
  int ComponentAt(std::size_t piece, std::size_t cell) const {
    return (components.empty() ? labels : components)[piece][cell];
  }

  int ComponentAt(const SurfacePoint& p) const { return ComponentAt(p.piece.index(), CellOf(p)); }
  int At(const SurfacePoint& p) const { return labels[p.piece.index()][CellOf(p)]; }

 private:
  std::size_t CellOf(const SurfacePoint& p) const {
    const int i = std::min(cells - 1, static_cast<int>(p.u * cells)),
              j = std::min(cells - 1, static_cast<int>(p.v * cells));
    return static_cast<std::size_t>(i * cells + j);
  }
};

}  // namespace patchmill
