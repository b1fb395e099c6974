// The topology of a curve network: edges with the faces beside them, groups of faces around each vertex.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/base/diagnostic.h"
#include "core/joining/curve_network.h"

namespace patchmill {

// Side `side` of face `face`: from its vertex `side` to the next one.
struct FaceSide {
  int face = 0, side = 0;
};

struct TableEdge {
  int start = 0, end = 0;
  std::vector<FaceSide> faces;  // 1 or 2 in a sound network
  std::optional<int> given;     // entry of CurveNetwork::edges that describes it
  bool crease = false;
};

struct EdgeTable {
  std::vector<TableEdge> edges;                // listed ones first, then by face and side
  std::vector<std::array<int, 4>> face_edges;  // of each face side; triangles use three
  std::vector<std::array<int, 4>> group;       // of each face corner: number of its group around the vertex
  std::vector<double> sense;  // of each face: +1 or -1 makes neighbours run their edges opposite ways
  int group_count = 0;

  bool Forward(const FaceSide& s, const CurveNetwork& network) const;  // the side runs with its edge
};

// Codes of errors: those of CheckEdgeShapes, PATCH_COUNT, NOT_FINITE, TOO_LARGE, INVALID_REFERENCE,
// FACE_SIDES, DUPLICATE_VERTEX, ZERO_LENGTH_EDGE, DUPLICATE_EDGE, NON_MANIFOLD_EDGE, NON_MANIFOLD_VERTEX,
// DANGLING_EDGE, CONTRADICTORY_CREASE, INVALID_NORMAL, INVALID_PUSH, INVALID_JOIN_TOLERANCE, UNUSED_VERTEX.
// All findings at once as far as they make sense; the table is sound when none is an error. Cost O(n log n).
EdgeTable BuildEdgeTable(const CurveNetwork& network, Diagnostics& findings);

inline int SideCount(const NetworkFace& face) { return static_cast<int>(face.vertices.size()); }

}  // namespace patchmill
