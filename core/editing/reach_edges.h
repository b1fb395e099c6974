// Leads edges through points [editing, section 7].
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/editing/goals.h"
#include "core/joining/join_network.h"

namespace patchmill {

// The path of an edit in messages, and what its long steps poll.
struct EditPlace {
  std::string at;
  const RunContext& run;
};

// Changes edges of `network`, from which `joined` was made. An edge of a line moves vertices of the line.
// Another cubic edge gets new end tangents in its tangent planes. If these do not suffice, or would change
// by more than half of the chord, and the faces beside take it, the edge gets the term t^2 (1-t)^2 d of
// [curves (10)]. Each is the least squares of all goals of the edge with the smallest sum of squares of
// the changes. INVALID_ARGUMENT "<at>.edges[2] ..." for a goal that cannot be. Also the errors of `run`.
absl::StatusOr<std::vector<ReachedGoal>> ReachEdges(const std::vector<EdgeGoal>& goals,
                                                    const JoinedNetwork& joined, CurveNetwork& network,
                                                    const EditPlace& place);

}  // namespace patchmill
