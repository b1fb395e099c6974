// Makes links: safe motion from one pass to the next, straight, along the centre surface, or over the top
// ([machining M1, M6, M7], [verification P3], [linking]).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cam/link/leads.h"
#include "cam/link/link_paths.h"
#include "cam/link/move_check.h"
#include "cam/link/pass_end.h"

namespace patchmill {

// Motion between two passes, before the first or after the last.
struct Link {
  std::vector<Move> moves;
  std::vector<LeadFigure> leads = {};  // those that the motion contains
  double saved_by_low_rapids = 0.0;    // mm of rapids that low rapids would save
};

// Makes links and proves them. `locator` is for the ball plus the stock to leave, `stock_locator` for the
// ball plus stock allowance of walls and approach gap. Keeps references to all arguments.
class LinkMaker {
 public:
  // Links that were made after a cancel must not be used.
  LinkMaker(const Locator& locator, const Locator& stock_locator, const LinkParams& params,
            const RunContext& run);

  const LinkParams& params() const { return params_; }
  const MoveCheck& check() const { return check_; }

  // Feed moves of a stay-down link: straight if the swept ball is certified not to gouge, else along the
  // centre surface. If both ends are close to each other, it also tries ways a little off the wall. nullopt
  // if none is short enough. The last move ends at the centre of `to`.
  std::optional<std::vector<Move>> StayDown(const CutterPoint& from, const CutterPoint& to) const;

  // The way from the end of a pass to the clearance plane: the lead, at feed until clear of the stock, then
  // rapid.
  Link Retract(const PassEnd& end) const;
  // The way from the clearance plane to the start of a pass: rapid at the clearance plane, rapid down to
  // where the stock may begin, plunge feed, and the lead.
  Link Approach(const PassEnd& start) const;
  // A lead off the end of a pass and one onto the start of another. Between them the ball goes by rapids.
  // With low rapids it goes at feed, beside the stock or close above it, if that costs less. Low rapids go
  // only so high that every place of the rectangle between the two is clear of the stock [verification P3].
  Link Over(const PassEnd& end, const PassEnd& start) const;

 private:
  // Adds the moves of a lead, and those between its outer end and the place where the ball is clear of the
  // stock if that is where the motion goes on or comes from.
  void Leave(const Lead& out, bool to_clear, std::vector<Move>& moves) const;
  void Enter(const Lead& in, bool from_clear, std::vector<Move>& moves) const;
  struct Way {
    std::vector<Move> moves;
    double length = 0.0;  // mm
  };
  // Feed moves along the centre surface over the corners, which begin over a and end over b. nullopt if there
  // is no such way or if it is too long.
  std::optional<Way> AlongSurface(const Vec3& a, const Vec3& b, std::span<const Vec2> corners) const;
  // A straight feed move from a to b that is clear of the stock by at least 0.8 of the approach gap, as
  // between two places beside one wall.
  std::optional<Move> BesideStock(const Vec3& a, const Vec3& b) const;
  // Feed moves from a to b above the stock, at least 0.8 of the approach gap clear of it. a and b are clear.
  // nullopt if there is no such way straight in plan or if it takes more than `longest` s.
  std::optional<std::vector<Move>> AboveStock(const Vec3& a, const Vec3& b, double longest) const;

  const RunContext& run_;
  const LinkParams& params_;
  MoveCheck check_;
  double max_link_;  // mm
};

// Time of the moves by EstimatedTime, s.
double TimeOf(const Vec3& from, const std::vector<Move>& moves);
// The time of a link, and LinkParams::retract_time if it has rapids, s.
double CostOf(const LinkMaker& maker, const PassEnd& end, const Link& link);

// The link from the end of a pass to the start of the next: a stay-down link, or over the top if that costs
// less.
Link LinkTo(const LinkMaker& maker, const PassEnd& end, const CutterPath& next);

}  // namespace patchmill
