// Settings of a job that change nothing.
#pragma once

#include "cam/plan/job.h"

namespace patchmill {

// A warning SETTING_WITHOUT_EFFECT for each, with its field: settings of lines where contours cut the whole
// surface (an angle, one way, the quickest angle, bends, circles, borders), and settings of contours where
// only lines cut (spirals, a direction other than climb). Only findings that hold for every part.
Diagnostics UnusedSettings(const Operation& op);

// The same of spirals that no contour of the part could be wound into.
Diagnostics UnusedSpirals(const Operation& op, const std::vector<CutterPath>& passes);

}  // namespace patchmill
