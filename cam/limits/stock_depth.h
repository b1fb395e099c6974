// The stock allowance, which may differ between walls and floors.
#pragma once

#include <algorithm>
#include <cmath>

namespace patchmill {

// Depths along the normal, mm. Between a wall and a floor the depth lies between both: the stock on the part
// is the part, thickened by the smaller of both along the normal, and moved upwards by what floors have more,
// or sideways by what walls have more. A number alone holds for both.
struct StockDepth {
  double walls = 0.5;
  double floors = 0.5;

  StockDepth() = default;
  StockDepth(double both) : walls(both), floors(both) {}  // NOLINT(google-explicit-constructor): see above
  StockDepth(double on_walls, double on_floors) : walls(on_walls), floors(on_floors) {}

  bool IsOne() const { return walls == floors; }
  double Least() const { return std::min(walls, floors); }
  double Most() const { return std::max(walls, floors); }
  // By how much floors have more. A ball is clear of the stock on the part if the ball with a radius larger
  // by `walls` is clear of the part, lowered by this. Where walls have more this is more than is needed.
  double Rise() const { return std::max(0.0, floors - walls); }
  // The depth where the unit normal has the z component `up`, of either sign.
  double Along(double up) const {
    const double steep = std::sqrt(std::max(0.0, 1.0 - up * up));
    return floors >= walls ? walls + (floors - walls) * std::min(1.0, std::abs(up))
                           : floors + (walls - floors) * steep;
  }
};

inline bool operator==(const StockDepth& a, const StockDepth& b) {
  return a.walls == b.walls && a.floors == b.floors;
}

}  // namespace patchmill
