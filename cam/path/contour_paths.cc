#include "cam/path/contour_paths.h"

#include "cam/path/level_trace.h"

namespace patchmill {

LevelContours TraceLevel(const Locator& locator, double z, const ContourParams& params,
                         const RunContext& run) {
  return TraceLevel(LevelContext(locator), z, params, run);
}

}  // namespace patchmill
