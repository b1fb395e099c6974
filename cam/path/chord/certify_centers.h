// The certificate for paths whose heights are given.
#pragma once

#include "cam/location/locator.h"
#include "cam/toolpath/cutter_path.h"

namespace patchmill {

// Every centre is proven free to `gap` mm. One that is not is raised to its certified height, with the
// contact there, and counts as a defect (Locator::Correction). Cost of some microseconds a point.
void CertifyCenters(const Locator& locator, double gap, CutterPath& path);

}  // namespace patchmill
