// The topology of a curve network: edges with the faces beside them, groups of faces around each vertex.
//
// A table of its own, as input still to be judged: OpenMesh, which carries the finished patches
// (core/network/half_edges.h), refuses a face the moment it would make an edge or a vertex non-manifold, one
// at a time and without a word about the rest, while everything wrong with a network is told at once, with
// the names its drawer gave. Vertices on edges, too, have no place in a mesh.
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

// Where a part of an edge starts and ends on the whole one: from < to, of its parameter.
struct EdgePart {
  int whole = 0;  // edge
  double from = 0.0, to = 1.0;
};

struct TableEdge {
  int start = 0, end = 0;
  std::vector<FaceSide> faces;  // 1 or 2 in a sound network; 1 of a part and of an edge with parts
  std::optional<int> given;     // entry of CurveNetwork::edges that describes it
  bool crease = false;          // of a part: that of the whole
  std::optional<EdgePart> part = {};
  bool divided = false;         // vertices lie on it
  std::vector<int> parts = {};  // of a divided edge, those with a face, from its start
};

// A vertex on an edge.
struct TVertex {
  int vertex = 0;
  int edge = 0;                        // the whole one
  double at = 0.5;                     // its parameter
  std::vector<FaceSide> corners = {};  // at the vertex: face, corner
};

struct EdgeTable {
  std::vector<TableEdge> edges;                // listed ones first, then by face and side
  std::vector<std::array<int, 4>> face_edges;  // of each face side; triangles use three
  std::vector<std::array<int, 4>> group;       // of each face corner: number of its group around the vertex
  std::vector<double> sense;  // of each face: +1 or -1 makes neighbours run their edges opposite ways
  int group_count = 0;
  std::vector<TVertex> t_vertices;  // each after those its edge and the face beside it wait for

  bool Forward(const FaceSide& s, const CurveNetwork& network) const;  // the side runs with its edge
};

// Codes of errors: those of CheckEdgeShapes, PATCH_COUNT, NOT_FINITE, TOO_LARGE, INVALID_REFERENCE,
// FACE_SIDES, DUPLICATE_VERTEX, ZERO_LENGTH_EDGE, DUPLICATE_EDGE, NON_MANIFOLD_EDGE, NON_MANIFOLD_VERTEX,
// DANGLING_EDGE, CONTRADICTORY_CREASE, INVALID_TWIST, INVALID_NORMAL, INVALID_PUSH, INVALID_JOIN_TOLERANCE,
// UNUSED_VERTEX; INVALID_T_VERTEX, T_VERTEX_CYCLE (t_vertices.h). All findings at once as far as they make
// sense; the table is sound when none is an error. Cost O(n log n).
EdgeTable BuildEdgeTable(const CurveNetwork& network, Diagnostics& findings);

inline int SideCount(const NetworkFace& face) { return static_cast<int>(face.vertices.size()); }

}  // namespace patchmill
