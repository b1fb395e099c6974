// A hash grid of small boxes that finds those near a place.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

// One array holds the entries of all cells, ordered by slot (the low bits of the cell's hash) and within a
// slot by box number.
class BoxGrid {
 public:
  // `cell`: mm, > 0; best about as wide as the boxes and the usual `reach`. Cost: 0.1 us for each cell that a
  // box meets.
  BoxGrid(std::span<const Box3> boxes, double cell);

  // Calls visit(i) for every box that shares a cell with the cube of all points within `reach` (mm) of p in
  // each coordinate. It is called once for each shared cell, so a box may come several times, and some boxes
  // lie farther away than `reach`.
  template <class Visit>
  void Near(const Vec3& p, double reach, const Visit& visit) const {
    VisitCells(p - Vec3::Constant(reach), p + Vec3::Constant(reach), [&](std::uint64_t hash) {
      const std::size_t slot = hash & mask_;
      for (std::size_t k = first_[slot]; k < first_[slot + 1]; ++k) {
        if (entries_[k].hash == hash) visit(entries_[k].box);
      }
    });
  }

 private:
  struct Entry {
    std::uint64_t hash = 0;
    std::size_t box = 0;
  };
  using Index = std::array<std::int64_t, 3>;
  Index Key(const Vec3& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x() / cell_)),
            static_cast<std::int64_t>(std::floor(p.y() / cell_)),
            static_cast<std::int64_t>(std::floor(p.z() / cell_))};
  }
  static std::uint64_t Hash(const Index& k) {
    std::uint64_t h = 1469598103934665603ull;
    for (const std::int64_t x : k) h = (h ^ static_cast<std::uint64_t>(x)) * 1099511628211ull;
    return h ^ (h >> 32);
  }
  template <class Visit>
  void VisitCells(const Vec3& min, const Vec3& max, const Visit& visit) const {
    const Index low = Key(min), high = Key(max);
    for (auto x = low[0]; x <= high[0]; ++x) {
      for (auto y = low[1]; y <= high[1]; ++y) {
        for (auto z = low[2]; z <= high[2]; ++z) visit(Hash({x, y, z}));
      }
    }
  }

  double cell_;
  std::size_t mask_ = 0;
  std::vector<std::size_t> first_;  // entries of slot k are [first_[k], first_[k + 1])
  std::vector<Entry> entries_;
};

}  // namespace patchmill
