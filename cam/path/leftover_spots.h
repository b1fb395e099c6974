// Where passes leave too much: the measurement behind RestPaths.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/coverage.h"
#include "cam/path/path_tree.h"

namespace patchmill {

// A part of a piece, u0 <= u1, v0 <= v1 in its own parameters.
struct SurfaceRect {
  PieceId piece;
  double u0 = 0.0, u1 = 1.0, v0 = 0.0, v1 = 1.0;
};

// A reachable surface point whose leftover is above the limit.
struct LeftoverSpot {
  SurfacePoint at;
  Vec3 normal = Vec3::UnitZ();  // towards the ball that finishes it
  Vec3 center = Vec3::Zero();   // at.p + R normal
  double leftover = 0.0;        // mm, cut off at the ball radius
  SurfaceRect rect;             // what it stands for, at most half a flat step wide
};

// All rectangles given are covered up to the limit, by proof, except where a spot is returned, where the
// surface is out of reach, or in rectangles of a twentieth of the flat step that exceed the limit by less
// than they can vary.
//   Proof: the distance of a hull to a segment is largest at its vertices, so a rectangle is covered when all
//   its control points lie within R + limit of one move (for zero-weight points see ALGORITHMS 1). Reach:
//   free for a ball of radius - tolerance at p + R e, tip not below the floor (DESIGN 2); whole rectangles
//   are dropped when the blocking is deeper than their centres can differ (normals sampled at the corners,
//   one and a half times).
// Deterministic, parallel. `trees`: all passes, in any number of trees.
absl::StatusOr<std::vector<LeftoverSpot>> FindSpots(const Locator& locator, const Locator& reach,
                                                    const std::vector<const PathTree*>& trees,
                                                    const std::vector<SurfaceRect>& rects,
                                                    const CoverageParams& params, const RunContext& run);

}  // namespace patchmill
