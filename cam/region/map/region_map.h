// The map of a surface: its areas are mountain, basin or neutral, steep or gentle, or a ball of this size
// cannot reach them [regions].
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/limits/operation_limits.h"
#include "cam/location/locator.h"
#include "core/base/run_context.h"
#include "core/base/typed_id.h"

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

// Why a line is a border of regions.
enum class BorderKind {
  kOpenEdge,    // the surface ends
  kReach,       // limit of reach
  kSlope,       // slope = steep angle
  kCurvature,   // contour curvature = 0: contours change from bending outward to bending inward
  kSilhouette,  // the surface is vertical, and its contours bend the other way on the other side
  kWatershed,   // between two mountains or two basins
  kSeam,        // border of two patches across which slope or curvature jumps
  kStrategy,    // limit of the area that forced passes finish
};

const char* Name(RegionKind kind);
const char* Name(SlopeClass slope);
const char* Name(UnreachableReason reason);
const char* Name(BorderKind kind);

struct RegionParams {
  double radius = 3.0;      // mm, ball + stock to leave
  double tolerance = 0.01;  // mm, the whole error budget; ReachTolerance of it decides what is reachable
  double steep_angle = Radians(45.0);
  double floor_z = -kInfinity;     // mm, lowest tip
  double border_tolerance = 0.01;  // mm, sagitta of border polylines on the true curves
  // How finely the surface is divided, from 0 (coarse, the same as 0.05) to 1 (the raw split, nothing is
  // merged). At a detail d below 1:
  // - regions smaller than 2 pi R^2 (1-d)/d or narrower than R (1-d)/d join a neighbour;
  // - the cost of a border is proportional to (1-d)/d (merge_regions.h);
  // - summits and pits that persist divide mountains and basins (height_tops.h);
  // - at most 40 d reachable regions remain, unless no two of them may be joined.
  double detail = 0.5;
  // A place whose centre is not allowed is unreachable. The reason is kOutside if the centre is forbidden
  // only because it lies beside the part, kShank or kHolder if only these are in the way, else kAvoided.
  // null allows all centres.
  const OperationLimits* operation_limits = nullptr;
  // Continuous; > 0 where forced passes finish the surface. Elsewhere the reason is kStrategy. Empty if
  // nothing is forced.
  std::function<double(const SurfaceJet&)> finished = nullptr;
};

// An area that forced passes do not finish (kStrategy) is a region of its own. It has the kind and slope that
// prevail in it, and it is reachable and cut like any other. With any other reason the kind is kUnreachable.
struct Region {
  RegionId id;
  RegionKind kind = RegionKind::kNeutral;
  SlopeClass slope = SlopeClass::kGentle;
  UnreachableReason reason = UnreachableReason::kNone;
  double area = 0.0;           // mm^2 on the surface
  Vec3 inside = Vec3::Zero();  // a point of the region
  double z_min = 0.0, z_max = 0.0;
  double deepest_leftover = 0.0;          // mm, if it has a reason: deepest material left (leftover.h)
  double largest_tool_diameter = 0.0;     // mm, if CONCAVE: largest ball that reaches all of it; 0 if none
  std::vector<std::vector<Vec3>> border;  // closed polylines on the surface
  std::vector<PatchId> patches;           // patches that it has a part of, rising
};

// A line on the surface between two regions, or where one region ends.
struct BorderLine {
  BorderKind kind = BorderKind::kSlope;
  // The regions on the two sides, the lower id first, and their components there. If the surface ends, the
  // other side has none.
  RegionId region = kNoRegion, other = kNoRegion;
  ComponentId component = kNoComponent, other_component = kNoComponent;
  bool closed = false;     // the last point is joined to the first, which is not repeated
  int from = -1, to = -1;  // nodes of the map at its ends; -1 if it is closed
  std::vector<Vec3> points;
};

struct RegionMap {
  std::vector<Region>
      regions;  // index = id; reachable regions first, then unreachable ones, each by falling area
  std::vector<BorderLine> border_lines;  // each once
  std::vector<Vec3> nodes;  // ends of border lines, where three or more lines meet, or two of different kinds
  // Labels for lookup. Each piece has a grid of cells x cells. The label of a cell is the region at its
  // centre, or kNoRegion.
  int cells = 0;
  std::vector<std::vector<RegionId>> labels;  // [piece][i * cells + j], i along u
  // A region may consist of several connected components.
  std::vector<RegionId> component_region;            // [component]: its region, rising
  std::vector<std::vector<ComponentId>> components;  // like `labels`; empty if every region is one component

  // The component or region at a cell or surface point; kNoComponent or kNoRegion if there is none.
  ComponentId ComponentAt(std::size_t piece, std::size_t cell) const {
    return components.empty() ? ComponentId(labels[piece][cell].value) : components[piece][cell];
  }

  ComponentId ComponentAt(const SurfacePoint& p) const { return ComponentAt(p.piece.index(), CellOf(p)); }
  RegionId At(const SurfacePoint& p) const { return labels[p.piece.index()][CellOf(p)]; }

 private:
  std::size_t CellOf(const SurfacePoint& p) const {
    const int i = std::min(cells - 1, static_cast<int>(p.u * cells)),
              j = std::min(cells - 1, static_cast<int>(p.v * cells));
    return static_cast<std::size_t>(i * cells + j);
  }
};

}  // namespace patchmill
