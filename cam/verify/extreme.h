// Searching the whole surface for the largest value of something, in two rounds whose result does not depend
// on the number of threads.
#pragma once

#include <functional>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/verify/surface_cells.h"
#include "core/base/run_context.h"

namespace patchmill {

// A value attained at a surface point, and the move that is to blame.
struct Extreme {
  double value = 0.0;  // mm, >= 0; 0: nothing found
  Vec3 point = Vec3::Zero();
  PieceId piece;
  int move = -1;
};

struct Extremes {
  Extreme worst;
  // One of each root cell with something above the limit, largest first: its worst, or the first one found
  // when it is surely not the worst of all.
  std::vector<Extreme> violations;
};

// What branch and bound compares with: cells that cannot exceed `drop` are left.
struct Threshold {
  double known = 0.0;  // largest value attained before this root was opened
  double limit = kInfinity;
  double certainty = 0.0;

  // A value above this improves the answer, or is the root's first violation. `here`: the largest of this
  // root.
  double Floor(double here) const {
    return here > limit ? std::max(known, here) : std::max(here, std::min(known, limit));
  }
  double Drop(double here) const { return Floor(here) + certainty; }
};

// One searcher per chunk of roots: search(root, threshold) -> its largest value.
using RootSearch = std::function<Extreme(const CellRect& root, const Threshold& threshold)>;
using MakeRootSearch = std::function<RootSearch()>;

// Every eighth root first, then the others knowing what these have found; within a chunk each root knows what
// the ones before it have found. `known` is attained already.
absl::StatusOr<Extremes> SearchRoots(const std::vector<CellRect>& roots, const Extreme& known, double limit,
                                     double certainty, const MakeRootSearch& make, const RunContext& run,
                                     const char* stage);

}  // namespace patchmill
