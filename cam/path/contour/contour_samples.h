// The surface that contours must cover, as sample points with the level spacing that each of them needs.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/zlevel/level_trace.h"

namespace patchmill {

struct ContourSample {
  Vec3 center = Vec3::Zero();   // ball centre over the sample
  double up = 0.0, down = 0.0;  // mm: it stands for the surface from center.z() - down to center.z() + up
  double step = 0.0;            // mm, dz = CenterStep(across the feed) sin(slope)
  double width = 0.0;           // mm: length that it stands for of every level through it
  Vec3 contact = Vec3::Zero();  // on the surface
};

// A place where a steep face ends downward: the lowest centre that still touches the face and is free.
struct LowerEnd {
  Vec3 center = Vec3::Zero();
  double length = 0.0;  // mm: length of the face's end that it stands for
};

struct ContourArea {
  std::vector<ContourSample> samples;
  std::vector<LowerEnd> lower_ends;
  double spacing = 0.0;  // mm between samples, where pieces are not too long or uneven for it
  // Pairs of samples next to each other on one piece, and the largest distance (mm) of their contacts.
  std::vector<std::pair<std::size_t, std::size_t>> neighbors;
  double widest = 0.0;
};

// Samples a grid on every piece. A point counts only if its slope lies in the window and its ball is free
// (and not below the floor). On a vertical face either side counts, or both. Lower ends are solved on the
// grid's edges, to 1e-7 mm where enough gather at one height to matter. Deterministic, parallel over pieces.
absl::StatusOr<ContourArea> SampleContourArea(const LevelContext& context, const ContourParams& params,
                                              const RunContext& run);

}  // namespace patchmill
