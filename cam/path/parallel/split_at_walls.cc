#include "cam/path/parallel/split_at_walls.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace patchmill {
namespace {

constexpr double kUpright = 1e-9;  // mm, in plan: a move no longer than this is vertical

}  // namespace

std::vector<CutterPath> SplitAtWalls(CutterPath path, double height) {
  const std::size_t n = path.points.size();
  const auto wall_after = [&](std::size_t k) {
    const Vec3 way = path.points[(k + 1) % n].center - path.points[k].center;
    return Xy(way).norm() <= kUpright && std::abs(way.z()) > height;
  };
  std::vector<std::size_t> walls;
  for (std::size_t k = 0; k + (path.closed ? 0 : 1) < n; ++k) {
    if (wall_after(k)) walls.push_back(k);
  }
  std::vector<CutterPath> parts;
  if (walls.empty()) {
    parts.push_back(std::move(path));
    return parts;
  }
  if (path.closed) {
    const std::size_t start = walls.front() + 1;
    std::rotate(path.points.begin(), path.points.begin() + static_cast<std::ptrdiff_t>(start % n),
                path.points.end());
    for (std::size_t& wall : walls) wall = (wall + n - start) % n;
    std::sort(walls.begin(), walls.end());
  } else {
    walls.push_back(n - 1);
  }
  const std::vector<CutterPoint> points = std::exchange(path.points, {});
  path.closed = false;
  std::size_t first = 0;
  for (const std::size_t wall : walls) {
    if (wall > first) {
      CutterPath& part = parts.emplace_back(path);
      part.points.assign(points.begin() + static_cast<std::ptrdiff_t>(first),
                         points.begin() + static_cast<std::ptrdiff_t>(wall) + 1);
    }
    first = wall + 1;
  }
  return parts;
}

}  // namespace patchmill
