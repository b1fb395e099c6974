// Points in cubic cells: finds those near each other or near a place.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/run_context.h"
#include "core/base/union_find.h"
#include "core/base/vec.h"

namespace patchmill {

class PointCells {
 public:
  PointCells() = default;
  // `reach`: mm, > 0. JoinNear joins points this near to each other. Near is fastest for about this distance.
  // Cost O(n log n).
  PointCells(std::vector<Vec3> points, double reach);

  // Calls visit(number) for every point within `reach` (mm) of `place`, in the same order on every machine.
  template <class Visit>
  void Near(const Vec3& place, double reach, const Visit& visit) const {
    if (entries_.empty()) return;
    const Key low = KeyOf(place - Vec3::Constant(reach)), high = KeyOf(place + Vec3::Constant(reach));
    for (std::int64_t x = std::max(low[0], low_[0]); x <= std::min(high[0], high_[0]); ++x) {
      for (std::int64_t y = std::max(low[1], low_[1]); y <= std::min(high[1], high_[1]); ++y) {
        const auto [begin, end] = Column(x, y, low[2], high[2]);
        for (std::size_t i = begin; i < end; ++i) {
          const std::size_t point = entries_[i].point;
          if ((points_[point] - place).norm() <= reach) visit(point);
        }
      }
    }
  }
  // Joins all points that are within the reach of each other. Cost O(n log n); more where many points of two
  // cells are just out of reach. Once `run` is cancelled, some stay apart.
  void JoinNear(UnionFind& sets, const RunContext& run) const;
  // The point nearest to `place`, the first of equally near ones; absent if there are no points. Cost O(log
  // n); more where the point is some reaches away, O(n) beyond five.
  std::optional<std::size_t> Nearest(const Vec3& place) const;

 private:
  using Key = std::array<std::int64_t, 3>;
  struct Entry {
    Key key;
    std::size_t point = 0;
  };
  Key KeyOf(const Vec3& p) const;
  // Entries [first, last) of the cells from `low` to `high` of one column.
  std::pair<std::size_t, std::size_t> Column(std::int64_t x, std::int64_t y, std::int64_t low,
                                             std::int64_t high) const;

  std::vector<Vec3> points_;
  double reach_ = 1.0, side_ = 1.0;  // mm; side of a cell: two points in one are within the reach
  std::vector<Entry> entries_;       // by rising keys
  Key low_ = {0, 0, 0}, high_ = {0, 0, 0};
};

}  // namespace patchmill
