// Vertices on edges [joining, section 6]: the edges they divide, and the order in which they can be placed.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "core/joining/edge_table.h"
#include "core/joining/network_findings.h"

namespace patchmill {

// Smallest distance between two places on an edge, as a share of its parameter.
inline constexpr double kMinEdgePart = 1e-3;

using EdgeByEnds = std::map<std::pair<int, int>, int>;  // ascending vertices -> index in the table
struct DividedEdges {
  std::map<std::pair<int, int>, TableEdge> parts;  // not in the table yet, and without faces
  bool sound = true;
};

// INVALID_REFERENCE, INVALID_T_VERTEX: an end that does not exist or is the vertex itself, or a place nearer
// to an end than kMinEdgePart. Returns true if there is no finding; then DivideEdges may be called.
bool CheckTReferences(const CurveNetwork& network, const NetworkWriter& findings);

// Adds divided edges that are not listed to the table, fills t_vertices in the order of vertices, and returns
// the parts between neighbouring places. INVALID_T_VERTEX: two places too near to each other, or a part that
// is itself listed or divided.
DividedEdges DivideEdges(const CurveNetwork& network, const NetworkWriter& findings, EdgeByEnds& by_ends,
                         EdgeTable& table);

// Needs a table whose edges know their faces. INVALID_T_VERTEX: no face or several along the whole edge; a
// vertex that is a corner of the leading face; no face along a part; a side that skips a place; a normal
// where the leading face gives it. Returns false after a finding.
bool CheckTVertices(const CurveNetwork& network, const NetworkWriter& findings, const EdgeTable& table);

// Sorts t_vertices, which must be checked. T_VERTEX_CYCLE: edges that wait for each other.
void OrderTVertices(const CurveNetwork& network, const NetworkWriter& findings, EdgeTable& table);

// Corners (as face, corner) at the vertex that have a side along a part of its edge.
std::vector<FaceSide> CornersAlong(const CurveNetwork& network, const EdgeTable& table, const TVertex& t);

}  // namespace patchmill
