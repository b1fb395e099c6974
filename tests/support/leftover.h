// Measures what a set of passes leaves, by brute force: no code of cam/location or cam/path.
#pragma once

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "cam/toolpath/cutter_path.h"
#include "core/base/vec.h"

namespace patchmill::testing {

// Distances to the segments of many paths, hashed by plan cells of 1 mm.
class DistanceToPaths {
 public:
  explicit DistanceToPaths(const std::vector<CutterPath>& paths) {
    for (const CutterPath& path : paths) {
      const std::size_t n = path.points.size();
      for (std::size_t i = 0; i + 1 < n + (path.closed && n > 1 ? 1 : 0); ++i) {
        Add(path.points[i].center, path.points[(i + 1) % n].center);
      }
    }
  }

  // Distance of p to the nearest segment, if less than `limit`; else `limit`.
  double At(const Vec3& p, double limit) const {
    double best = limit;
    for (int i = Cell(p.x() - limit); i <= Cell(p.x() + limit); ++i) {
      for (int j = Cell(p.y() - limit); j <= Cell(p.y() + limit); ++j) {
        const auto it = cells_.find({i, j});
        if (it == cells_.end()) continue;
        for (std::size_t k : it->second) best = std::min(best, Distance(p, segments_[k]));
      }
    }
    return best;
  }

 private:
  using Segment = std::pair<Vec3, Vec3>;
  static int Cell(double x) { return static_cast<int>(std::floor(x)); }
  static double Distance(const Vec3& p, const Segment& s) {
    const Vec3 d = s.second - s.first;
    const double l2 = d.squaredNorm();
    const double f = l2 > 0 ? std::min(1.0, std::max(0.0, (p - s.first).dot(d) / l2)) : 0.0;
    return (p - s.first - f * d).norm();
  }
  // Every cell the segment may touch: the cells of points half a cell apart and their neighbours' borders.
  void Add(const Vec3& a, const Vec3& b) {
    const std::size_t index = segments_.size();
    segments_.push_back({a, b});
    const int steps = 1 + static_cast<int>((b - a).norm() / 0.25);
    for (int k = 0; k <= steps; ++k) {
      const Vec3 x = a + (b - a) * (static_cast<double>(k) / steps);
      for (double dx : {-0.25, 0.25}) {
        for (double dy : {-0.25, 0.25}) {
          auto& list = cells_[{Cell(x.x() + dx), Cell(x.y() + dy)}];
          if (list.empty() || list.back() != index) list.push_back(index);
        }
      }
    }
  }

  std::vector<Segment> segments_;
  std::map<std::pair<int, int>, std::vector<std::size_t>> cells_;
};

inline double TotalLength(const std::vector<CutterPath>& paths) {
  double sum = 0.0;
  for (const CutterPath& path : paths) sum += Length(path);
  return sum;
}

}  // namespace patchmill::testing
