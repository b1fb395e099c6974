// The topology of a curve network: edges with the faces beside them, groups of faces around each vertex.
//
// The network has its own table because it is input that is not checked yet. OpenMesh, which carries the
// finished patches (core/network/half_edges.h), refuses a face that would make an edge or a vertex
// non-manifold, one face at a time and without a reason. Here all faults of a network are reported at once,
// with the names that its author gave. Nor does a mesh have vertices on edges.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/base/diagnostic.h"
#include "core/joining/curve_network.h"

namespace patchmill {

// Side `side` of face `face` runs from its vertex `side` to the next one.
struct FaceSide {
  int face = 0, side = 0;
};

// Parameters on the whole edge at which a part of it starts and ends: from < to.
struct EdgePart {
  int whole = 0;  // edge
  double from = 0.0, to = 1.0;
};

struct TableEdge {
  int start = 0, end = 0;
  std::vector<FaceSide> faces;  // 1 or 2 in a sound network; 1 for a part and for an edge with parts
  std::optional<int> given;     // entry of CurveNetwork::edges that describes it
  bool crease = false;          // a part takes it from the whole edge
  std::optional<EdgePart> part = {};
  bool divided = false;         // vertices lie on it
  std::vector<int> parts = {};  // the parts of a divided edge that have a face, from its start
};

// A vertex on an edge.
struct TVertex {
  int vertex = 0;
  int edge = 0;                        // the whole edge
  double at = 0.5;                     // its parameter
  std::vector<FaceSide> corners = {};  // (face, corner) of the corners at the vertex
};

struct EdgeTable {
  std::vector<TableEdge> edges;                // listed ones first, then by face and side
  std::vector<std::array<int, 4>> face_edges;  // of each face side; triangles use three
  std::vector<std::array<int, 4>> group;       // of each face corner: number of its group around the vertex
  std::vector<double> sense;  // of each face: +1 or -1 makes neighbours run their edges opposite ways
  int group_count = 0;
  std::vector<TVertex> t_vertices;  // each after the vertices that its edge and the leading face wait for

  bool Forward(const FaceSide& s, const CurveNetwork& network) const;  // the side runs with its edge
};

// Codes of errors: those of CheckEdgeShapes, PATCH_COUNT, NOT_FINITE, TOO_LARGE, INVALID_REFERENCE,
// FACE_SIDES, DUPLICATE_VERTEX, ZERO_LENGTH_EDGE, DUPLICATE_EDGE, NON_MANIFOLD_EDGE, NON_MANIFOLD_VERTEX,
// DANGLING_EDGE, CONTRADICTORY_CREASE, INVALID_TWIST, INVALID_NORMAL, INVALID_PUSH, INVALID_BULGE,
// INVALID_JOIN_TOLERANCE, UNUSED_VERTEX; INVALID_T_VERTEX, T_VERTEX_CYCLE (t_vertices.h). All findings
// that make sense are reported at once. The table is sound if none of them is an error. Cost O(n log n).
EdgeTable BuildEdgeTable(const CurveNetwork& network, Diagnostics& findings);

inline int SideCount(const NetworkFace& face) { return static_cast<int>(face.vertices.size()); }

}  // namespace patchmill
