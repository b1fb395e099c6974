// What is asked for of single regions, made definite: how each is cut, and which parts of the surface that
// makes.
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

// What its passes are forced upon.
ForcedSteps ForcedOf(const RegionChoice& choice);

// More components of a region that circles may suit; `all`: its lines are all round then.
struct CircularTrial {
  std::vector<CircularComponent> more;
  bool all = false;
};

struct ChosenRegions {
  RegionMap map;
  std::vector<RegionChoice> choices;   // by id
  std::vector<CircularTrial> circles;  // by id: to be tried where the angle is open
};

// One for each region of the map, by id. FAILED_PRECONDITION when the overrides were made for another map;
// INVALID_ARGUMENT, with the field, for a region that is not there, a point that is on none, a region named
// twice, an unreachable one that is not to be skipped, one too small to have a cell of the map.
absl::StatusOr<std::vector<RegionChoice>> ChooseRegions(const Surface& surface, const RegionMap& map,
                                                        const Operation& op, const Vec3& program_zero);

// Cells beside a region that are cut with it, along circles.
inline constexpr int kCellsBesideCircles = 4;

// They are the same but for which lines are round, and for the direction of the others if one has none: one
// set of contours cuts both.
bool CutTogether(const RegionChoice& a, const RegionChoice& b);

// A part of the surface that is cut in one way.
struct PlanPart {
  RegionChoice choice;
  std::shared_ptr<const SurfaceMask> where;  // null: all of it

  // Ground of it whose lines are circles.
  struct Round {
    CircularLines around;
    std::shared_ptr<const SurfaceMask> where;
  };
  std::vector<Round> round;
  std::shared_ptr<const SurfaceMask> straight;  // what the other lines cover; null: all of it
};

// Parts of equal choices, in cells of the map: those of regions with straight lines in the order of their
// first regions; regions whose lines are all round go with the first part that is the same but for the
// direction of lines, or make parts after these. Skipped regions are in none. Unreachable ground goes with
// the reachable ground nearest to it in its piece (cell by cell), so that no pass runs around what lies
// within a skipped region. At least one part, which may be empty.
std::vector<PlanPart> PartsOf(const RegionMap& map, const std::vector<RegionChoice>& choices);

// The cells of all parts together: what links may touch. Null when no region is skipped: everywhere.
std::shared_ptr<const SurfaceMask> CutCells(const RegionMap& map, const std::vector<RegionChoice>& choices,
                                            const std::vector<PlanPart>& parts);

}  // namespace patchmill
