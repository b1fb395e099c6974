// Curves that meet, as a graph: nodes where they meet, edges between [crossing, section 2].
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/diagnostic.h"
#include "core/crossing/find_crossings.h"

namespace patchmill {

// How the piece of a curve beyond its last meeting is treated.
enum class FreeEnds {
  kTrim,    // the piece is cut off, with a finding
  kRefuse,  // the piece is an error
};

struct GraphNode {
  Vec3 position = Vec3::Zero();  // mean of the places that meet
  double spread = 0.0;           // largest distance of one of them from it
};

// From node `start` to node `end` along parts of curves. Neighbouring parts meet within the tolerance.
struct GraphEdge {
  int start = 0, end = 0;
  std::vector<BezierChain> parts;
  std::vector<int> curves;  // of each part

  Vec3 Tangent(bool at_start) const;  // unit, away from that end
  double Length() const;
  Vec3 PointAt(double share) const;           // at a share of the length
  std::vector<Vec3> Points(int steps) const;  // steps + 1 of each part
};

struct CurveGraph {
  std::vector<GraphNode> nodes;
  std::vector<GraphEdge> edges;
  std::vector<std::vector<std::array<int, 2>>> ends;  // of each node: (edge, 0 at its start, 1 at its end)
};

// Codes: DOUBLED_CURVE, CURVES_TOUCH, CURVE_END_TRIMMED (an error CURVE_END_FREE if ends are refused),
// CURVE_UNUSED. Each names curve and place.
CurveGraph MakeCurveGraph(const std::vector<DrawnCurve>& curves, const Crossings& crossings, double tolerance,
                          FreeEnds free_ends, Diagnostics& findings);

// Sorts the ends of edges to nodes anew.
void FindEnds(CurveGraph& graph);

// "curves[3] (deck)".
std::string CurveName(const std::vector<DrawnCurve>& curves, int curve);

}  // namespace patchmill
