// Pushes a face in or out at a picked place by the twists of its edges [editing (1), (2)]. Corners, edge
// curves and the tangent planes at the corners stay.
#pragma once

#include "core/joining/network_findings.h"

namespace patchmill {

// A place beside an edge: `along` it and `away` from it, both in [0,1].
struct EdgePlace {
  double along = 0.0, away = 0.0;
};

// The place of the push relative to side `side` of a face of 3 or 4 sides; `along` runs as the face does.
EdgePlace PlaceBeside(const FacePush& push, int sides, int side);

// Vectors at the ends of an edge.
struct EndVectors {
  Vec3 start, end;
};

// Returns what [editing (2)] adds to the wished twists of a patch with the cross tangents `across` at the
// ends of an edge, whose true end derivatives are `along`. amount > 0 pushes along b x C'. Its unit is
// 1/length, because b x C' is a length squared.
EndVectors PushTwists(const EndVectors& along, const EndVectors& across, const EdgePlace& place,
                      double amount);

// INVALID_TWIST: twists of no side of the face, two of one side, or a number that is not finite.
void CheckTwists(const CurveNetwork& network, const NetworkWriter& findings);

// INVALID_PUSH: a place outside the face, or an amount that is not finite.
void CheckPushes(const CurveNetwork& network, const NetworkWriter& findings);

// INVALID_BULGE: bulges of a triangle, too many of them, a place too near to the border or outside the face,
// or a vector that is not finite.
void CheckBulges(const CurveNetwork& network, const NetworkWriter& findings);

}  // namespace patchmill
