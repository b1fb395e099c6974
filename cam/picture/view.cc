#include "cam/picture/view.h"

#include <algorithm>

namespace patchmill {

View FitView(View view, const Box3& box, const Vec2& corner, double width, double height) {
  Vec2 low(kInfinity, kInfinity), high(-kInfinity, -kInfinity);
  for (int k = 0; k < 8; ++k) {
    const Vec3 p((k & 1) ? box.max.x() : box.min.x(), (k & 2) ? box.max.y() : box.min.y(),
                 (k & 4) ? box.max.z() : box.min.z());
    const Vec2 q(view.right.dot(p), view.up.dot(p));
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  const Vec2 size = (high - low).cwiseMax(1e-9);
  view.scale = std::min(width / size.x(), height / size.y());
  view.origin.x() = corner.x() + 0.5 * width - view.scale * 0.5 * (low.x() + high.x());
  view.origin.y() = corner.y() + 0.5 * height + view.scale * 0.5 * (low.y() + high.y());
  return view;
}

}  // namespace patchmill
