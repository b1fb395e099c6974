// Which side of upright surface is air, and which is material.
//
// A 3-axis tool sees the upper side of any surface that is not upright. Upright surface has no upper side:
// the surface that it is joined to decides. A wall that leans by less than files round counts as upright
// (UprightOf). Patches joined by edges (T-junctions too) form a component. The
// air side of a component is the side from which its surface is open to the sky.
#pragma once

#include <vector>

#include "core/surface/surface.h"

namespace patchmill {

struct AirSides {
  // Of each patch, in its own parameters: 1 the side of du x dv, -1 the other, 0 unknown or nothing upright.
  std::vector<int> of_patch;
  // Patches with upright surface whose air side is unknown, rising: nothing open to the sky is joined to
  // them, or both sides of what is joined to them are open to the sky, or their component is one-sided.
  std::vector<PatchId> undecided;
};

// Piece::upright: kUprightFace, or more for a piece that leans by at most 5 um over its height, and by a hundredth of
// that height. Cost: 25 normals.
double UprightOf(const Piece& piece);

// `surface` has its pieces (with `upright`), leaves and trees. The share of a component's surface that is open to the sky is
// measured in plan at up to 2,000 places; one side decides with nine tenths of it. Where neither does, a
// patch takes the side that all its open neighbours agree on. Deterministic. Cost: nine normals a piece; some
// microseconds a place for components with upright surface. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<AirSides> FindAirSides(const Surface& surface, const RunContext& run);

// Writes each piece's side, in its own parameters.
void SetAirSides(const AirSides& sides, std::vector<Piece>& pieces);

}  // namespace patchmill
