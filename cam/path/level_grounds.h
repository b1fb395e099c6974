// Which ground shares the heights of its contours: what hangs together does, and no more.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cam/path/contour_samples.h"
#include "cam/path/point_cells.h"
#include "cam/toolpath/cutter_path.h"

namespace patchmill {

// Two samples next to each other on a piece, or whose contacts or centres lie within three spacings of each
// other (as far as neighbours are apart on long pieces), are of one ground, and all that are joined so: a
// wall with the ones around its corners, the two walls of a slot as wide as the ball. Each ground may have
// levels of its own, for no contour runs from one to another. Grounds lower than two flat steps, scraps
// beside others mostly, go with the largest, and so do all but the 256 largest. Largest first; no samples, no
// grounds.
class LevelGrounds {
 public:
  // `flat`, mm: the step over a plane. Cost O(n log n); CANCELLED or DEADLINE_EXCEEDED from `run`.
  static absl::StatusOr<LevelGrounds> Make(const ContourGround& ground, double radius, double flat,
                                           const RunContext& run);
  // All of it as one.
  explicit LevelGrounds(ContourGround all);

  std::size_t size() const { return grounds_.size(); }
  const ContourGround& operator[](std::size_t i) const { return grounds_[i]; }
  // Over whose ground most of this pass is, by the samples that are nearest to it: one of `family_of`, which
  // has one for each ground.
  std::size_t FamilyUnder(const CutterPath& pass, std::span<const std::size_t> family_of) const;

 private:
  LevelGrounds() = default;
  std::vector<ContourGround> grounds_;
  std::vector<std::size_t> of_sample_;  // as the cells know them
  PointCells centers_;
};

}  // namespace patchmill
