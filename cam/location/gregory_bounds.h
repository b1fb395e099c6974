// Bounds of the derivatives of a Gregory quad over a rectangle. They come from its own form, a bicubic and
// four blended terms (core/patch/gregory_patch.cc). The rational net bounds points well but derivatives
// badly: its weights fall to zero at the corners, although the surface's second derivatives stay bounded
// there.
#pragma once

#include <array>

#include "cam/location/leaf_model.h"

namespace patchmill::internal {

struct Interval {
  double lo = 0.0, hi = 0.0;
  double middle() const { return 0.5 * (lo + hi); }
  double spread() const { return 0.5 * (hi - lo); }
};

// One blended term phi(u,v) D: the ranges of its derivatives with respect to the local parameters of the
// rectangle.
struct BlendedTerm {
  Vec3 d;
  Interval u, v, uu, uv, vv;
};

// The four terms over `rect`. The bounds hold on all of it, corners included.
std::array<BlendedTerm, 4> BoundBlend(const GregoryPatch& patch, const Rect& rect);

// The bicubic part as a net of 16 homogeneous points (w = 1), v fastest.
std::array<Vec4, 16> BicubicPart(const GregoryPatch& patch);

}  // namespace patchmill::internal
