#include "cam/link/leads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "cam/location/contact_points.h"

namespace patchmill {
namespace {

constexpr double kLeastRamp = 0.2;  // mm, height of a ramp
constexpr double kTouched = 0.01;   // radii: places of the surface that much farther count as touched
// Leads that go back to the start of the pass: how much of it, in lead radii, and the smallest part of the
// radius.
constexpr std::array<double, 2> kBack = {0.5, 1.5};
constexpr double kBackRadius = 0.5;
constexpr double kBeyondStock = 1.05;  // stock depths from the pass
// Turns of a straight lead from the contact's normal, rad, to either side. With less than kAlong it leads off
// the wall. kFarther are its lengths, in stock depths: at a limit that runs almost along the wall, leads must
// be long to lead off it. A way no longer than kTurnAwayRatio stock depths is good enough.
constexpr std::array<double, 7> kTurns = {0.0,       kPi / 4.0,       kPi / 3.0, kPi / 2.4,
                                          kPi / 2.0, 3.0 * kPi / 4.0, kPi};
constexpr double kAlong = kPi / 2.2;
constexpr std::array<double, 4> kFarther = {1.0, std::numbers::sqrt2, 2.0, 4.0};
constexpr double kTurnAwayRatio = 1.5;
// A mm of plunge costs as much as at least this many mm of lead.
constexpr double kPlunge = 3.0;

Vec3 ClearOver(const MoveCheck& check, const Vec3& place) {
  return Lift(Xy(place), check.ClearOfStock(place));
}

bool AllFree(const MoveCheck& check, const std::vector<Vec3>& places) {
  if (!check.locator().Free(places.back())) return false;
  for (std::size_t k = 1; k < places.size(); ++k) {
    if (!check.StraightIsFree(places[k], places[k - 1])) return false;
  }
  return true;
}

// An arc smaller than the stock is deep ends in the stock, from where it is a long way up beside a wall.
// There the lead goes on straight, away from the wall.
std::optional<Vec3> BeyondStock(const MoveCheck& check, const LeadArc& arc) {
  const Vec3 &pass = arc.places.front(), &end = arc.places.back();
  const Vec3 along = end - arc.places[arc.places.size() - 2];
  const Vec2 level = Xy(along);
  if (level.norm() < 0.5 * along.norm()) return std::nullopt;
  const double missing = kBeyondStock * check.stock_depth() - (end - pass).norm();
  const double rise = check.ClearOfStock(end) - end.z();
  if (missing <= 0.0 || rise <= check.stock_depth()) return std::nullopt;
  const Vec3 beyond = end + Lift(missing / level.norm() * level, 0.0);
  if (check.ClearOfStock(beyond) - beyond.z() > 0.5 * rise) return std::nullopt;
  if (!check.locator().Free(beyond) || !check.StraightIsFree(beyond, end)) return std::nullopt;
  return beyond;
}

// The first free arc onto the place, from its outer end to the place. Only arcs of at least `least` mm count.
std::optional<Lead> ArcTo(const MoveCheck& check, const LeadPlace& place, double least) {
  const double sagitta = kLeadSagitta * check.params().pass.chord_tolerance;
  for (LeadArc& arc : LeadArcs(place, check.params().lead, sagitta)) {
    if (arc.radius < least) break;
    if (!AllFree(check, arc.places)) continue;
    if (const std::optional<Vec3> beyond = BeyondStock(check, arc)) arc.places.push_back(*beyond);
    std::reverse(arc.places.begin(), arc.places.end());
    const Vec3 clear = ClearOver(check, arc.places.front());
    return Lead{LeadKind::kArc, arc.radius, clear, std::move(arc.places)};
  }
  return std::nullopt;
}

std::optional<Lead> FindArc(const MoveCheck& check, const PassEnd& end) {
  const std::optional<LeadPlace> place = PlaceOf(end);
  if (!place) return std::nullopt;
  return ArcTo(check, *place, 0.0);
}

// The normal of what a ball centre on a pass touches. nullopt if it touches nothing, as on the floor.
std::optional<Vec3> TouchedNormal(const MoveCheck& check, const Vec3& center) {
  const double radius = check.locator().radius();
  const std::vector<SurfacePoint> touched =
      ContactPoints(check.locator().surface(), center, 1.1 * radius, kTouched * radius);
  Vec3 sum = Vec3::Zero();
  for (const SurfacePoint& point : touched) sum += (center - point.p).normalized();
  return sum.norm() > 1e-3 ? std::optional<Vec3>(sum.normalized()) : std::nullopt;
}

// A pass that begins in a corner has no room before its start.
std::optional<Lead> FindBack(const MoveCheck& check, const PassEnd& start) {
  for (const double share : kBack) {
    const double length = share * check.params().lead.radius;
    std::vector<Vec3> back = start.Inwards(length);
    const Vec3& inner = back.back();
    if (back.size() < 2 || (inner - start.center()).norm() < 0.5 * length) continue;
    const std::optional<Vec3> normal = TouchedNormal(check, inner);
    // The ball comes from further in, so the arc goes on inwards.
    const Vec3 inwards = (inner - back[back.size() - 2]).normalized();
    const LeadPlace place{inner, normal.value_or(Vec3::UnitZ()), inwards, normal && IsSteep(*normal)};
    std::optional<Lead> lead = ArcTo(check, place, kBackRadius * check.params().lead.radius);
    if (!lead) continue;
    for (std::size_t k = back.size() - 1; k-- > 0;) lead->places.push_back(back[k]);
    lead->kind = LeadKind::kBack;
    return lead;
  }
  return std::nullopt;
}

std::optional<Lead> FindRamp(const MoveCheck& check, const PassEnd& start) {
  const double above = ClearOver(check, start.center()).z() - start.center().z();
  // Over a plane the ball is then as high as the stock allowance, which is all that it has to cut.
  const double floors = check.params().allowance.floors;
  const double height = std::max(kLeastRamp, above * floors / (floors + check.params().approach_gap));
  std::vector<Vec3> places = RampAlong(start, check.params().lead, height);
  if (places.empty()) return std::nullopt;
  for (std::size_t k = 1; k < places.size(); ++k) {
    if (!check.Allowed(places[k - 1], places[k])) return std::nullopt;
  }
  const Vec3 clear = ClearOver(check, places.front());
  return Lead{LeadKind::kRamp, 0.0, clear, std::move(places)};
}

Lead FindStraight(const MoveCheck& check, const PassEnd& end) {
  struct WayOut {
    Vec3 beside, clear;
  };
  const CutterPoint& point = end.point();
  const Vec3& c = point.center;
  const double upright =
      end.is_start() ? std::max(kPlunge, check.params().feed / check.params().plunge_feed) : 1.0;
  const auto cost = [&](const WayOut& way) {
    return (way.beside - c).norm() + upright * (way.clear.z() - way.beside.z());
  };
  const auto up = [&](const Vec3& beside) { return WayOut{beside, ClearOver(check, beside)}; };
  const bool steep = IsSteepContact(point);
  const Vec2 level = Xy(NormalAt(point));
  const Vec2 out = level.norm() > 1e-6 ? Vec2(level.normalized()) : Vec2(Vec2::UnitX());
  const double off = check.stock_depth();
  const auto enough = [&](const WayOut& way) {
    return (way.beside - c).norm() + way.clear.z() - way.beside.z() <= kTurnAwayRatio * off;
  };
  const auto lead = [&](const WayOut& way) {
    Lead straight{LeadKind::kStraight, 0.0, way.clear, {way.beside}};
    if (way.beside != c) straight.places.push_back(c);
    return straight;
  };
  WayOut best = up(c);
  if (!steep && enough(best)) return lead(best);
  bool beside_wall = !steep;  // true once a way off the wall is found; ways along the wall then do not count
  const Vec2 left(-out.y(), out.x());
  for (const double farther : kFarther) {
    for (const double turn : kTurns) {
      for (const double side : {1.0, -1.0}) {
        if (side < 0.0 && (turn == 0.0 || turn == kPi)) continue;
        if (beside_wall && steep && turn > kAlong) continue;
        const Vec2 way = std::cos(turn) * out + side * std::sin(turn) * left;
        Vec3 beside = c + Lift(farther * off * way, 0.0);
        if (!steep) beside.z() = check.ClearOfStock(beside);
        const WayOut tried = up(beside);
        const bool first = !beside_wall && turn < kAlong;
        if (!first && cost(tried) >= cost(best)) continue;
        if (!check.locator().Free(beside) || !check.StraightIsFree(beside, c)) continue;
        beside_wall = beside_wall || first;
        best = tried;
        if (enough(best)) return lead(best);
      }
    }
  }
  return lead(best);
}

}  // namespace

Lead FindLead(const MoveCheck& check, const PassEnd& end) {
  if (std::optional<Lead> arc = FindArc(check, end)) return *std::move(arc);
  if (end.is_start()) {
    if (std::optional<Lead> back = FindBack(check, end)) return *std::move(back);
    if (std::optional<Lead> ramp = FindRamp(check, end)) return *std::move(ramp);
  }
  return FindStraight(check, end);
}

}  // namespace patchmill
