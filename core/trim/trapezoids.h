// A region of the plane between arcs, cut into trapezoids by walls along y: two arcs, one above the other,
// with the same x at every parameter [trimming, section 6].
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/base/vec.h"

namespace patchmill {

// A part of the region's border, homogeneous (w x, w y, w), at least two points, w > 0. x does not decrease.
struct BorderArc {
  std::vector<Vec3> points;
  int use = 0;                  // number of the edge's use that it is a part of
  double from = 0.0, to = 1.0;  // parameters of that edge at the first and the last point

  int degree() const { return static_cast<int>(points.size()) - 1; }
  double x0() const { return points.front().x() / points.front().z(); }
  double x1() const { return points.back().x() / points.back().z(); }
};

Vec2 PointOn(const BorderArc& arc, double s);
// Makes a point of an arc's control polygon, one of its ends, lie at a place.
void MoveEnd(Vec3& end, const Vec2& to);

// Ends of arcs that differ in x by at most `same_x` get the same x, that of the first of them, or 0 or 1
// where that is among them. Arcs that then run along y are left out, the others turned so that x rises.
struct WalledArcs {
  std::vector<BorderArc> arcs;
  double moved = 0.0;  // the farthest that an end has moved in x
};
WalledArcs ArcsBetweenWalls(std::vector<BorderArc> arcs, double same_x);

// Both have the same degree, weights and x coordinates, so that all rulings between them run along y.
struct ArcPair {
  BorderArc below, above;
};
struct Trapezoids {
  std::vector<ArcPair> pairs;    // thinner ones than `thinnest` are left out
  std::vector<BorderArc> parts;  // of the arcs given, as the walls have cut them
};

// `arcs`: all of the border but what runs along y; x0 < x1. Walls stand at all their ends. Where two arcs
// above each other are both curved, a straight line is laid between them; where none fits, the trapezoid is
// halved. FAILED_PRECONDITION if a wall crosses the border an odd number of times. Cost O(n^2).
absl::StatusOr<Trapezoids> CutIntoTrapezoids(const std::vector<BorderArc>& arcs, double thinnest,
                                             const RunContext& run);

}  // namespace patchmill
