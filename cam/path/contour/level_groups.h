// Which ground shares the heights of its contours: what hangs together does, and no more.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "cam/path/contour/contour_samples.h"
#include "cam/path/contour/level_heights.h"
#include "cam/toolpath/cutter_path.h"
#include "core/spatial/point_cells.h"

namespace patchmill {

// The highest of some levels at or below a height, if any ground lies in between (kMostGap). `flat`, mm: the
// step over a plane.
std::optional<double> LevelBelow(std::span<const double> heights, double height, double flat);

// Two samples next to each other on a piece, or whose contacts or centres lie within three spacings of each
// other (as far as neighbours are apart on long pieces), are of one ground, and all that are joined so: a
// wall with the ones around its corners, the two walls of a slot as wide as the ball. Each ground may have
// levels of its own, for no contour runs from one to another. Where such a ground parts upwards
// (LevelBranch), a branch is a ground apart if contours go around it alone above its foot and levels of its
// own are shorter in all; it stands on a level of the one that it branches off from. Grounds lower than two
// flat steps, scraps beside others mostly, go with the largest, and so do all but the 256 largest. Largest
// first, branches after what they stand on; no samples, no grounds.
class LevelGroups {
 public:
  // Contours of a height; null: no ground is parted.
  using ContoursAt = std::function<std::vector<CutterPath>(double z)>;
  // Cost O(n log n), and two LevelHeights for a branch, of the dozen largest, and two dozen contours at most;
  // CANCELLED or DEADLINE_EXCEEDED from `run`.
  static absl::StatusOr<LevelGroups> Make(const ContourArea& contour_area, const HeightParams& params,
                                          const ContoursAt& contours, const RunContext& run);
  // All of it as one.
  explicit LevelGroups(ContourArea all);

  std::size_t size() const { return groups_.size(); }
  const ContourArea& operator[](std::size_t i) const { return groups_[i]; }
  // What a branch stands on: the level of that ground next to a height, at or below it.
  struct BaseLevel {
    std::size_t group = 0;
    double below = 0.0;  // mm, of the centre
  };
  const std::optional<BaseLevel>& base_level(std::size_t i) const { return base_levels_[i]; }
  // Over whose ground most of this pass is, by the samples that are nearest to it: one of `family_of`, which
  // has one for each ground.
  std::size_t FamilyUnder(const CutterPath& pass, std::span<const std::size_t> family_of) const;

 private:
  LevelGroups() = default;
  class Builder;
  std::vector<ContourArea> groups_;
  std::vector<std::optional<BaseLevel>> base_levels_;  // of each ground
  std::vector<std::size_t> of_sample_;                 // as the cells know them
  PointCells centers_;
};

}  // namespace patchmill
