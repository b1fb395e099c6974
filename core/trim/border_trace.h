// Traces the edges of a face on its surface, in grid coordinates, and fits graphs to them.
//
// The curve in space is the truth. A place of the border is the foot of a point of that curve on the surface
// [trimming, section 3].
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/brep/brep_model.h"
#include "core/trim/carrier_grid.h"
#include "core/trim/grid_graph.h"
#include "core/trim/spanned_curve.h"

namespace patchmill {

// One edge of a face on the face's grid. Samples run from the begin of the edge's curve to its end.
struct UseTrace {
  int edge = 0;
  bool forward = true;
  bool degenerate = false;
  // The coordinate that is constant along the edge (an iso-parametric line): 0 U, 1 V, -1 none.
  int iso = -1;
  double constant = 0.0;
  std::vector<double> at;     // parameters of the edge's curve, increasing
  std::vector<Vec2> places;   // grid coordinates
  Vec2 scale = Vec2::Ones();  // largest length of a unit of either coordinate along the edge, mm
  double gap = 0.0;           // largest distance of the edge from the surface, mm
  // mm^2, about: the area between the edge and the file's own curve on the surface, which may leave it.
  // Distances above kOpenLoop count as that.
  double area_beside = 0.0;

  const Vec2& begin() const { return forward ? places.front() : places.back(); }  // in the loop's direction
  const Vec2& end() const { return forward ? places.back() : places.front(); }
};

// The loops of a face. Neighbours in a loop meet exactly, iso-parametric lines are exactly constant, and
// constants closer than 1e-8 to each other or to a grid line are the same number.
struct BorderTrace {
  std::vector<std::vector<UseTrace>> loops;
  // Iso-parametric sides between neighbours in a loop that meet in space within 1e-5 mm, but not in grid
  // coordinates: the file has no edge for them. `edge` and `scale` mean nothing here.
  std::vector<UseTrace> short_sides;
  double gap = 0.0;          // mm, of all edges
  double area_beside = 0.0;  // mm^2, of all edges together
};

// mm: a loop whose neighbours are farther apart is open.
inline constexpr double kOpenLoop = 0.05;

// The edges' curves, as core/trim needs them; without spans for degenerate edges.
using EdgeCurveTable = std::vector<SpannedCurve>;

// An edge counts as iso-parametric where it leaves its line by at most `iso_tolerance` mm, or by twice its
// own distance from the surface. FAILED_PRECONDITION, naming the edge: it has no foot on the surface, or the
// loop is not closed there.
absl::StatusOr<BorderTrace> TraceBorder(const BrepFace& face, const EdgeCurveTable& curves,
                                        const CarrierGrid& grid, double iso_tolerance);

// The foot of the edge's point at a parameter; the ends are those of the trace.
Vec2 PlaceAt(const CarrierGrid& grid, const SpannedCurve& curve, const UseTrace& trace, double at);

// Parameters strictly between the edge's ends at which it crosses a grid line, turns back in U or V, or
// changes from flatter to steeper than 45 degrees, measured in mm. Sorted.
std::vector<double> NaturalBreaks(const CarrierGrid& grid, const SpannedCurve& curve, const UseTrace& trace);

// The part of an edge between two parameters as one graph within one carrier, in grid coordinates. The
// degrees of the carrier must allow strips (LargestStripDegree).
struct FittedGraph {
  GridGraph graph;
  double error = 0.0;  // mm, largest found at eight places
};
FittedGraph FitGraph(const CarrierGrid& grid, const SpannedCurve& curve, const UseTrace& trace, double from,
                     double to);

}  // namespace patchmill
