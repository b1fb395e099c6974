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
  // One value above the limit for each root cell that has such values, largest first. It is the largest value
  // of the root cell; or the first one found above the limit, if a larger value is known in another cell.
  std::vector<Extreme> violations;
};

// Thresholds of branch and bound. A cell is abandoned if its upper bound is no more than Drop().
struct Threshold {
  double known = 0.0;        // mm, largest value found before this root was searched
  double limit = kInfinity;  // mm, as SearchStart::limit
  double certainty = 0.0;    // mm, as SearchStart::certainty

  // Returns the value above which a new value matters: as the largest so far, or as a violation in this root.
  // `here` is the largest value found in this root.
  double Floor(double here) const {
    return here > limit ? std::max(known, here) : std::max(here, std::min(known, limit));
  }
  double Drop(double here) const { return Floor(here) + certainty; }
};

// search(root, threshold) returns the largest value that it found in the root cell. Roots are searched in
// chunks, in parallel; each chunk makes a search object of its own.
using RootSearch = std::function<Extreme(const CellRect& root, const Threshold& threshold)>;
using MakeRootSearch = std::function<RootSearch()>;

// What a search knows at its start, and what it is to find.
struct SearchStart {
  Extreme known;             // a value that was found before
  double limit = kInfinity;  // mm; a larger value is a violation
  double certainty = 0.0;    // mm: the true maximum may exceed the value found by this much
};

// Searches every eighth root first. The largest value found there is the start for the other roots, so that
// most of their cells are abandoned early. Within a chunk each root starts with the largest value of the
// roots before it. `stage` is the name under which progress is reported.
absl::StatusOr<Extremes> SearchRoots(const std::vector<CellRect>& roots, const SearchStart& start,
                                     const MakeRootSearch& make, const RunContext& run, const char* stage);

}  // namespace patchmill
