// Searches the whole surface for the largest value of some quantity. The result does not depend on the number
// of threads.
#pragma once

#include <functional>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/verify/surface_cells.h"
#include "core/base/run_context.h"

namespace patchmill {

// A value at a surface point, and the move that causes it.
struct Extreme {
  double value = 0.0;  // mm, >= 0; 0 if nothing was found
  Vec3 point = Vec3::Zero();
  PieceId piece;
  int move = -1;
};

struct Extremes {
  Extreme worst;
  // One for each root cell with a value above the limit, largest first. It is the largest value of the cell,
  // or the first one found if it is certainly not the largest of all cells.
  std::vector<Extreme> violations;
};

// Thresholds of branch and bound. Cells that cannot exceed Drop() are abandoned.
struct Threshold {
  double known = 0.0;  // largest value found before this root was searched
  double limit = kInfinity;
  double certainty = 0.0;

  // A value above this is the largest so far or the first violation in this root. `here` is the largest value
  // found in this root.
  double Floor(double here) const {
    return here > limit ? std::max(known, here) : std::max(here, std::min(known, limit));
  }
  double Drop(double here) const { return Floor(here) + certainty; }
};

// search(root, threshold) returns the largest value in the root cell. Each chunk of roots makes a search of
// its own.
using RootSearch = std::function<Extreme(const CellRect& root, const Threshold& threshold)>;
using MakeRootSearch = std::function<RootSearch()>;

// What a search knows at its start, and what it is to find.
struct SearchStart {
  Extreme known;             // a value that was found before
  double limit = kInfinity;  // mm; a larger value is a violation
  double certainty = 0.0;    // mm; the largest value may exceed the one found by this
};

// Searches every eighth root first, then the others with the value found by these. Within a chunk each root
// starts with the values of the roots before it. `stage` names the progress.
absl::StatusOr<Extremes> SearchRoots(const std::vector<CellRect>& roots, const SearchStart& start,
                                     const MakeRootSearch& make, const RunContext& run, const char* stage);

}  // namespace patchmill
