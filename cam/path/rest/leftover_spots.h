// Finds where passes leave too much. RestPaths is built on it.
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
  double leftover = 0.0;        // mm, at most the ball radius
  SurfaceRect rect;             // the rectangle it stands for, at most half a flat step-over wide
};

// Shares of params.tolerance and of ReachTolerance by which the search exceeds its task, so that it ends. A
// place called covered may exceed the limit by the first, a spot may be out of reach by the second.
inline constexpr double kProofMargin = 0.1;
inline constexpr double kReachMargin = 0.05;

// Returns a locator for the smaller ball that is free wherever a point counts as reachable, or nearly so.
// FindSpots uses it.
absl::StatusOr<Locator> ReachLocator(const Locator& locator, const RestPassParams& params,
                                     const RunContext& run);

// The locator of the ball, and the ReachLocator of the same ball and tolerance. It refers to both.
struct RestLocators {
  const Locator& ball;
  const Locator& reach;
};

// Halves the given rectangles until each is proven covered (up to the limit and params.margin), is proven out
// of reach (OutOfReach), or stands for a spot. At a spot the middle exceeds the limit, and a ball of radius -
// (1 + kReachMargin) ReachTolerance is free at p + R e, with the tip not below the floor ([regions (6)]). One
// of the two margins always decides a small rectangle. The search ends at 0.2 % of the flat step-over. Where
// no pass is near, the corners of such a rectangle are tested too, so that reachable islands narrower than
// that are found if they lie along one. With params.removed only places count that those moves finished up to
// the limit and left less of. With params.operation_limits only wanted points at allowed centres are spots;
// along its limits the search ends at 5 % of the flat step-over.
//   Covered: the distance of a hull to a segment is largest at its vertices, so a rectangle is covered when
//   all its control points lie within R + limit of one move (for zero-weight points see [location T10]).
// Deterministic, parallel. `trees`: all passes, in any number of trees.
absl::StatusOr<std::vector<LeftoverSpot>> FindSpots(const RestLocators& locators,
                                                    const std::vector<const SegmentTree*>& trees,
                                                    const std::vector<SurfaceRect>& rects,
                                                    const RestPassParams& params, const RunContext& run);

}  // namespace patchmill
