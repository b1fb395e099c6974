// Safe ways from one place to another: straight, along the centre surface, or over the top
// ([machining M1, M6, M7], [verification P3]).
#pragma once

#include <optional>
#include <span>
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

  // Feed moves that stay down: straight when certified gouge-free (the swept ball), else along the
  // centre surface, where both ends stand at a wall also a little off it; nullopt when none is short enough.
  // The centre of `to` is the last move's end.
  std::optional<std::vector<Move>> StayDown(const CutterPoint& from, const CutterPoint& to) const;

  // Leaves `from` upward to the clearance plane: at feed until clear of the stock, beside walls where that is
  // free, then rapid.
  void Retract(const CutterPoint& from, std::vector<Move>& moves) const;
  // From above to `to`: rapid at the clearance plane, rapid down to where the stock may begin, plunge feed,
  // and in from beside the wall.
  void Approach(const CutterPoint& to, std::vector<Move>& moves) const;
  // Both; with low rapids no higher between them than where everything over the rectangle between the two
  // places clears the stock ([verification P3]): controls may drive the axes of a rapid one after the other.
  std::vector<Move> Over(const CutterPoint& from, const CutterPoint& to) const;

  // A feed move of kind `kind` to `to`: plunge feed when it descends steeper than the limit.
  Move Feed(MoveKind kind, const Vec3& from, const Vec3& to) const;

  double clearance_center_z() const { return params_.clearance_z + params_.radius; }
  double stock_depth() const { return params_.allowance + params_.approach_gap; }  // mm, along the normal

 private:
  // The way between a pass and the stock's outside: from the point straight to `beside`, straight up to
  // `clear`, where the ball is clear of the stock (surface + allowance + gap). Either may be no way at all.
  struct WayOut {
    Vec3 beside, clear;
  };
  enum class Going { kIn, kOut };
  // The quickest of a few, plunges counted as the slowest: beside walls level, off the contact along its
  // normal or turned from it, along the wall or straight up only where nothing leads off it; on gentle ground
  // straight up, or aslant where something stands above.
  WayOut FindWayOut(const CutterPoint& point, Going going) const;
  void Leave(const CutterPoint& from, const WayOut& out, double rapid_z, std::vector<Move>& moves) const;
  void Enter(const WayOut& in, const CutterPoint& to, double rapid_z, std::vector<Move>& moves) const;
  // Centre height of a rapid between two places that are clear of the stock.
  double RapidHeight(const Vec3& a, const Vec3& b) const;
  struct Way {
    std::vector<Move> moves;
    double length = 0.0;  // mm
  };
  // Feed moves over the corners, which begin above a and end above b; nullopt: none, or too long.
  std::optional<Way> AlongSurface(const Vec3& a, const Vec3& b, std::span<const Vec2> corners) const;
  static Vec3 OffWalls(const CutterPoint& point);  // sum of the unit normals at its contacts
  // Centre height over `place`, at least its own, where the ball is clear of the stock, the clearance plane
  // at most.
  double ClearOfStock(const Vec3& place) const;
  bool StraightIsFree(const Vec3& a, const Vec3& b) const;
  // By params_.operation_limits: where the operation allows the centre, and where feeding leaves alone what
  // is not to
  // be cut.
  bool Allowed(const Vec3& a, const Vec3& b) const;
  // The ball is clear of the stock, or the ground next to it is wanted and the tip not above the highest.
  bool LeavesUnwanted(const Vec3& c) const;

  const RunContext& run_;
  const Locator& locator_;
  const Locator& stock_locator_;
  const LinkParams& params_;
  double t2_length_;
  double max_link_;
  double overrun_;  // mm: how far beyond what is wanted links may touch
};

// s, as EstimatedTime has it.
double TimeOf(const Vec3& from, const std::vector<Move>& moves);

// From where one pass ends to the next: down along the surface, or over the top where that is quicker.
std::vector<Move> LinkTo(const LinkMaker& maker, const CutterPoint& end, const CutterPath& next);

}  // namespace patchmill
