// Cross rows of all sides of G2-Gregory faces in a network [joining, section 8].
#pragma once

#include <vector>

#include "core/joining/join_network.h"
#include "core/joining/network_findings.h"

namespace patchmill {

// Fills `rows` and `equal_curvature` of every edge beside a G2-Gregory face. Two such faces share one strip
// where the curves that cross the edge continue with equal curvature. At creases and borders each side has
// its own strip. Elsewhere the tangent plane of `tangents` is taken, with a warning TANGENT_PLANE_ONLY that
// says why. Errors: INVALID_CONTROL (controls for a face that is not beside the edge or is no G2-Gregory
// patch, two for one face, vectors that nothing can follow), NOT_FINITE.
void AddCurvatureRows(const CurveNetwork& network, const EdgeTable& table, const NetworkWriter& findings,
                      std::vector<JoinedEdge>& edges);

}  // namespace patchmill
