// The curve of an edge from what the network says about it [joining, section 2].
#pragma once

#include <optional>

#include "core/joining/join_frame.h"

namespace patchmill {

// Degree >= 3. A part of another edge takes its curve from that one in `edges`, which must be there. Nothing
// after a finding: CHORD_ALONG_NORMAL, NO_FIT, UNSUPPORTED_CURVE, CURVE_OFF_VERTEX.
std::optional<BezierChain> MakeEdgeCurve(const JoinFrame& frame, const std::vector<JoinedEdge>& edges,
                                         const TableEdge& edge);

// Stands in for a curve that could not be made, so that the search for faults goes on.
BezierChain StraightEdge(const JoinFrame& frame, const TableEdge& edge);

}  // namespace patchmill
