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

// Returns the highest of `heights` at or below `height` (mm). nullopt if there is none within kMostGap flat
// step-overs, since no surface of the group lies in so long a gap. `flat` is the flat step-over, mm.
std::optional<double> LevelBelow(std::span<const double> heights, double height, double flat);

// Divides the samples of the steep area into groups. Each group may have levels of its own, since no
// waterline runs from one group to another.
//
// Two samples belong to one group if they are neighbours on a piece, or if their contacts or their centres
// lie within three spacings of each other (or within the largest distance of neighbours, if that is more). So
// a wall is in one group with the walls around its corners, and so are the two walls of a slot as wide as the
// ball. Where a group forks upwards, a branch (LevelBranch) becomes a group of its own if two things hold:
// waterlines above its base level go around the branch alone, and levels of its own make the total length
// smaller. The base level is a level of the group from which it branches off. Areas lower than two flat
// step-overs join the largest group; so do all but the 256 largest groups. The largest group comes first, and
// branches come after the groups on which they stand. Without samples there are no groups.
class LevelGroups {
 public:
  // Returns the waterlines at a height z (mm, of the centre). Null: branches stay in their groups.
  using ContoursAt = std::function<std::vector<CutterPath>(double z)>;
  // Cost: O(n log n) for n samples, at most 24 calls of `contours`, and two calls of LevelHeights for each of
  // at most 12 branches.
  // Errors: CANCELLED or DEADLINE_EXCEEDED from `run`.
  static absl::StatusOr<LevelGroups> Make(const ContourArea& contour_area, const HeightParams& params,
                                          const ContoursAt& contours, const RunContext& run);
  // Makes one group of all samples.
  explicit LevelGroups(ContourArea all);

  std::size_t size() const { return groups_.size(); }
  const ContourArea& operator[](LevelGroupId id) const { return groups_[id.index()]; }
  // The level on which a branch stands: the highest one of `group` at or below the height `below`.
  struct BaseLevel {
    LevelGroupId group;
    double below = 0.0;  // mm, height of the centre
  };
  const std::optional<BaseLevel>& base_level(LevelGroupId id) const { return base_levels_[id.index()]; }
  // Returns the family to which most of the pass belongs: each of its points belongs to the group of the
  // nearest sample. family_of[group] is the family of a group.
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
