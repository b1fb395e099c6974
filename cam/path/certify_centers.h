// The certificate for paths whose heights are given.
#pragma once

#include "cam/location/locator.h"
#include "cam/toolpath/cutter_path.h"

namespace patchmill {

// Every centre is proven free to `gap` mm (Locator::CertifiedFree, with `gap` and the 1e-9 mm to which points
// of contours are known). One that is not is raised to its certified height, its contacts forgotten. Cost of
// some microseconds a point.
void CertifyCenters(const Locator& locator, double gap, CutterPath& path);

}  // namespace patchmill
