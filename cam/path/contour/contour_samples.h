// The ground that contours must cover, as sample points with the level spacing each of them needs.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/zlevel/level_trace.h"

namespace patchmill {

struct ContourSample {
  Vec3 center = Vec3::Zero();   // ball centre over the sample
  double up = 0.0, down = 0.0;  // mm: it stands for the ground from center.z() - down to center.z() + up
  double step = 0.0;            // mm, dz = CenterStep(across the feed) sin(slope)
  double width = 0.0;           // mm of every level through it that it stands for
  Vec3 contact = Vec3::Zero();  // on the surface
};

// Where a steep face ends downward: the lowest centre that still touches it and is free.
struct LowerEnd {
  Vec3 center = Vec3::Zero();
  double length = 0.0;  // mm of border it stands for
};

struct ContourArea {
  std::vector<ContourSample> samples;
  std::vector<LowerEnd> lower_ends;
  double spacing = 0.0;  // mm between samples, where pieces are not too long or uneven for it
  // Samples next to each other on one piece, and the farthest that contacts of two such are apart, mm.
  std::vector<std::pair<std::size_t, std::size_t>> neighbors;
  double widest = 0.0;
};

// A grid on every piece; only points whose slope lies in the window and whose ball is free (not below the
// floor) count, of upright ground either side, or both. Lower ends are solved on the grid's edges, to 1e-7 mm
// where enough of them gather at one height to matter. Deterministic, parallel over pieces.
absl::StatusOr<ContourArea> SampleContourArea(const LevelContext& context, const ContourParams& params,
                                              const RunContext& run);

}  // namespace patchmill
