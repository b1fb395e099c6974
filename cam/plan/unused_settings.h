// Settings of a job that change nothing, so that nobody waits for them.
#pragma once

#include "cam/plan/job.h"

namespace patchmill {

// A warning SETTING_WITHOUT_EFFECT for each, with its field: what is said of lines where contours cut all
// that it is said of (an angle, one way, the quickest angle, bends, circles, borders), and of contours where
// only lines do (spirals, a direction other than climb). Only what holds whatever the part is.
Diagnostics UnusedSettings(const Operation& op);

// The same of spirals that no contour of the part could be wound into.
Diagnostics UnusedSpirals(const Operation& op, const std::vector<CutterPath>& passes);

}  // namespace patchmill
