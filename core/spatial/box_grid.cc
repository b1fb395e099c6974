#include "core/spatial/box_grid.h"

#include <bit>
#include <numeric>

namespace patchmill {

BoxGrid::BoxGrid(std::span<const Box3> boxes, double cell) : cell_(cell) {
  std::vector<Entry> entries;
  entries.reserve(3 * boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    VisitCells(boxes[i].min, boxes[i].max, [&](std::uint64_t hash) { entries.push_back({hash, i}); });
  const std::size_t slots = std::bit_ceil(entries.size() + 1);
  mask_ = slots - 1;
  first_.assign(slots + 2, 0);
  for (const Entry& e : entries) ++first_[(e.hash & mask_) + 2];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  entries_.resize(entries.size());
  for (const Entry& e : entries) entries_[first_[(e.hash & mask_) + 1]++] = e;
}

}  // namespace patchmill
