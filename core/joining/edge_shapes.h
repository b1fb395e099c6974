// Makes the curve of an edge from its description in the network [joining, section 2].
#pragma once

#include <optional>

#include "core/joining/join_frame.h"

namespace patchmill {

// The degree is >= 3. A part takes its curve from the whole edge in `edges`, which must be made already.
// nullopt after a finding: CHORD_ALONG_NORMAL, NO_FIT, UNSUPPORTED_CURVE, CURVE_OFF_VERTEX.
std::optional<BezierChain> MakeEdgeCurve(const JoinFrame& frame, const std::vector<JoinedEdge>& edges,
                                         const TableEdge& edge);

// Replaces a curve that could not be made, so that the search for faults can continue.
BezierChain StraightEdge(const JoinFrame& frame, const TableEdge& edge);

}  // namespace patchmill
