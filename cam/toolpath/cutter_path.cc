#include "cam/toolpath/cutter_path.h"

namespace patchmill {

double Length(const CutterPath& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    length += (path.points[i].center - path.points[i - 1].center).norm();
  }
  if (path.closed && path.points.size() > 1) {
    length += (path.points.front().center - path.points.back().center).norm();
  }
  return length;
}

}  // namespace patchmill
