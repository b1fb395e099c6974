// Groups of levels: connected parts of the steep area share the heights of their contours, others do not.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "cam/path/contour/contour_samples.h"
#include "cam/path/contour/level_heights.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/typed_id.h"
#include "core/spatial/point_cells.h"

namespace patchmill {

using LevelGroupId = TypedId<struct LevelGroupTag>;    // a group of a LevelGroups
using LevelFamilyId = TypedId<struct LevelFamilyTag>;  // groups that have the same levels

// Returns the highest of `heights` at or below `height`, or nothing if the gap is so long (kMostGap) that no
// surface lies in it. `flat` is the step over a plane, mm.
std::optional<double> LevelBelow(std::span<const double> heights, double height, double flat);

// Two samples belong to one group if they lie next to each other on a piece, or if their contacts or centres
// lie within three spacings of each other (or as far as neighbours are apart on long pieces). This joins a
// wall with the ones around its corners, and the two walls of a slot as wide as the ball. Each group may have
// levels of its own, since no contour runs from one to another. Where a group parts upwards (LevelBranch), a
// branch becomes a group if contours go around it alone above its base level and levels of its own are
// shorter in all. It stands on a level of the group from which it branches off. Areas lower than two flat
// step-overs, mostly scraps, join the largest group, and so do all but the 256 largest. The largest group
// comes first, branches come after the groups they stand on. Without samples there are no groups.
class LevelGroups {
 public:
  // Returns the contours of a height. Null: no group is parted.
  using ContoursAt = std::function<std::vector<CutterPath>(double z)>;
  // Cost O(n log n), at most two dozen contours, and two LevelHeights for each of at most a dozen branches.
  // Errors: CANCELLED or DEADLINE_EXCEEDED from `run`.
  static absl::StatusOr<LevelGroups> Make(const ContourArea& contour_area, const HeightParams& params,
                                          const ContoursAt& contours, const RunContext& run);
  // Makes one group of all samples.
  explicit LevelGroups(ContourArea all);

  std::size_t size() const { return groups_.size(); }
  const ContourArea& operator[](LevelGroupId id) const { return groups_[id.index()]; }
  // The level on which a branch stands: the highest one of that group at or below a height.
  struct BaseLevel {
    LevelGroupId group;
    double below = 0.0;  // mm, of the centre
  };
  const std::optional<BaseLevel>& base_level(LevelGroupId id) const { return base_levels_[id.index()]; }
  // Returns the family over whose area most of this pass lies, by the samples that are nearest to it.
  // family_of[group] is the family of that group.
  LevelFamilyId FamilyUnder(const CutterPath& pass, std::span<const LevelFamilyId> family_of) const;

 private:
  LevelGroups() = default;
  class Builder;
  std::vector<ContourArea> groups_;
  std::vector<std::optional<BaseLevel>> base_levels_;  // of each group
  std::vector<LevelGroupId> of_sample_;                // group of each sample, in the order of `centers_`
  PointCells centers_;
};

}  // namespace patchmill
