// Where passes leave too much: the measurement behind RestPaths.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/reach/cell_reach.h"
#include "cam/path/rest/rest_passes.h"
#include "cam/toolpath/segment_tree.h"

namespace patchmill {

// A reachable surface point whose leftover is above the limit.
struct LeftoverSpot {
  SurfacePoint at;
  Vec3 normal = Vec3::UnitZ();  // towards the ball that finishes it
  Vec3 center = Vec3::Zero();   // at.p + R normal, or straight above it on the floor
  double leftover = 0.0;        // mm, cut off at the ball radius
  SurfaceRect rect;             // what it stands for, at most half a flat step wide
};

// Shares of params.tolerance and of ReachTolerance by which the search goes beyond what is asked, so that it
// ends:
// what is said to be covered may exceed the limit by one, spots may be out of reach by the other.
inline constexpr double kProofMargin = 0.1;
inline constexpr double kReachMargin = 0.05;

// A smaller ball that is free wherever a point counts as reachable, or nearly so: what FindSpots asks.
absl::StatusOr<Locator> ReachLocator(const Locator& locator, const RestPassParams& params,
                                     const RunContext& run);

// Halves the rectangles given until each is proven covered (up to the limit and params.margin), proven out of
// reach (OutOfReach), or stands for a spot: its middle exceeds the limit and is free for a ball of radius -
// (1 + kReachMargin) ReachTolerance at p + R e, tip not below the floor ([regions (6)]). Of the two margins
// one
// always holds at small rectangles. It ends at 0.2 % of the flat step; where no pass is near, the corners of
// such a rectangle are asked too, so that islands of reach narrower than that are seen where they lie along
// one. With params.taken only places count that those moves finished up to the limit and left less of. With
// params.operation_limits only wanted points at allowed centres are spots; along its limits the search ends
// at
// 5 % of the flat step.
//   Covered: the distance of a hull to a segment is largest at its vertices, so a rectangle is covered when
//   all its control points lie within R + limit of one move (for zero-weight points see [location T10]).
// Deterministic, parallel. `trees`: all passes, in any number of trees.
absl::StatusOr<std::vector<LeftoverSpot>> FindSpots(const Locator& locator, const Locator& reach,
                                                    const std::vector<const SegmentTree*>& trees,
                                                    const std::vector<SurfaceRect>& rects,
                                                    const RestPassParams& params, const RunContext& run);

}  // namespace patchmill
