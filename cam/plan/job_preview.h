// The picture of a job (`--preview`) and of a region map (`patchmill regions -o x.svg`).
#pragma once

#include <string>

#include "cam/plan/job.h"
#include "cam/plan/region_choices.h"
#include "cam/plan/resolve.h"
#include "core/surface/surface.h"

namespace patchmill {

// Places that are not selected, or whose region is skipped, are grey. Regions that are grey all over have no
// legend. Borders are drawn by kind. A region map has the nodes of borders, too, and two more views: by
// slope, whose colours change at `steep_angle` (rad), and by the curvature of contours.
std::string DrawJob(const Surface& surface, const JobResult& result, const Resolved& resolved,
                    const std::string& title);
std::string DrawRegions(const Surface& surface, const ChosenRegions& regions, const Resolved& resolved,
                        double steep_angle, const std::string& title);

const char* Name(Outcome outcome);  // "COMPLETE", ...

}  // namespace patchmill
