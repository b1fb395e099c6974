// Finds which side of vertical faces is air and which is material.
//
// A 3-axis tool sees the upper side of any surface that is not vertical. A vertical face has no upper side,
// so the surface that it is joined to decides. Patches joined by edges (T-junctions too) form a component.
// The air side of a component is the side from which its surface is open to the sky.
#pragma once

#include <vector>

#include "core/surface/surface.h"

namespace patchmill {

struct AirSides {
  // Index: patch. In its own parameters: 1 for the side of du x dv, -1 for the other side, 0 if unknown or if
  // nothing is vertical.
  std::vector<int> of_patch;
  // Patches with vertical faces whose air side is unknown, in ascending order. The reason is one of three:
  // nothing that is open to the sky is joined to them; both sides of the joined surface are open to the sky;
  // their component is one-sided.
  std::vector<PatchId> undecided;
};

// Returns Piece::upright, the largest |e_z| with which a place of the piece counts as a vertical face. It is
// kUprightFace. On a piece that leans by at most 5 um over its height, and by at most a hundredth of that
// height, it is so much that all of the piece counts as vertical. Cost: 25 normals.
double UprightOf(const Piece& piece);

// `surface` must have its pieces (with `upright`), leaves and trees. Up to 2,000 places of a component tell
// how much of its area, as seen from above, is open to the sky, and from which side. A side that has nine
// tenths of the open area is the air side of the component. If neither side has so much, a vertical patch
// takes the side on which all its neighbours that are open to the sky agree. Deterministic. Cost: nine
// normals per piece, and some microseconds per place for components with vertical faces. CANCELLED and
// DEADLINE_EXCEEDED from `run`.
absl::StatusOr<AirSides> FindAirSides(const Surface& surface, const RunContext& run);

// Writes the air side of each piece, in the piece's own parameters.
void SetAirSides(const AirSides& sides, std::vector<Piece>& pieces);

}  // namespace patchmill
