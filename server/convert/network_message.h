// CurveNetwork (mm) -> v1.CurveNetwork.
#pragma once

#include "core/joining/curve_network.h"
#include "patchmill/v1/network.pb.h"

namespace patchmill {

// The message of a network that was made here: its lengths are in millimetres. Edges are from normals, from
// tangents, Bezier curves or B-splines; there are no lines, no controls and no pushes.
v1::CurveNetwork ToProto(const CurveNetwork& network);

// Replaces the files of edges by the curves that were read from them. `network` was read from `proto`, whose
// length unit is `unit` mm.
void PutCurvesInPlace(const CurveNetwork& network, double unit, v1::CurveNetwork* proto);

}  // namespace patchmill
