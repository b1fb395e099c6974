// What counts where a request leaves a field of its job unset.
#pragma once

#include <map>
#include <string>

namespace patchmill {

// Paths of fields in a request ("job.operations[0].detail") with their values as text. They are read
// from jobs that state no more than they have to, resolved as those of any caller are. Fields that are
// absent are 0, false or empty, or follow from other fields of the job, as the radius of leads does.
const std::map<std::string, std::string>& JobDefaults();

}  // namespace patchmill
