#include "cam/toolpath/cutter_path.h"

#include <algorithm>
#include <utility>

namespace patchmill {

double Length(std::span<const CutterPoint> open_path) {
  double length = 0.0;
  for (std::size_t i = 1; i < open_path.size(); ++i) {
    length += (open_path[i].center - open_path[i - 1].center).norm();
  }
  return length;
}

double Length(const CutterPath& path) {
  double length = Length(std::span<const CutterPoint>(path.points));
  if (path.closed && path.points.size() > 1) {
    length += (path.points.front().center - path.points.back().center).norm();
  }
  return length;
}

void RotateClosed(CutterPath& path, std::size_t start) {
  std::rotate(path.points.begin(), path.points.begin() + static_cast<std::ptrdiff_t>(start),
              path.points.end());
}

void Reverse(CutterPath& path) {
  std::reverse(path.points.begin(), path.points.end());
  for (CutterPoint& p : path.points) {
    if (p.other_contact) std::swap(p.contact, p.other_contact);
  }
}

std::vector<PathSegment> MovesOf(const std::vector<CutterPath>& paths) {
  std::vector<PathSegment> moves;
  for (const CutterPath& path : paths) {
    const std::size_t n = path.points.size();
    if (n == 0) continue;
    const std::size_t count = n == 1 ? 1 : n - 1 + (path.closed ? 1 : 0);
    for (std::size_t i = 0; i < count; ++i)
      moves.push_back({path.points[i].center, path.points[(i + 1) % n].center});
  }
  return moves;
}

}  // namespace patchmill
