// How each region is cut, and the parts of the surface that are cut alike.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/limits/surface_mask.h"
#include "cam/path/reach/forced_steps.h"
#include "cam/plan/job.h"

namespace patchmill {

// What holds where nothing overrides it.
RegionChoice ChoiceOf(const Operation& op);
OpenChoice OpenOf(const Operation& op);

// What its passes are forced upon.
ForcedSteps ForcedOf(const RegionChoice& choice);

// Components of a region whose circles are worth a comparison in time. `all`: with these, all lines of the
// region are circles.
struct CircularTrial {
  std::vector<CircularComponent> more;
  bool all = false;
};

// The regions of a job and how each is cut; the vectors by id.
struct ChosenRegions {
  RegionMap map;
  RegionChoices chosen;
  std::vector<CircularTrial> trials;  // circles to be tried where the angle is open
  std::vector<RegionFigures> figures;
};

// One for each region of the map, by id. FAILED_PRECONDITION when the overrides were made for another map;
// INVALID_ARGUMENT, with the field, for a region that is not there, a point that is on none, a region named
// twice, an unreachable one that is not to be skipped, one too small to have a cell of the map.
absl::StatusOr<RegionChoices> ChooseRegions(const Surface& surface, const RegionMap& map, const Operation& op,
                                            const Vec3& program_zero);

// Cells beside a region that are cut with it, along circles.
inline constexpr int kCellsBesideCircles = 4;

// Whether one set of contours cuts both: the choices are the same but for the circles, and for the direction
// of straight lines if one of them has none.
bool CutTogether(const RegionChoice& a, const RegionChoice& b);

// A part of the surface that is cut in one way.
struct PlanPart {
  RegionChoice choice;
  std::shared_ptr<const SurfaceMask> where;  // null: all of it

  // An area of the part whose lines are circles.
  struct Round {
    CircularLines around;
    std::shared_ptr<const SurfaceMask> where;
  };
  std::vector<Round> round;
  std::shared_ptr<const SurfaceMask> straight;  // what the other lines cover; null: all of it
};

// Parts of equal choices, in cells of the map: those of regions with straight lines in the order of their
// first regions; regions all of whose lines are circles go with the first part that is the same but for the
// direction of lines, or make parts after these. Skipped regions are in no part. Unreachable places go with
// the nearest reachable place of their piece (cell by cell), so that no pass runs around what lies within a
// skipped region. There is at least one part, which may be empty.
std::vector<PlanPart> PartsOf(const RegionMap& map, const std::vector<RegionChoice>& choices);

// The cells of all parts together: what links may touch. Null when no region is skipped: everywhere.
std::shared_ptr<const SurfaceMask> CutCells(const RegionMap& map, const std::vector<RegionChoice>& choices,
                                            const std::vector<PlanPart>& parts);

}  // namespace patchmill
