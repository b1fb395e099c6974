#include "cam/link/link_moves.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

// Below this slope of the contact a pass is entered from above; steeper, from beside.
constexpr double kBesideWallSlope = Radians(50.0);
// A link along the surface may be this much longer than straight, plus one ball.
constexpr double kDetour = 3.0;

}  // namespace

LinkMaker::LinkMaker(const Locator& locator, const Locator& stock_locator, const LinkParams& params,
                     const RunContext& run)
    : run_(run),
      locator_(locator),
      stock_locator_(stock_locator),
      params_(params),
      // T2: two free centres this far apart gouge at most the chord tolerance in between.
      t2_length_(2.0 *
                 std::sqrt(std::max(0.0, 2.0 * locator.radius() * params.pass.chord_tolerance -
                                             params.pass.chord_tolerance * params.pass.chord_tolerance))),
      max_link_(params.max_link_length > 0.0 ? params.max_link_length : 6.0 * params.radius) {}

Move LinkMaker::Feed(MoveKind kind, const Vec3& from, const Vec3& to) const {
  const Vec3 d = to - from;
  const double across = Plan(d).norm();
  const bool steep_descent = d.z() < 0.0 && std::atan2(-d.z(), across) > params_.plunge_angle;
  Move move;
  move.kind = kind;
  move.to = to;
  move.feed = steep_descent ? params_.plunge_feed : params_.feed;
  return move;
}

bool LinkMaker::Allowed(const Vec3& a, const Vec3& b) const {
  return params_.keep_in == nullptr || params_.keep_in->AllowsMove(a, b, false);
}

bool LinkMaker::StraightIsFree(const Vec3& a, const Vec3& b) const {
  if (!Allowed(a, b)) return false;
  const double length = (b - a).norm();
  if (length <= t2_length_) return true;
  const double tolerance = params_.pass.chord_tolerance;
  return locator_.GougeWithin(a, b, tolerance, 0.1 * tolerance);
}

std::optional<std::vector<Move>> LinkMaker::StayDown(const Vec3& a, const Vec3& b) const {
  const double plan = (Plan(b) - Plan(a)).norm();
  const double length = (b - a).norm();
  if (length > max_link_) return std::nullopt;
  if (StraightIsFree(a, b)) return std::vector<Move>{Feed(MoveKind::kLink, a, b)};
  if (plan < 1e-6) return std::nullopt;
  const std::vector<ScanRun> runs = ScanLine(locator_, Plan(a), Plan(b), params_.pass, &run_);
  if (runs.size() != 1 || runs.front().points.size() < 2) return std::nullopt;
  const auto& points = runs.front().points;
  // The run must start and end over or under a and b: straight up or down from a free centre to one on the
  // centre surface nothing is in the way.
  if ((Plan(points.front().center) - Plan(a)).norm() > 1e-6 ||
      (Plan(points.back().center) - Plan(b)).norm() > 1e-6) {
    return std::nullopt;
  }
  std::vector<Move> moves;
  Vec3 at = a;
  double along = 0.0;
  bool allowed = true;
  const auto go = [&](const Vec3& to) {
    if ((to - at).norm() < 1e-9) return;
    along += (to - at).norm();
    allowed = allowed && Allowed(at, to);
    moves.push_back(Feed(MoveKind::kLink, at, to));
    at = to;
  };
  for (const CutterPoint& p : points) go(p.center);
  go(b);
  if (!allowed || along > kDetour * length + 2.0 * params_.radius) return std::nullopt;
  return moves;
}

double LinkMaker::ClearOfStock(const Vec2& q, double z) const {
  const auto top = stock_locator_.Height(q);
  const double gap_above = z + params_.approach_gap;
  const double clear = top ? std::max(top->z, gap_above) : gap_above;
  return std::min(clear, clearance_center_z());
}

std::optional<Vec3> LinkMaker::BesideWall(const CutterPoint& point) const {
  if (!point.contact) return std::nullopt;
  const Vec3 normal = (point.center - point.contact->p).normalized();
  if (std::acos(std::clamp(normal.z(), -1.0, 1.0)) < kBesideWallSlope) return std::nullopt;
  Vec2 out = Plan(normal).normalized();
  if (point.other_contact) {  // a corner: out along the bisector of the two walls
    const Vec2 other = Plan(Vec3(point.center - point.other_contact->p));
    if (other.norm() > 1e-9) out += other.normalized();
    if (out.norm() < 1e-3) return std::nullopt;
    out.normalize();
  }
  const Vec2 q = Plan(point.center) + (params_.allowance + params_.approach_gap) * out;
  const Vec3 beside = Lift(q, point.center.z());
  if (!locator_.Free(beside) || !StraightIsFree(beside, point.center)) return std::nullopt;
  return beside;
}

void LinkMaker::Retract(const CutterPoint& from, std::vector<Move>& moves) const {
  Vec3 at = from.center;
  if (const auto beside = BesideWall(from)) {
    moves.push_back(Feed(MoveKind::kLead, at, *beside));
    at = *beside;
  }
  const double clear = ClearOfStock(Plan(at), at.z());
  if (clear > at.z() + 1e-9) {
    const Vec3 up = Lift(Plan(at), clear);
    moves.push_back(Feed(MoveKind::kRetract, at, up));
    at = up;
  }
  if (clearance_center_z() > at.z() + 1e-9) {
    moves.push_back({.kind = MoveKind::kRapid, .to = Lift(Plan(at), clearance_center_z())});
  }
}

void LinkMaker::Approach(const CutterPoint& to, std::vector<Move>& moves) const {
  const auto beside = BesideWall(to);
  const Vec3 entry = beside ? *beside : to.center;
  const double clear = ClearOfStock(Plan(entry), entry.z());
  moves.push_back({.kind = MoveKind::kRapid, .to = Lift(Plan(entry), clearance_center_z())});
  const Vec3 near = Lift(Plan(entry), clear);
  if (clear < clearance_center_z() - 1e-9) moves.push_back({.kind = MoveKind::kRapid, .to = near});
  if (near.z() > entry.z() + 1e-9) moves.push_back(Feed(MoveKind::kPlunge, near, entry));
  if (beside) moves.push_back(Feed(MoveKind::kLead, entry, to.center));
}

}  // namespace patchmill
