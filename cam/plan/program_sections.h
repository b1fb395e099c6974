// The sections of a program: passes of one kind in one region, which are cut one after the other.
#pragma once

#include <vector>

#include "cam/link/link_paths.h"
#include "cam/post/program_writer.h"
#include "cam/region/map/region_map.h"

namespace patchmill {

// Returns the sections of `posted`, in the order of its moves. `posted` has the moves of `motion`, in any
// number. A section begins where the region or the kind of the passes changes, after the tool has been
// retracted if it is retracted there. Sections with a retract are restart points, and so are retracts inside
// a section after five minutes of motion at feed. The comment of a section states region, slope, kind and
// number of its passes and the range of the tip; that of a restart point inside it says that it goes on. Cost
// O(moves).
std::vector<ProgramSection> SectionsOf(const Toolpath& posted, const LinkResult& motion, const RegionMap& map,
                                       const Vec3& program_zero);

}  // namespace patchmill
