// Points in cubic cells, to find those near each other or near a place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/run_context.h"
#include "core/base/union_find.h"
#include "core/base/vec.h"

namespace patchmill {

class SampleCells {
 public:
  SampleCells() = default;
  // `reach`, mm, > 0: points this near to each other are joined by JoinNear. Cost O(n log n).
  SampleCells(std::vector<Vec3> points, double reach);

  // Joins all that are within the reach of each other. Cost O(n log n), more where many points of two cells
  // are just out of it. Not all of them once cancelled.
  void JoinNear(UnionFind& sets, const RunContext& run) const;
  // The point nearest to a place, the first of equally near ones; none without points. Cost O(log n), more
  // where it is some reaches away, O(n) beyond five.
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
  double reach_ = 1.0, side_ = 1.0;  // mm; of a cell: two points in one are within the reach
  std::vector<Entry> entries_;       // by rising keys
  Key low_ = {0, 0, 0}, high_ = {0, 0, 0};
};

}  // namespace patchmill
