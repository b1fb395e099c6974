// Certifies the centres of a path whose heights are known.
#pragma once

#include "cam/location/locator.h"
#include "cam/toolpath/cutter_path.h"

namespace patchmill {

// Proves every centre free to `gap` mm. A centre that is not free is raised to its certified height, takes
// the contact there, and counts as a defect (Locator::Correction). Costs some microseconds a point.
void CertifyCenters(const Locator& locator, double gap, CutterPath& path);

}  // namespace patchmill
