#include "cam/link/link_moves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "cam/toolpath/motion_time.h"

namespace patchmill {
namespace {

// A link along the surface may be this many times as long as a straight one, plus one ball diameter.
constexpr double kDetour = 3.0;
// If a link is at most this many times as long as a straight one, no better one is looked for.
constexpr double kShortDetour = 1.5;
// How far off a wall a link between two places at the wall may lead, in parts of the distance in plan.
constexpr std::array<double, 4> kBulges = {0.0625, 0.125, 0.25, 0.5};
// mm: an end of a link that is this little below the surface along which the link leads counts as on it.
constexpr double kOnSurface = 1e-4;
// In approach gaps: how far a link above the stock may come below the gap.
constexpr double kGapTolerance = 0.2;

void AddRapid(const Vec3& to, std::vector<Move>& moves) {
  moves.push_back({.kind = MoveKind::kRapid, .to = to});
}

// The places between a and b of a way along a surface of ball centres, whose first place is over or under
// a, and whose last is over or under b. These two are left out where a or b is no lower: the way from a
// itself to the next place is no lower, and it does not begin with a step down.
std::span<const CutterPoint> PlacesBetween(const Vec3& a, const Vec3& b, std::span<const CutterPoint> way) {
  if (way.size() > 1 && a.z() >= way.front().center.z() - kOnSurface) way = way.subspan(1);
  if (way.size() > 1 && b.z() >= way.back().center.z() - kOnSurface) way = way.first(way.size() - 1);
  return way;
}

LeadFigure FigureOf(const Lead& lead, bool in, const LinkParams& params) {
  return {lead.kind, in, lead.radius, lead.radius == params.lead.radius, lead.places.back()};
}

}  // namespace

LinkMaker::LinkMaker(const Locator& locator, const Locator& stock_locator, const LinkParams& params,
                     const RunContext& run)
    : run_(run), params_(params), check_(locator, stock_locator, params), max_link_(MaxLinkLength(params)) {}

std::optional<LinkMaker::Way> LinkMaker::AlongSurface(const Vec3& a, const Vec3& b,
                                                      std::span<const Vec2> corners) const {
  const std::vector<ScanRun> runs = ScanPolyline(check_.locator(), corners, params_.pass, &run_);
  if (runs.size() != 1 || runs.front().points.size() < 2) return std::nullopt;
  const auto& points = runs.front().points;
  // The run must start and end over or under a and b. Between a free centre and the centre surface over or
  // under it nothing is in the way.
  if ((Xy(points.front().center) - Xy(a)).norm() > 1e-6 || (Xy(points.back().center) - Xy(b)).norm() > 1e-6) {
    return std::nullopt;
  }
  Way way;
  Vec3 at = a;
  bool allowed = true;
  const auto go = [&](const Vec3& to) {
    const double step = (to - at).norm();
    if (step < 1e-9) return;
    way.length += step;
    allowed = allowed && check_.Allowed(at, to);
    way.moves.push_back(check_.Feed(MoveKind::kLink, at, to));
    at = to;
  };
  for (const CutterPoint& p : PlacesBetween(a, b, points)) go(p.center);
  go(b);
  if (!allowed || way.length > kDetour * (b - a).norm() + 2.0 * params_.radius) return std::nullopt;
  return way;
}

std::optional<std::vector<Move>> LinkMaker::StayDown(const CutterPoint& from, const CutterPoint& to) const {
  const Vec3 &a = from.center, &b = to.center;
  const double length = (b - a).norm();
  if (length > max_link_) return std::nullopt;
  if (check_.StraightIsFree(a, b)) return std::vector<Move>{check_.Feed(MoveKind::kLink, a, b)};
  const double plan = (Xy(b) - Xy(a)).norm();
  if (plan < 1e-6) return std::nullopt;
  std::optional<Way> best = AlongSurface(a, b, std::array{Xy(a), Xy(b)});
  if (length <= 2.0 * params_.radius) {
    // If both ends are at a wall that bends, a straight way climbs the wall, and a way a little off it is
    // short. If they are at a limit that bends, a straight way crosses the limit.
    const bool limits = params_.operation_limits != nullptr && !params_.operation_limits->AllowsAll();
    const Vec2 along = Xy(b) - Xy(a);
    const Vec2 across(-along.y(), along.x());
    const double off = across.dot(Xy(NormalAt(from) + NormalAt(to)));
    for (const double bulge : kBulges) {
      for (const double side : {1.0, -1.0}) {
        if (best && best->length <= kShortDetour * length) break;
        if (!limits && side * off < -1e-3 * across.norm()) continue;  // it would lead into the wall
        const Vec2 middle = 0.5 * (Xy(a) + Xy(b)) + side * bulge * across;
        std::optional<Way> round = AlongSurface(a, b, std::array{Xy(a), middle, Xy(b)});
        if (round && (!best || round->length < best->length)) best = std::move(round);
      }
    }
  }
  if (!best) return std::nullopt;
  return std::move(best->moves);
}

void LinkMaker::Leave(const Lead& out, bool to_clear, std::vector<Move>& moves) const {
  for (std::size_t k = out.places.size() - 1; k-- > 0;)
    moves.push_back(check_.Feed(MoveKind::kLead, out.places[k + 1], out.places[k]));
  const Vec3& beside = out.places.front();
  if (to_clear && out.clear.z() > beside.z() + 1e-9)
    moves.push_back(check_.Feed(MoveKind::kRetract, beside, out.clear));
}

void LinkMaker::Enter(const Lead& in, bool from_clear, std::vector<Move>& moves) const {
  const Vec3& beside = in.places.front();
  if (from_clear && in.clear.z() > beside.z() + 1e-9)
    moves.push_back(check_.Feed(MoveKind::kPlunge, in.clear, beside));
  for (std::size_t k = 1; k < in.places.size(); ++k)
    moves.push_back(check_.Feed(MoveKind::kLead, in.places[k - 1], in.places[k]));
}

Link LinkMaker::Approach(const PassEnd& start) const {
  const Lead in = FindLead(check_, start);
  Link link;
  AddRapid(Lift(Xy(in.clear), check_.clearance_center_z()), link.moves);
  if (in.clear.z() < check_.clearance_center_z() - 1e-9) AddRapid(in.clear, link.moves);
  Enter(in, true, link.moves);
  link.leads = {FigureOf(in, true, params_)};
  return link;
}

Link LinkMaker::Retract(const PassEnd& end) const {
  const Lead out = FindLead(check_, end);
  Link link;
  Leave(out, true, link.moves);
  if (check_.clearance_center_z() > out.clear.z() + 1e-9)
    AddRapid(Lift(Xy(out.clear), check_.clearance_center_z()), link.moves);
  link.leads = {FigureOf(out, false, params_)};
  return link;
}

Link LinkMaker::Over(const PassEnd& end, const PassEnd& start) const {
  const Lead out = FindLead(check_, end), in = FindLead(check_, start);
  Link link;
  link.leads = {FigureOf(out, false, params_), FigureOf(in, true, params_)};
  std::vector<Move> rapids;
  const double low = check_.LowRapidHeight(out.clear, in.clear);
  const double rapid_z = params_.low_rapids ? low : check_.clearance_center_z();
  if (rapid_z > out.clear.z() + 1e-9) AddRapid(Lift(Xy(out.clear), rapid_z), rapids);
  AddRapid(Lift(Xy(in.clear), rapid_z), rapids);
  if (in.clear.z() < rapid_z - 1e-9) AddRapid(in.clear, rapids);
  const auto with_leads = [&](const std::vector<Move>& between, bool from_clear) {
    std::vector<Move> moves;
    Leave(out, from_clear, moves);
    moves.insert(moves.end(), between.begin(), between.end());
    Enter(in, from_clear, moves);
    return moves;
  };
  link.moves = with_leads(rapids, true);
  link.saved_by_low_rapids = 2.0 * (rapid_z - low);
  // A line that is cut one way only is approached from above, so there a retract marks nothing more.
  const bool one_way = start.traversal() == Traversal::kOneWay;
  double least = TimeOf(end.center(), link.moves) + (one_way ? 0.0 : params_.retract_time);
  const auto take = [&](std::vector<Move> moves) {
    const double time = TimeOf(end.center(), moves);
    if (time >= least) return;
    least = time;
    link.moves = std::move(moves);
    link.saved_by_low_rapids = 0.0;
  };
  if (!params_.low_rapids) return link;
  if (const auto level = BesideStock(out.places.front(), in.places.front()))
    take(with_leads({*level}, false));
  if (const auto above = AboveStock(out.clear, in.clear, least)) take(with_leads(*above, true));
  return link;
}

std::optional<Move> LinkMaker::BesideStock(const Vec3& a, const Vec3& b) const {
  const double gap = kGapTolerance * params_.approach_gap;
  if (!check_.ClearOfAllowance(a, b, gap) || !check_.Allowed(a, b)) return std::nullopt;
  if (!check_.ClearOfStockSolid(a, b, params_.approach_gap - gap)) return std::nullopt;
  return check_.AirMove(b);
}

std::optional<std::vector<Move>> LinkMaker::AboveStock(const Vec3& a, const Vec3& b, double longest) const {
  const double plan = (Xy(b) - Xy(a)).norm();
  if (60.0 * plan > longest * params_.link_feed.value_or(params_.feed)) return std::nullopt;
  std::vector<Move> moves;
  const double least_gap = (1.0 - kGapTolerance) * params_.approach_gap;
  Vec3 at = a;
  const auto go = [&](const Vec3& to) {
    if ((to - at).norm() < 1e-9) return true;
    if (!check_.Allowed(at, to) || !check_.ClearOfStockSolid(at, to, least_gap)) return false;
    moves.push_back(check_.AirMove(to));
    at = to;
    return true;
  };
  if (plan > 1e-6) {
    PassParams pass = params_.pass;
    pass.chord_tolerance = std::max(pass.chord_tolerance, kGapTolerance * params_.approach_gap);
    const std::vector<ScanRun> runs =
        ScanPolyline(check_.stock_locator(), std::array{Xy(a), Xy(b)}, pass, &run_);
    if (runs.size() != 1) return std::nullopt;
    const std::vector<CutterPoint>& points = runs.front().points;
    if ((Xy(points.front().center) - Xy(a)).norm() > 1e-6 ||
        (Xy(points.back().center) - Xy(b)).norm() > 1e-6) {
      return std::nullopt;
    }
    const double rise = params_.allowance.Rise();
    for (const CutterPoint& point :
         PlacesBetween(a - Lift(Vec2::Zero(), rise), b - Lift(Vec2::Zero(), rise), points)) {
      if (!go(point.center + Lift(Vec2::Zero(), rise))) return std::nullopt;
    }
  }
  if (!go(b) || TimeOf(a, moves) > longest) return std::nullopt;
  return moves;
}

double TimeOf(const Vec3& from, const std::vector<Move>& moves) {
  double sum = 0.0;
  Vec3 at = from;
  for (const Move& move : moves) {
    sum += EstimatedTime(move, (move.to - at).norm());
    at = move.to;
  }
  return sum;
}

double CostOf(const LinkMaker& maker, const PassEnd& end, const Link& link) {
  const bool retracts = std::any_of(link.moves.begin(), link.moves.end(),
                                    [](const Move& m) { return m.kind == MoveKind::kRapid; });
  return TimeOf(end.center(), link.moves) + (retracts ? maker.params().retract_time : 0.0);
}

Link LinkTo(const LinkMaker& maker, const PassEnd& end, const CutterPath& next) {
  const PassEnd start = PassEnd::Start(next);
  std::optional<std::vector<Move>> down;
  if (next.traversal != Traversal::kOneWay) down = maker.StayDown(end.point(), start.point());
  // Any way over the top takes at least as long as a retract.
  if (down && TimeOf(end.center(), *down) <= maker.params().retract_time) return {*std::move(down), {}};
  Link over = maker.Over(end, start);
  if (down && TimeOf(end.center(), *down) <= CostOf(maker, end, over)) return {*std::move(down), {}};
  return over;
}

}  // namespace patchmill
