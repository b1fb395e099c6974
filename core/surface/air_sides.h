// Finds which side of vertical and overhanging faces is air and which is material.
//
// A 3-axis tool sees the upper side of any surface that is not vertical. A vertical face has no upper side,
// so the surface that it is joined to decides. Patches joined by edges (T-junctions too) form a component.
// The air side of a component is the side from which its surface is open to the sky.
// The upper side of an overhanging face is its back: the wall of an open box that leans inwards is seen from
// outside. Such a face takes the air side of its component too, and is an undercut where that side looks
// down.
#pragma once

#include <optional>
#include <vector>

#include "core/surface/surface.h"

namespace patchmill {

struct AirSides {
  // Index: patch. In its own parameters: 1 for the side of du x dv, -1 for the other side, 0 if unknown or if
  // nothing is vertical or overhangs.
  std::vector<int> of_patch;
  // Index: patch. The outer side of patches of closed bodies, written in the same way; 0 for other
  // patches, and if it is unknown. A body is closed if no edge of its component is open.
  std::vector<int> outer_of_patch;
  // Index: piece of the surface. True if it overhangs (FaceSides::overhangs): its air side is known and looks
  // down at some place. The piece is a wall, within 6 degrees of vertical, or its back is open to the sky
  // there. Up to 81 places of a wall are looked at, nine of other pieces.
  std::vector<char> overhangs;
  // Patches with vertical faces whose air side is unknown, in ascending order. The reason is one of three:
  // nothing that is open to the sky is joined to them; both sides of the joined surface are open to the sky;
  // their component is one-sided.
  std::vector<PatchId> undecided;
};

// A wall that leans by more than 0.1 degrees, as drafted walls do, is not vertical, however low its pieces
// are.
inline constexpr double kMostUprightSlope = 0.002;

// Returns FaceSides::upright, the largest |e_z| with which a place of the piece counts as a vertical face. It
// is kUprightFace. On a piece that leans by at most 5 um over its height, and nowhere by more than
// kMostUprightSlope, it is so much that all of the piece counts as vertical. Cost: 25 normals.
double UprightOf(const Piece& piece);

// `surface` must have its pieces (with `upright`), leaves and trees. Up to 2,000 places of a component tell
// how much of its area, as seen from above, is open to the sky, and from which side. A side that has nine
// tenths of the open area is the air side of the component. If neither side has so much, a vertical patch
// takes the side on which all its neighbours that are open to the sky agree. If vertical patches are still
// undecided, edges that run along each other in part, or with a small gap, join patches too
// (FindEdgeContacts). Deterministic. Cost: 9 to 90 normals per piece, and some microseconds per place for
// components with vertical faces or with places that look down. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<AirSides> FindAirSides(const Surface& surface, const RunContext& run);

// Orientation of the piece's parameters relative to those of its patch: 1 or -1.
int OrientationOf(const Piece& piece);

// The unit normal along S_u x S_v of the piece's patch, at a place of the piece; nothing where UnitNormal has
// none. On faces of closed bodies in CAD files it points out of the body.
std::optional<Vec3> NormalOfPatch(const Piece& piece, const SurfaceJet& jet);

// Writes the air side and the outer side of each piece, in the piece's own parameters, and whether the piece
// overhangs.
void SetAirSides(const AirSides& sides, std::vector<Piece>& pieces);

// Writes the air side of the pieces of one patch: 1 for the side of du x dv in its own parameters, -1 for the
// other.
void SetAirSide(PatchId patch, int side, std::vector<Piece>& pieces);

}  // namespace patchmill
