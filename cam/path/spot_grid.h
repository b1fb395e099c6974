// Leftover spots by the place of the ball centres that would finish them.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "cam/path/leftover_spots.h"

namespace patchmill {

// Cubic cells in an ordered map, so that visits come in the same order everywhere. Keeps a reference to the
// spots.
class SpotGrid {
 public:
  // cell > 0, mm: about the radius of a typical question.
  SpotGrid(const std::vector<LeftoverSpot>& spots, double cell) : spots_(spots), cell_(cell) {
    for (std::size_t i = 0; i < spots.size(); ++i) cells_[KeyOf(spots[i].center)].push_back(i);
  }

  // Calls visit(index) for every spot whose centre lies within `reach` of c.
  template <class Visit>
  void Near(const Vec3& c, double reach, Visit visit) const {
    const Key lo = KeyOf(c - Vec3::Constant(reach)), hi = KeyOf(c + Vec3::Constant(reach));
    for (int i = lo[0]; i <= hi[0]; ++i) {
      for (int j = lo[1]; j <= hi[1]; ++j) {
        // Of one column all levels lie side by side in the map.
        const auto end = cells_.upper_bound({i, j, hi[2]});
        for (auto it = cells_.lower_bound({i, j, lo[2]}); it != end; ++it) {
          for (std::size_t s : it->second) {
            if ((spots_[s].center - c).norm() <= reach) visit(s);
          }
        }
      }
    }
  }

 private:
  using Key = std::array<int, 3>;
  Key KeyOf(const Vec3& c) const {
    return {static_cast<int>(std::floor(c.x() / cell_)), static_cast<int>(std::floor(c.y() / cell_)),
            static_cast<int>(std::floor(c.z() / cell_))};
  }

  const std::vector<LeftoverSpot>& spots_;
  double cell_;
  std::map<Key, std::vector<std::size_t>> cells_;
};

}  // namespace patchmill
