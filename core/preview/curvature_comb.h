// Curvature combs of edges and of the middle lines of patches.
#pragma once

#include <vector>

#include "core/curve/bezier_chain.h"
#include "core/patch/patch.h"

namespace patchmill {

struct CombTooth {
  Vec3 place = Vec3::Zero();
  // Curvature vector, 1/mm: towards the centre of curvature, as long as 1 / radius. Zero where the curve has
  // no direction.
  Vec3 curvature = Vec3::Zero();
};

// The curvature vector of a curve with these derivatives: the part of `second` square to `first`, over
// |first|^2.
Vec3 CurvatureVector(const Vec3& first, const Vec3& second);

// `cells` (>= 1) equal parameter steps, cells + 1 teeth.
std::vector<CombTooth> CombOf(const BezierChain& curve, int cells);
// Along the line v = `at`, or, if not `along_u`, the line u = `at` of a quad.
std::vector<CombTooth> CombAlong(const PatchShape& quad, bool along_u, double at, int cells);

}  // namespace patchmill
