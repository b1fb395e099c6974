// Divides a B-spline surface into a curve network [crossing, section 6].
#pragma once

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/joining/join_network.h"
#include "core/patch/patch.h"

namespace patchmill {

inline constexpr int kMaxDivisionParts = 64;

// Where faces end. kKnots: at every knot, so that polynomial surfaces come back exactly. kFewest: as few
// faces as keep the tolerance, wherever the surface has a continuous first derivative.
enum class DivisionLines { kKnots, kFewest };

struct Division {
  // Parts of each rectangle between knots (kFewest: of the surface), at least; 1 .. kMaxDivisionParts.
  int parts_u = 1, parts_v = 1;
  double tolerance = 1e-3;  // mm
  DivisionLines lines = DivisionLines::kKnots;
};

struct DividedSurface {
  CurveNetwork network;
  JoinedNetwork joined;
  Diagnostics findings;  // DIVISION_COARSE, and those of joining
  double max_distance =
      0.0;  // mm, of the joined patches from the surface, at 25 places or more of each knot rectangle
};

// Each face gets corner positions, cubic edges, normals and twists of the surface. So a polynomial surface
// of degree 3 or less both ways comes back to rounding. Others are met to the fourth order of the size of
// the faces: the parts are doubled (kFewest: those beside faces that are too far away are halved, at a knot
// near their middle if there is one) until the distance is within the tolerance, or the network would have
// more than kMaxNetworkFaces faces or kMaxDivisionParts parts between knots. Where the surface has a crease
// at a knot, so has the network. A side that is one point becomes a pole: the faces at it have three sides.
// Opposite sides that are one curve become a seam that is as smooth as the surface is there. Errors of
// `run`; INVALID_ARGUMENT for a surface of too many rectangles.
absl::StatusOr<DividedSurface> DivideSurface(const BsplinePatch& patch, const Division& division,
                                             const RunContext& run);

}  // namespace patchmill
