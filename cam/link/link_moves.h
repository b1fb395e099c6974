// Makes links: safe motion from one pass to the next, straight, along the centre surface, or over the top
// ([machining M1, M6, M7], [verification P3], [linking]).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cam/link/link_paths.h"

namespace patchmill {

// Makes links and judges them. `locator` is for the ball plus the stock to leave, `stock_locator` for the
// ball plus stock allowance and approach gap. Keeps references to all arguments.
class LinkMaker {
 public:
  // Links that were made after a cancel must not be used.
  LinkMaker(const Locator& locator, const Locator& stock_locator, const LinkParams& params,
            const RunContext& run);

  // Feed moves of a stay-down link: straight if the swept ball is certified not to gouge, else along the
  // centre surface. If both ends are close to each other, it also tries ways a little off the wall. nullopt
  // if none is short enough. The last move ends at the centre of `to`.
  std::optional<std::vector<Move>> StayDown(const CutterPoint& from, const CutterPoint& to) const;

  // Adds the retract from `from` to the clearance plane: at feed until clear of the stock, away from a wall
  // if there is room, then rapid.
  void Retract(const CutterPoint& from, std::vector<Move>& moves) const;
  // Adds the approach to `to`: rapid at the clearance plane, rapid down to where the stock may begin, plunge
  // feed, and a lead-in from beside the wall.
  void Approach(const CutterPoint& to, std::vector<Move>& moves) const;
  // Retract from `from` and approach to `to`. Low rapids go only so high that every place of the rectangle
  // between the two is clear of the stock [verification P3], because controls may drive the axes of a rapid
  // one after the other.
  std::vector<Move> Over(const CutterPoint& from, const CutterPoint& to) const;

  // A feed move of kind `kind` to `to`. It runs at plunge feed if it descends steeper than plunge_angle.
  Move Feed(MoveKind kind, const Vec3& from, const Vec3& to) const;

  double clearance_center_z() const { return params_.clearance_z + params_.radius; }
  double stock_depth() const { return params_.allowance + params_.approach_gap; }  // mm, along the normal

 private:
  // The way between a pass and the outside of the stock: from the point straight to `beside`, then straight
  // up to `clear`, where the ball is clear of the stock (surface + allowance + gap). Either may have length
  // 0.
  struct WayOut {
    Vec3 beside, clear;
  };
  enum class Going { kIn, kOut };
  // The quickest of a few ways; plunges count more than other moves. At a wall the lead is level. It runs
  // along the contact's normal or turned from it. It runs along the wall or straight up only if nothing leads
  // off the wall. In shallow areas the way goes straight up, or at a slant if something stands above.
  WayOut FindWayOut(const CutterPoint& point, Going going) const;
  void Leave(const CutterPoint& from, const WayOut& out, double rapid_z, std::vector<Move>& moves) const;
  void Enter(const WayOut& in, const CutterPoint& to, double rapid_z, std::vector<Move>& moves) const;
  // Centre height of a rapid between two places that are clear of the stock, mm.
  double RapidHeight(const Vec3& a, const Vec3& b) const;
  struct Way {
    std::vector<Move> moves;
    double length = 0.0;  // mm
  };
  // Feed moves along the centre surface over the corners, which begin over a and end over b. nullopt if there
  // is no such way or if it is too long.
  std::optional<Way> AlongSurface(const Vec3& a, const Vec3& b, std::span<const Vec2> corners) const;
  static Vec3 OffWalls(const CutterPoint& point);  // sum of the unit normals at its contacts
  // Lowest centre height over `place` at which the ball is clear of the stock, mm. It is no lower than
  // `place` and no higher than the clearance plane.
  double ClearOfStock(const Vec3& place) const;
  bool StraightIsFree(const Vec3& a, const Vec3& b) const;
  // True if params_.operation_limits allow the feed move: the centre may be there, and the ball cuts nothing
  // that is not to be finished.
  bool Allowed(const Vec3& a, const Vec3& b) const;
  // True if the ball is clear of the stock, or if the surface near it is to be finished and the tip is not
  // above the highest one allowed.
  bool LeavesUnwanted(const Vec3& c) const;

  const RunContext& run_;
  const Locator& locator_;
  const Locator& stock_locator_;
  const LinkParams& params_;
  double t2_length_;  // mm; a shorter move between free centres is certified by [location T2]
  double max_link_;   // mm
  double overrun_;    // mm; how far beyond the surface to be finished links may touch
};

// Time of the moves by EstimatedTime, s.
double TimeOf(const Vec3& from, const std::vector<Move>& moves);

// The link from the end of a pass to the start of the next: a stay-down link, or over the top if that is
// quicker.
std::vector<Move> LinkTo(const LinkMaker& maker, const CutterPoint& end, const CutterPath& next);

}  // namespace patchmill
