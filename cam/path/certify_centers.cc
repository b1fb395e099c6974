#include "cam/path/certify_centers.h"

#include <algorithm>

namespace patchmill {
namespace {

constexpr double kHeightSlack = 1e-9;  // mm, as of LevelOracle's points

}  // namespace

void CertifyCenters(const Locator& locator, double gap, CutterPath& path) {
  for (CutterPoint& p : path.points) {
    const auto lift = locator.CertifiedFree(p.center + Vec3(0, 0, kHeightSlack), gap);
    if (lift && *lift <= gap) continue;
    const auto h = locator.CertifiedHeight(Plan(p.center), gap, p.contact ? &*p.contact : nullptr);
    if (!h || h->z + h->gap <= p.center.z()) continue;
    p.center.z() = h->z + h->gap;
    p.contact = h->contact;
    p.other_contact.reset();
  }
}

}  // namespace patchmill
