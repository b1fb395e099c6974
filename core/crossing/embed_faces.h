// The faces of a graph of curves: its edges are put in order around each node [crossing, section 3].
#pragma once

#include <optional>
#include <vector>

#include "core/crossing/curve_graph.h"

namespace patchmill {

struct GraphSide {
  int edge = 0;
  bool forward = true;
};

// Sides run anticlockwise around the face, seen from the side of the normals.
struct GraphFace {
  std::vector<GraphSide> sides;
};

struct Embedding {
  std::vector<Vec3> normals;  // of each node, unit; all on one side of the surface
  std::vector<GraphFace> faces;
  // The far sides of all borders: loops that bound no face.
  std::vector<GraphFace> outer;
  int groups = 0;  // of edges that are connected
};

// With a direction, the order is that of the projection along it. Without one, each node has the order of the
// plane nearest to the ends of its unit tangents. The senses of these planes are carried along the edges,
// those that agree best first.
Embedding EmbedFaces(const CurveGraph& graph, const std::optional<Vec3>& direction);

inline int StartOf(const CurveGraph& graph, const GraphSide& s) {
  const GraphEdge& e = graph.edges[static_cast<std::size_t>(s.edge)];
  return s.forward ? e.start : e.end;
}

// The angle from a to b, anticlockwise about n, [0, 2 pi).
double AngleAbout(const Vec3& n, const Vec3& a, const Vec3& b);

}  // namespace patchmill
