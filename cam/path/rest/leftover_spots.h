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
  SurfaceRect rect;  // the part of the surface that the spot represents, at most half a flat step-over wide
};

// Margins of the search, without which it would not end. A place that is called covered may have more
// leftover than the limit, by kProofMargin of params.tolerance. A place that is called a spot may be out of
// reach, by kReachMargin of the reach tolerance.
inline constexpr double kProofMargin = 0.1;
inline constexpr double kReachMargin = 0.05;

// Returns a locator of the ball with which FindSpots tests reach: smaller than the tool's ball by (1 +
// kReachMargin) ReachTolerance(params.tolerance). Where it is free the point counts as reachable, up to that
// margin.
absl::StatusOr<Locator> ReachLocator(const Locator& locator, const RestPassParams& params,
                                     const RunContext& run);

// The locator of the ball, and the ReachLocator of the same ball and tolerance. It refers to both.
struct RestLocators {
  const Locator& ball;
  const Locator& reach;
};

// Finds the spots on the given rectangles. Each rectangle is halved until one of three is true of each part:
// - Covered: the leftover is proven to be at most the limit plus params.margin. All control points lie within
//   R + limit of one move; the distance of a convex hull from a segment is largest at a vertex of the hull
//   (points of weight zero: [location T10]).
// - Out of reach, as proven by OutOfReach.
// - A spot: at its middle p the leftover exceeds the limit, and the ball of ReachLocator is free at p + R e
//   with its tip not below the floor [regions (6)].
//
// Because of the margins of covered and of reach a small rectangle is always decided. The search ends at
// rectangles of 0.2 % of the flat step-over. If no pass is near such a rectangle its corners are tested, too;
// so a narrower reachable island is found if it contains a corner. With params.removed a place is a spot only
// if the removed moves had finished it up to the limit and left less of it. With params.operation_limits only
// wanted points whose centres are allowed are spots; along those limits the search ends at 5 % of the flat
// step-over. `trees` hold all passes, in any number of trees. Deterministic, parallel.
absl::StatusOr<std::vector<LeftoverSpot>> FindSpots(const RestLocators& locators,
                                                    const std::vector<const SegmentTree*>& trees,
                                                    const std::vector<SurfaceRect>& rects,
                                                    const RestPassParams& params, const RunContext& run);

}  // namespace patchmill
