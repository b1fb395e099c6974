#include "cam/path/chord/certify_centers.h"

namespace patchmill {

void CertifyCenters(const Locator& locator, double gap, CutterPath& path) {
  for (CutterPoint& p : path.points) {
    const auto raised = locator.Correction(p.center, gap, p.contact ? &*p.contact : nullptr);
    if (!raised) continue;
    p.center.z() = raised->z + raised->gap;
    p.contact = raised->contact;
    p.other_contact.reset();
  }
}

}  // namespace patchmill
