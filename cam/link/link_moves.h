// Safe ways from one place to another: straight, along the centre surface, or over the top (MACHINING A.1,
// A.6, A.7; P3).
#pragma once

#include <optional>
#include <vector>

#include "cam/link/link_paths.h"

namespace patchmill {

// What is needed to judge and make links; locators are for the ball with stock to leave and for the ball plus
// allowance and gap.
class LinkMaker {
 public:
  // A cancelled run makes links that are of no use.
  LinkMaker(const Locator& locator, const Locator& stock_locator, const LinkParams& params,
            const RunContext& run);

  // Feed moves from centre a to centre b that stay down: straight when certified gouge-free (T2 or the swept
  // ball), else along the centre surface; nullopt when neither is short enough. b itself is the last move's
  // end.
  std::optional<std::vector<Move>> StayDown(const Vec3& a, const Vec3& b) const;

  // Leaves `from` upward to the clearance plane: out beside the wall where that is free, at feed until clear
  // of the stock, then rapid.
  void Retract(const CutterPoint& from, std::vector<Move>& moves) const;
  // From above to `to`: rapid at the clearance plane, rapid down to where the stock may begin, plunge feed,
  // and in from beside the wall.
  void Approach(const CutterPoint& to, std::vector<Move>& moves) const;

  // A feed move of kind `kind` to `to`: plunge feed when it descends steeper than the limit.
  Move Feed(MoveKind kind, const Vec3& from, const Vec3& to) const;

  double clearance_center_z() const { return params_.clearance_z + params_.radius; }

 private:
  // Beside the wall: off the contact by allowance + gap along the horizontal part of the outward normal, when
  // the ball is free all the way; nullopt on gentle ground or where something is in the way.
  std::optional<Vec3> BesideWall(const CutterPoint& point) const;
  // Centre height at q where the ball is clear of the stock, at least z.
  double ClearOfStock(const Vec2& q, double z) const;
  bool StraightIsFree(const Vec3& a, const Vec3& b) const;
  bool Allowed(const Vec3& a, const Vec3& b) const;  // by params_.keep_in

  const RunContext& run_;
  const Locator& locator_;
  const Locator& stock_locator_;
  const LinkParams& params_;
  double t2_length_;
  double max_link_;
};

}  // namespace patchmill
