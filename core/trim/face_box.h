// The box that stands in the place of a face which is not trimmed.
#pragma once

#include <array>

#include "core/base/vec.h"
#include "core/brep/brep_model.h"
#include "core/patch/patch.h"

namespace patchmill {

// An axis-parallel box that holds the face: its edges, and its surface over the parameters that its loops run
// over, with 2 % more on each side. A sphere's or a cylinder's box is that of the part of it that the face
// has, and at most some percent larger. Empty if nothing is known of where the face lies.
Box3 BoxOfFace(const BrepModel& part, const BrepFace& face);

// The six sides of a box that is not empty and has no side of length 0. u x v points out of it.
std::array<BezierPatch, 6> SidesOf(const Box3& box);

}  // namespace patchmill
