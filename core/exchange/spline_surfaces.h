// The patches of a model as B-spline surfaces, which other CAD systems read.
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/diagnostic.h"
#include "core/base/run_context.h"
#include "core/network/patch_model.h"

namespace patchmill {

struct SplineSurface {
  std::string name;      // of the patch or its face; ASCII, at most kMaxSplineName bytes
  BsplinePatch surface;  // clamped at both ends of both knot vectors, weights > 0, not closed
};

inline constexpr std::size_t kMaxSplineName = 60;
inline constexpr std::size_t kMaxSplineSurfaces = 500'000;
inline constexpr double kSplineFit = 1e-5;  // mm

struct SplineSurfaces {
  std::vector<SplineSurface> surfaces;  // in the order of the patches
  // EXPORT_FITTED: how many patches were fitted, and how well; a warning where kSplineFit is not kept.
  Diagnostics findings;
};

// Bezier, B-spline, Hosaka and triangular Bezier patches exactly (a triangle as three quads around its
// centroid [shapes, section 8]; a closed surface, or one with knots beyond its ends, as its knot rectangles).
// Other kinds are polynomials of degree 7 on squares that are quartered until they lie within kSplineFit, as
// sampled. Borders of degree 7 or less stay exact. RESOURCE_EXHAUSTED for more than kMaxSplineSurfaces;
// CANCELLED and DEADLINE_EXCEEDED from `run`. Cost about 20 us per square.
absl::StatusOr<SplineSurfaces> SplineSurfacesOf(const PatchModel& model, const RunContext& run);

}  // namespace patchmill
