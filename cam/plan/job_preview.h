// The picture of a job (`--preview`) and of a region map (`patchmill regions -o x.svg`).
#pragma once

#include <string>

#include "cam/plan/job.h"
#include "core/surface/surface.h"

namespace patchmill {

std::string DrawJob(const Surface& surface, const JobResult& result, const std::string& title);
std::string DrawRegions(const Surface& surface, const RegionMap& regions, const std::string& title);

const char* Name(Outcome outcome);  // "COMPLETE", ...

}  // namespace patchmill
