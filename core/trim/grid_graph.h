// A part of a face's border in grid coordinates, as the graph of a polynomial.
#pragma once

#include <optional>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

// Over [from, to] of one coordinate the other one is the Bernstein polynomial with the coefficients `c`. Ends
// are shared exactly with the graphs beside it. Seen along either axis it is monotonic.
struct GridGraph {
  bool along_u = true;          // V as a function of U; otherwise U as a function of V
  double from = 0.0, to = 1.0;  // from < to
  std::vector<double> c;

  Vec2 start() const { return along_u ? Vec2{from, c.front()} : Vec2{c.front(), from}; }
  Vec2 end() const { return along_u ? Vec2{to, c.back()} : Vec2{c.back(), to}; }
  bool level() const;             // all coefficients are equal: an iso-parametric line
  double lowest(int axis) const;  // of the coordinate 0 (U) or 1 (V)
  double highest(int axis) const;
};

// The straight graph between two places that differ in at least one coordinate. It is a graph of that
// coordinate in which they differ most; of U where they differ alike.
GridGraph StraightGraph(const Vec2& a, const Vec2& b);

// The other coordinate at `x`, between from and to.
double ValueAt(const GridGraph& graph, double x);
// Finds the place at which the other coordinate is `value`, which lies between those of the ends. To 1e-15.
double WhereValue(const GridGraph& graph, double value);

// The two parts beside the line on which coordinate `axis` is `at`, lower one first; `at` lies strictly
// between the graph's ends. Their common end lies on that line exactly.
struct GraphParts {
  GridGraph low, high;
};
GraphParts CutGraph(const GridGraph& graph, int axis, double at);

// Approximates the curve by a graph of the other coordinate: a polynomial of the degree with the same ends,
// through points of the curve at equal steps. Absent if the ends do not differ in that coordinate.
std::optional<GridGraph> TurnedGraph(const GridGraph& graph, int degree);

// The Bernstein coefficients, kept between the ends' and monotonic, of the polynomial of degree 1 to 3
// through values at equal steps.
std::vector<double> ThroughValues(const std::vector<double>& values);

}  // namespace patchmill
