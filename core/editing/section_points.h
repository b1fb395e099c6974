// The control points of a G2-Gregory patch that the user may move [editing, section 3]. Q0 lies on an edge,
// Q1 and Q2 beyond it. They are the Bezier points at one end of a quintic. The quintic follows the section
// across the middle of the patch to second order.
#pragma once

#include "core/base/vec.h"
#include "core/patch/patch.h"

namespace patchmill {

// Point and derivatives of the surface across the middle of an edge, into the patch.
struct MiddleCross {
  Vec3 p = Vec3::Zero(), first = Vec3::Zero(), second = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  // unit, S_u x S_v
};

// `side`: 0 is v=0, 1 is u=1, 2 is v=1, 3 is u=0. `quad` must be a quad that is regular there.
MiddleCross AcrossMiddle(const PatchShape& quad, int side);

struct SectionPoints {
  Vec3 q0 = Vec3::Zero(), q1 = Vec3::Zero(), q2 = Vec3::Zero();
};
SectionPoints SectionPointsOf(const MiddleCross& cross);
// The inverse of SectionPointsOf: `first` is T and `second` is C of [editing (4)]. `normal` is left zero.
MiddleCross CrossOf(const SectionPoints& points);

// Curvature vector of the section [editing (5)], 1/mm.
Vec3 SectionCurvature(const Vec3& first, const Vec3& second);

// The second derivative that gives the section the curvature `wanted` (1/mm). The section keeps its line of
// bending: a positive curvature bends towards the side of `normal`, a negative one away from it. If the
// section does not bend (curvature below 1e-12 / |first|), it bends along `normal`. The angle between the
// first and the second derivative stays, up to its sign.
Vec3 SecondForCurvature(const MiddleCross& cross, double wanted);

}  // namespace patchmill
