// Vertices on edges [joining, section 6]: what they divide, and in which order they can be found.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "core/joining/edge_table.h"
#include "core/joining/network_findings.h"

namespace patchmill {

// Nearest two places on an edge, of its parameter.
inline constexpr double kMinEdgePart = 1e-3;

using EdgeByEnds = std::map<std::pair<int, int>, int>;  // ascending vertices -> index in the table
struct DividedEdges {
  std::map<std::pair<int, int>, TableEdge> parts;  // not in the table yet, and without faces
  bool sound = true;
};

// INVALID_REFERENCE, INVALID_T_VERTEX: an end that does not exist or is the vertex itself, a place nearer to
// an end than kMinEdgePart. What passes may be divided.
bool CheckTReferences(const CurveNetwork& network, const NetworkWriter& findings);

// Adds divided edges that are not listed to the table, fills t_vertices in the order of vertices, and returns
// the parts between neighbouring places. INVALID_T_VERTEX: two places too near to each other; a part that is
// listed or divided itself.
DividedEdges DivideEdges(const CurveNetwork& network, const NetworkWriter& findings, EdgeByEnds& by_ends,
                         EdgeTable& table);

// Of a table whose edges know their faces. INVALID_T_VERTEX: no face or several along the whole edge; the
// leading face's own corner; no face along a part; a side that skips a place; a normal where the leading face
// gives it. False after a finding.
bool CheckTVertices(const CurveNetwork& network, const NetworkWriter& findings, const EdgeTable& table);

// Sorts t_vertices that were checked. T_VERTEX_CYCLE: edges that wait for each other.
void OrderTVertices(const CurveNetwork& network, const NetworkWriter& findings, EdgeTable& table);

// Corners (as face, corner) at the vertex with a side along a part of its edge.
std::vector<FaceSide> CornersAlong(const CurveNetwork& network, const EdgeTable& table, const TVertex& t);

}  // namespace patchmill
