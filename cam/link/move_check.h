// Tests of single moves: whether they gouge, whether the limits allow them, and from which height on they are
// clear of the stock.
#pragma once

#include "cam/link/link_paths.h"

namespace patchmill {

// Keeps references to all arguments. `locator` is for the ball plus the stock to leave, `stock_locator` for
// the ball plus stock allowance of walls and approach gap; what floors have more is added here. Thread-safe.
class MoveCheck {
 public:
  MoveCheck(const Locator& locator, const Locator& stock_locator, const LinkParams& params);

  const Locator& locator() const { return locator_; }
  const Locator& stock_locator() const { return stock_locator_; }
  const LinkParams& params() const { return params_; }
  double clearance_center_z() const { return params_.clearance_z + params_.radius; }
  // Mm, along the normal.
  double stock_depth() const { return params_.allowance.Most() + params_.approach_gap; }

  // A feed move of kind `kind` to `to`. It runs at plunge feed if it descends steeper than plunge_angle.
  Move Feed(MoveKind kind, const Vec3& from, const Vec3& to) const;
  // A link that is clear of the stock. It runs at the feed of links however it descends.
  Move AirMove(const Vec3& to) const;
  // True if the straight feed move is proven to gouge by at most the chord tolerance and is Allowed.
  bool StraightIsFree(const Vec3& a, const Vec3& b) const;
  // True if the feed move stays above the floor, cuts no deeper into params().stock than it may, and
  // params().operation_limits allow it: the centre may be there, and the ball cuts nothing that is not to be
  // finished.
  bool Allowed(const Vec3& a, const Vec3& b) const;
  // True if a ball that moves from a to b is clear of the stock on the surface by the gap, less `slack` (mm).
  bool ClearOfAllowance(const Vec3& a, const Vec3& b, double slack) const;
  // Lowest centre height over `place` at which the ball is clear of the stock, mm. It is no lower than
  // `place` and no higher than the clearance plane.
  double ClearOfStock(const Vec3& place) const;
  // True if the ball is clear of params().stock by the gap (mm) all along the straight move.
  bool ClearOfStockSolid(const Vec3& a, const Vec3& b, double gap) const;
  // Centre height of a rapid between two places that are clear of the stock, mm, with low rapids: so high
  // that every place of the rectangle between the two is clear of the stock [verification P3], because
  // controls may drive the axes of a rapid one after the other.
  double LowRapidHeight(const Vec3& a, const Vec3& b) const;

 private:
  // The lowest centre (mm) from which on this cylinder of the holder is clear of the stock over the
  // rectangle.
  double ClearOfStockBelow(const UpperCylinder& cylinder, const Vec2& a, const Vec2& b) const;
  // True if a move that comes nearer to params().stock than the least depth allows cuts too deep, by the side
  // of the stock that it cuts.
  bool CutsTooDeep(const Vec3& a, const Vec3& b) const;
  double StockRoom() const;  // mm, in plan: from there on the tool is clear of params().stock
  // Centre height (mm) from which on the tool is clear of params().stock over a rectangle in plan.
  double AboveStockSolid(const Vec2& a, const Vec2& b) const;
  // True if the ball is clear of the stock, or if the surface near it is to be finished and the tip is not
  // above the highest one allowed.
  bool LeavesUnwanted(const Vec3& c) const;

  const Locator& locator_;
  const Locator& stock_locator_;
  const LinkParams& params_;
  double t2_length_;  // mm; a shorter move between free centres is certified by [location T2]
  double overrun_;    // mm; how far beyond the surface to be finished links may touch
};

}  // namespace patchmill
