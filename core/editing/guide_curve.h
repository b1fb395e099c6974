// The guide curve of a row of faces [editing, section 5].
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/vec.h"
#include "core/joining/curvature_joint.h"

namespace patchmill {

// First derivatives of the surface into a face of the row, across the middles of its two edges.
struct GuideSpan {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
};

// Directions of an open guide at its ends, any length but 0. Where one is not given, the surface has it.
struct GuideDirections {
  std::optional<Vec3> start, end;
};

// Derivatives of the guide into a face of the row, from the middles of its two edges.
struct GuideSection {
  CrossEnd from, to;
};

// The cubic spline through the middles, one section for each face. It is closed if there are as many faces
// as middles. Its spans have the ratios of the surface's derivatives, so that the guide of a bicubic
// surface lies on it. INVALID_ARGUMENT if neighbouring middles coincide.
absl::StatusOr<std::vector<GuideSection>> GuideThrough(const std::vector<Vec3>& middles,
                                                       const std::vector<GuideSpan>& faces,
                                                       const GuideDirections& directions);

}  // namespace patchmill
