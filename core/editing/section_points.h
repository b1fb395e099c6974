// The user's control points of a G2-Gregory patch [editing, section 3]: Q0 on an edge, Q1 and Q2 beyond it,
// the Bezier points at one end of a quintic that follows the section across the middle of the patch to second
// order.
#pragma once

#include "core/base/vec.h"
#include "core/patch/patch.h"

namespace patchmill {

// Place and derivatives of the surface across the middle of an edge, into the patch.
struct MiddleCross {
  Vec3 p = Vec3::Zero(), first = Vec3::Zero(), second = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  // unit, S_u x S_v
};

// `side`: 0 v=0, 1 u=1, 2 v=1, 3 u=0. A quad, regular there.
MiddleCross AcrossMiddle(const PatchShape& quad, int side);

struct SectionPoints {
  Vec3 q0 = Vec3::Zero(), q1 = Vec3::Zero(), q2 = Vec3::Zero();
};
SectionPoints SectionPointsOf(const MiddleCross& cross);
// The other way: T and C of [editing (4)]. The normal is left out.
MiddleCross CrossOf(const SectionPoints& points);

// Curvature vector of the section [editing (5)], 1/mm.
Vec3 SectionCurvature(const Vec3& first, const Vec3& second);

// The second derivative that gives the section the curvature `wanted` (1/mm) in the direction it bends now,
// or towards -normal for a negative one; towards `normal` when it does not bend (its curvature below 1e-12 of
// 1/|first|). Keeps the angle between first and second derivative.
Vec3 SecondForCurvature(const MiddleCross& cross, double wanted);

}  // namespace patchmill
