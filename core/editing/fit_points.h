// Moves a network until its surface passes within a band of measured points [editing, section 10].
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/editing/goals.h"
#include "core/joining/curve_network.h"

namespace patchmill {

struct PointFit {
  std::vector<Vec3> points;
  double band = 0.0;    // >= 0: a point no farther than this from the surface asks for nothing
  bool normals = true;  // given normals of vertices may turn
  bool middles = true;  // the middles of faces may rise or sink, by bulges
};

inline constexpr std::size_t kMaxFitPoints = 2000;
inline constexpr std::size_t kMaxFitUnknowns = 400;

// The quads nearest to the points and their vertices move. Each vertex goes along its normal. Steps of
// Gauss-Newton, each the smallest one, with differences of the joined surface, until no point is outside
// the band or nothing gets better. What was reached comes back in the order of the points.
// INVALID_ARGUMENT "<at>.points ..." for what cannot be. Also the errors of `run`, which is polled before
// each join and for each point. Cost: a join for each unknown and step.
absl::StatusOr<std::vector<ReachedGoal>> FitPoints(const PointFit& fit, const std::string& at,
                                                   const RunContext& run, CurveNetwork& network);

}  // namespace patchmill
