// The surface that waterlines must cover, as sample points with the z-step that each of them needs.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/zlevel/level_trace.h"

namespace patchmill {

struct ContourSample {
  Vec3 center = Vec3::Zero();  // of the ball that touches the surface at the sample
  // mm in z: the sample stands for the levels from center.z() - below to center.z() + above.
  double above = 0.0, below = 0.0;
  double step = 0.0;            // mm: the z-step that the scallop allows here [spacing (7)]
  double width = 0.0;           // mm: the length of each of these levels that the sample stands for
  Vec3 contact = Vec3::Zero();  // the sample, on the surface
};

// A place where a steep face ends downward: the lowest centre that still touches the face and is free.
struct LowerEnd {
  Vec3 center = Vec3::Zero();
  double length = 0.0;  // mm: length of the face's lower end that it stands for
};

struct ContourArea {
  std::vector<ContourSample> samples;
  std::vector<LowerEnd> lower_ends;
  double spacing =
      0.0;  // mm: intended distance of neighbouring samples; long or uneven pieces have larger ones
  // Pairs of samples next to each other on one piece, and the largest distance (mm) between the contacts of
  // such a pair.
  std::vector<std::pair<std::size_t, std::size_t>> neighbors;
  double widest = 0.0;
};

// Samples a grid on every piece. A grid point becomes a sample if its slope lies in the window and the ball
// that touches it is free and not below the floor. On a vertical face a free ball on either side makes a
// sample, so there may be two. Lower ends are found on the lines of the grid; they are exact to 1e-8 mm where
// two or more lie at one height, so that a level can lie there. Deterministic, parallel over pieces.
absl::StatusOr<ContourArea> SampleContourArea(const LevelContext& context, const ContourParams& params,
                                              const RunContext& run);

}  // namespace patchmill
