#include "cam/link/link_moves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cam/location/contact_points.h"
#include "cam/path/edge/limits_clip.h"
#include "cam/path/stepover/step_over.h"

namespace patchmill {
namespace {

// Where the slope of the contact is below this, a pass is entered from above, else from beside.
constexpr double kBesideWallSlope = Radians(50.0);
// A link along the surface may be this many times as long as a straight one, plus one ball diameter.
constexpr double kDetour = 3.0;
// If a link is at most this many times as long as a straight one, no better one is looked for.
constexpr double kShortDetour = 1.5;
// How far off a wall a link between two places at the wall may lead, in parts of the distance in plan.
constexpr std::array<double, 4> kBulges = {0.0625, 0.125, 0.25, 0.5};
// In chord tolerances: gouge that short links may have. Each is proven by itself, so the certificates' share
// of the tolerance is free.
constexpr double kProven = 1.2;
// In R: places of the surface that are farther than the nearest one by this still count as touched.
constexpr double kCornerOffset = 0.04;
// Turns of a lead from the contact's normal, rad, to either side. With less than kAlong it leads off the
// wall. kFarther are its lengths, in stock depths: at a limit that runs almost along the wall, leads must be
// long to lead off it. A way no longer than kTurnAwayRatio stock depths is good enough.
constexpr std::array<double, 7> kTurns = {0.0,       kPi / 4.0,       kPi / 3.0, kPi / 2.4,
                                          kPi / 2.0, 3.0 * kPi / 4.0, kPi};
constexpr double kAlong = kPi / 2.2;
constexpr std::array<double, 4> kFarther = {1.0, std::numbers::sqrt2, 2.0, 4.0};
constexpr double kTurnAwayRatio = 1.5;
// A mm of plunge costs as much as at least this many mm of lead.
constexpr double kPlunge = 3.0;
constexpr double kFineRapid = 0.1;  // mm; accuracy of the height of a low rapid

}  // namespace

LinkMaker::LinkMaker(const Locator& locator, const Locator& stock_locator, const LinkParams& params,
                     const RunContext& run)
    : run_(run),
      locator_(locator),
      stock_locator_(stock_locator),
      params_(params),
      // [location T2]: between two free centres this far apart a straight move gouges at most the chord
      // tolerance.
      t2_length_(2.0 *
                 std::sqrt(std::max(0.0, 2.0 * locator.radius() * params.pass.chord_tolerance -
                                             params.pass.chord_tolerance * params.pass.chord_tolerance))),
      max_link_(MaxLinkLength(params)),
      overrun_(kOverrun * CenterStep(locator.radius(), params.pass.scallop, 0.0)) {}

Move LinkMaker::Feed(MoveKind kind, const Vec3& from, const Vec3& to) const {
  const Vec3 d = to - from;
  const double across = Xy(d).norm();
  const bool steep_descent = d.z() < 0.0 && std::atan2(-d.z(), across) > params_.plunge_angle;
  Move move;
  move.kind = kind;
  move.to = to;
  move.feed = steep_descent ? params_.plunge_feed : params_.feed;
  return move;
}

bool LinkMaker::Allowed(const Vec3& a, const Vec3& b) const {
  if (params_.operation_limits == nullptr) return true;
  const OperationLimits& operation_limits = *params_.operation_limits;
  if (!operation_limits.AllowsMove(a, b, false)) return false;
  if (operation_limits.WantsAll() && operation_limits.AllowsMove(a, b, true)) return true;
  const int parts = 1 + static_cast<int>((b - a).norm() / (0.5 * overrun_));
  for (int k = 0; k <= parts; ++k) {
    if (!LeavesUnwanted(a + (static_cast<double>(k) / parts) * (b - a))) return false;
  }
  return true;
}

bool LinkMaker::LeavesUnwanted(const Vec3& c) const {
  const OperationLimits& operation_limits = *params_.operation_limits;
  const double clear = locator_.radius() + stock_depth();
  const std::vector<SurfacePoint> touched =
      ContactPoints(locator_.surface(), c, clear, kCornerOffset * locator_.radius());
  if (touched.empty() || (touched.front().p - c).norm() >= clear) return true;
  if (!operation_limits.AllowsMove(c, c, true)) return false;  // above the highest tip
  return std::any_of(touched.begin(), touched.end(),
                     [&](const SurfacePoint& place) { return operation_limits.WantsNear(place, overrun_); });
}

bool LinkMaker::StraightIsFree(const Vec3& a, const Vec3& b) const {
  if (!Allowed(a, b)) return false;
  // Passes in slots and holes that are a little too narrow end at centres that are not free
  // (cam/path/rest/spot_passes). [location T2] does not hold for links from there, so short links are proven,
  // too.
  const double tolerance = params_.pass.chord_tolerance;
  if ((b - a).norm() <= t2_length_) return locator_.GougeWithin(a, b, kProven * tolerance, 0.02 * tolerance);
  return locator_.GougeWithin(a, b, tolerance, 0.1 * tolerance);
}

std::optional<LinkMaker::Way> LinkMaker::AlongSurface(const Vec3& a, const Vec3& b,
                                                      std::span<const Vec2> corners) const {
  const std::vector<ScanRun> runs = ScanPolyline(locator_, corners, params_.pass, &run_);
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
    allowed = allowed && Allowed(at, to);
    way.moves.push_back(Feed(MoveKind::kLink, at, to));
    at = to;
  };
  for (const CutterPoint& p : points) go(p.center);
  go(b);
  if (!allowed || way.length > kDetour * (b - a).norm() + 2.0 * params_.radius) return std::nullopt;
  return way;
}

std::optional<std::vector<Move>> LinkMaker::StayDown(const CutterPoint& from, const CutterPoint& to) const {
  const Vec3 &a = from.center, &b = to.center;
  const double length = (b - a).norm();
  if (length > max_link_) return std::nullopt;
  if (StraightIsFree(a, b)) return std::vector<Move>{Feed(MoveKind::kLink, a, b)};
  const double plan = (Xy(b) - Xy(a)).norm();
  if (plan < 1e-6) return std::nullopt;
  std::optional<Way> best = AlongSurface(a, b, std::array{Xy(a), Xy(b)});
  if (length <= 2.0 * params_.radius) {
    // If both ends are at a wall that bends, a straight way climbs the wall, and a way a little off it is
    // short. If they are at a limit that bends, a straight way crosses the limit.
    const bool limits = params_.operation_limits != nullptr && !params_.operation_limits->AllowsAll();
    const Vec2 along = Xy(b) - Xy(a);
    const Vec2 across(-along.y(), along.x());
    const double off = across.dot(Xy(OffWalls(from) + OffWalls(to)));
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

Vec3 LinkMaker::OffWalls(const CutterPoint& point) {
  Vec3 sum = Vec3::Zero();
  for (const auto& contact : {point.contact, point.other_contact}) {
    if (contact) sum += (point.center - contact->p).normalized();
  }
  return sum;
}

double LinkMaker::ClearOfStock(const Vec3& place) const {
  const auto top = stock_locator_.Height(Xy(place));
  const double clear = top ? std::max(top->z, place.z()) : place.z();
  return std::min(clear, clearance_center_z());
}

LinkMaker::WayOut LinkMaker::FindWayOut(const CutterPoint& point, Going going) const {
  const Vec3& c = point.center;
  const double upright = going == Going::kIn ? std::max(kPlunge, params_.feed / params_.plunge_feed) : 1.0;
  const auto cost = [&](const WayOut& way) {
    return (way.beside - c).norm() + upright * (way.clear.z() - way.beside.z());
  };
  const auto up = [&](const Vec3& beside) { return WayOut{beside, Lift(Xy(beside), ClearOfStock(beside))}; };
  Vec2 out = Vec2::UnitX();
  bool steep = false;
  if (point.contact) {
    const Vec3 normal = (c - point.contact->p).normalized();
    steep = std::acos(std::clamp(normal.z(), -1.0, 1.0)) >= kBesideWallSlope;
    if (Xy(normal).norm() > 1e-6) out = Xy(normal).normalized();
    if (steep && point.other_contact) {  // a corner: the lead runs along the bisector of the two walls
      const Vec2 other = Xy(Vec3(c - point.other_contact->p));
      const Vec2 both = out + (other.norm() > 1e-9 ? Vec2(other.normalized()) : Vec2(Vec2::Zero()));
      if (both.norm() > 1e-3) out = both.normalized();
    }
  }
  const double off = stock_depth();
  const auto enough = [&](const WayOut& way) {
    return (way.beside - c).norm() + way.clear.z() - way.beside.z() <= kTurnAwayRatio * off;
  };
  WayOut best = up(c);
  if (!steep && enough(best)) return best;
  bool beside_wall = !steep;  // true once a way off the wall is found; ways along the wall then do not count
  const Vec2 left(-out.y(), out.x());
  for (const double farther : kFarther) {
    for (const double turn : kTurns) {
      for (const double side : {1.0, -1.0}) {
        if (side < 0.0 && (turn == 0.0 || turn == kPi)) continue;
        if (beside_wall && steep && turn > kAlong) continue;
        const Vec2 way = std::cos(turn) * out + side * std::sin(turn) * left;
        Vec3 beside = c + Lift(farther * off * way, 0.0);
        if (!steep) beside.z() = ClearOfStock(beside);
        const WayOut tried = up(beside);
        const bool first = !beside_wall && turn < kAlong;
        if (!first && cost(tried) >= cost(best)) continue;
        if (!locator_.Free(beside) || !StraightIsFree(beside, c)) continue;
        beside_wall = beside_wall || first;
        best = tried;
        if (enough(best)) return best;
      }
    }
  }
  return best;
}

void LinkMaker::Leave(const CutterPoint& from, const WayOut& out, double rapid_z,
                      std::vector<Move>& moves) const {
  if (out.beside != from.center) moves.push_back(Feed(MoveKind::kLead, from.center, out.beside));
  if (out.clear.z() > out.beside.z() + 1e-9) moves.push_back(Feed(MoveKind::kRetract, out.beside, out.clear));
  if (rapid_z > out.clear.z() + 1e-9) {
    moves.push_back({.kind = MoveKind::kRapid, .to = Lift(Xy(out.clear), rapid_z)});
  }
}

void LinkMaker::Enter(const WayOut& in, const CutterPoint& to, double rapid_z,
                      std::vector<Move>& moves) const {
  moves.push_back({.kind = MoveKind::kRapid, .to = Lift(Xy(in.clear), rapid_z)});
  if (in.clear.z() < rapid_z - 1e-9) moves.push_back({.kind = MoveKind::kRapid, .to = in.clear});
  if (in.clear.z() > in.beside.z() + 1e-9) moves.push_back(Feed(MoveKind::kPlunge, in.clear, in.beside));
  if (in.beside != to.center) moves.push_back(Feed(MoveKind::kLead, in.beside, to.center));
}

void LinkMaker::Retract(const CutterPoint& from, std::vector<Move>& moves) const {
  Leave(from, FindWayOut(from, Going::kOut), clearance_center_z(), moves);
}

void LinkMaker::Approach(const CutterPoint& to, std::vector<Move>& moves) const {
  Enter(FindWayOut(to, Going::kIn), to, clearance_center_z(), moves);
}

std::vector<Move> LinkMaker::Over(const CutterPoint& from, const CutterPoint& to) const {
  const WayOut out = FindWayOut(from, Going::kOut), in = FindWayOut(to, Going::kIn);
  const double rapid_z = RapidHeight(out.clear, in.clear);
  std::vector<Move> moves;
  Leave(from, out, rapid_z, moves);
  Enter(in, to, rapid_z, moves);
  return moves;
}

double LinkMaker::RapidHeight(const Vec3& a, const Vec3& b) const {
  if (!params_.low_rapids) return clearance_center_z();
  // A wider shank counts as a wider ball if it begins no lower than the ball's centre; params_.shank_lower
  // makes up for a shank that does.
  const double wider = std::max(0.0, params_.tool_radius - params_.radius);
  const double above_all = params_.stock_top_z + params_.approach_gap + params_.radius;
  const double highest = stock_locator_.MaxHeight(Xy(a), Xy(b), wider, kFineRapid);
  double clear = std::min(highest + params_.shank_lower, above_all);
  if (params_.operation_limits != nullptr)
    clear = std::max(clear, params_.operation_limits->ClearHeight(Xy(a), Xy(b)));
  return std::min(std::max({clear, a.z(), b.z()}), clearance_center_z());
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

std::vector<Move> LinkTo(const LinkMaker& maker, const CutterPoint& end, const CutterPath& next) {
  const CutterPoint& start = next.points.front();
  std::optional<std::vector<Move>> down;
  if (next.traversal != Traversal::kOneWay) down = maker.StayDown(end, start);
  // A straight link no longer than the way out of the stock and back is shorter than any way over the top.
  const bool near = (start.center - end.center).norm() <= 2.0 * maker.stock_depth();
  if (down && down->size() <= 1 && near) return *std::move(down);
  std::vector<Move> over = maker.Over(end, start);
  if (down && TimeOf(end.center, *down) <= TimeOf(end.center, over)) return *std::move(down);
  return over;
}

}  // namespace patchmill
