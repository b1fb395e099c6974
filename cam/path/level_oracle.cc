#include "cam/path/level_oracle.h"

#include <algorithm>
#include <cmath>

#include "core/surface/closest.h"

namespace patchmill {
namespace {

// mm: an exit shorter than this ends the walk; the place is then known to about its square.
constexpr double kStill = 1e-10;
// mm: h may pass c by this much at a border point (rounding of the contact, not of the method).
constexpr double kHeightSlack = 1e-9;
// Part of the radius: exits shorter than this look for the deepest disc instead of that of h's contact. On a
// steep wall that leans back h touches high up, where discs end soon, and would climb down the wall a
// thousandth of a millimetre at a time.
constexpr double kSlowExit = 1e-3;
// mm: up to this depth h's own contacts lead out, exactly; from deeper, the nearest point does.
constexpr double kRimDepth = 1e-6;
// mm: how far a border point may be moved out of a disc's rim at a vertical wall, where h jumps.
constexpr double kLargestNudge = 8e-10;

}  // namespace

double LevelOracle::Rho(const Vec3& p) const {
  const double below = std::max(0.0, z_ - p.z());
  const double square = radius_ * radius_ - below * below;
  return square > 0.0 ? std::sqrt(square) : 0.0;
}

double LevelOracle::Excess(const Vec2& q, const Vec3& contact) const {
  return std::hypot(q.x() - contact.x(), q.y() - contact.y(), std::max(0.0, z_ - contact.z())) - radius_;
}

double LevelOracle::ExitLength(const Vec2& q, const Vec3& contact, const Vec2& direction) const {
  const Vec2 d = q - Plan(contact);
  const double rho = Rho(contact);
  const double b = d.dot(direction), c = d.squaredNorm() - rho * rho;
  if (c >= 0.0) return 0.0;
  const double root = std::sqrt(b * b - c);
  return b > 0.0 ? -c / (b + root) : root - b;
}

LevelPoint LevelOracle::Exit(Vec2 q, SurfacePoint contact, const Vec2& direction, double reach) const {
  const Vec2 start = q;
  double gone = 0.0;
  double nudge = kStill;
  bool deep = false;  // left a disc deeper than that of h's contact: it may end on a wall where h jumps
  for (int step = 0; step < 200; ++step) {
    // On one branch the contact follows by Newton alone.
    for (int k = 0; k < 6; ++k) {
      const double t = ExitLength(q, contact.p, direction);
      gone += t;
      q = start + gone * direction;
      if (t < kStill || gone >= reach) break;
      const std::optional<CenterPoint> next = locator_.Follow(contact, q);
      if (!next || next->z <= z_) break;
      contact = next->contact;
    }
    if (gone >= reach) return {start + reach * direction, contact, std::nullopt};
    if (contact.p.z() >= z_ && nudge == kStill) {
      // h jumps at the rim of a wall: rounding must not decide on which side q lies.
      gone += nudge;
      nudge *= 2.0;
      q = start + gone * direction;
    }
    const std::optional<CenterPoint> h = locator_.Height(q, &contact);
    if (!h || h->z <= z_ + kHeightSlack) {
      if (deep) q += kStill * direction;
      return {q, contact, std::nullopt};
    }
    const double t = ExitLength(q, h->contact.p, direction);
    contact = h->contact;
    bool deeper = false;
    if (t < kSlowExit * radius_) {
      const auto nearest =
          ClosestToUpwardRay(locator_.surface(), Center(q), radius_ - kRimDepth, 0.1 * kRimDepth);
      deeper = nearest && ExitLength(q, nearest->at.p, direction) > t;
      if (deeper) contact = nearest->at;
      deep = deep || deeper;
    }
    if (t < kStill && !deeper) {
      // The rim of a vertical wall: rounding decides on which side of the jump q lies.
      if (nudge > kLargestNudge) return {q, contact, std::nullopt};
      gone += nudge;
      nudge *= 2.0;
      q = start + gone * direction;
    }
  }
  // No end in sight: as good as out, or else the far end, which is free.
  if (AnythingNearUpwardRay(locator_.surface(), Center(q), radius_ - kRimDepth, 0.1 * kRimDepth)) {
    q = start + reach * direction;
  }
  return {q, contact, std::nullopt};
}

std::optional<LevelPoint> LevelOracle::RootOnLine(const Vec2& m, const Vec2& direction, const SurfacePoint& a,
                                                  const SurfacePoint& b, double reach) const {
  // Inside a disc of the two: outward from m. Else from the first rim behind m; the walk passes m again if it
  // lies in some third disc.
  double back = kInfinity;
  const SurfacePoint* hit = nullptr;
  for (const SurfacePoint* k : {&a, &b}) {
    const Vec2 d = m - Plan(k->p);
    const double along = d.dot(direction), rho = Rho(k->p), outside = d.squaredNorm() - rho * rho;
    if (outside < 0.0) {
      back = 0.0;
      hit = k;
      break;
    }
    const double square = along * along - outside;
    if (along <= 0.0 || square <= 0.0) continue;
    const double t = std::max(0.0, along - std::sqrt(square));
    if (t < back) {
      back = t;
      hit = k;
    }
  }
  SurfacePoint start;
  if (hit != nullptr && back <= reach) {
    start = *hit;
  } else {
    const std::optional<CenterPoint> h = locator_.Height(m, &a);
    if (!Forbidden(h)) return std::nullopt;
    start = h->contact;
    back = 0.0;
  }
  LevelPoint root = Exit(m - back * direction, start, direction, back + reach);
  if ((root.q - m).norm() >= reach * (1.0 - 1e-12)) return std::nullopt;
  return root;
}

std::optional<LevelPoint> LevelOracle::Corner(const LevelPoint& a, const LevelPoint& b, double reach) const {
  const Vec2 middle = 0.5 * (a.q + b.q);
  SurfacePoint ka = a.contact, kb = b.contact;
  Vec2 q = middle;
  for (int step = 0; step < 30; ++step) {
    const Vec2 pa = Plan(ka.p), pb = Plan(kb.p), apart = pb - pa;
    const double ra = Rho(ka.p), rb = Rho(kb.p), d2 = apart.squaredNorm();
    if (d2 < 1e-12 * radius_ * radius_) return std::nullopt;
    const double along = 0.5 * (1.0 + (ra * ra - rb * rb) / d2);
    const double square = ra * ra / d2 - along * along;
    if (square < 0.0) return std::nullopt;
    const Vec2 base = pa + along * apart, up = std::sqrt(square) * Vec2(-apart.y(), apart.x());
    const Vec2 next =
        (base + up - q).squaredNorm() <= (base - up - q).squaredNorm() ? Vec2(base + up) : Vec2(base - up);
    const double moved = (next - q).norm();
    q = next;
    if ((q - middle).norm() > reach) return std::nullopt;
    if (step > 0 && moved < 1e-12 * (1.0 + radius_)) break;
    const std::optional<CenterPoint> na = locator_.Follow(ka, q), nb = locator_.Follow(kb, q);
    if (!na || !nb) return std::nullopt;
    ka = na->contact;
    kb = nb->contact;
  }
  if ((ka.p - kb.p).norm() < 1e-6 * radius_) return std::nullopt;
  const std::optional<CenterPoint> h = locator_.Height(q, &ka);
  if (h && h->z > z_ + kHeightSlack) {
    // A third contact, or the rim of a vertical wall (where h jumps): then a hair outward is free.
    const Vec2 out = ((q - Plan(ka.p)).normalized() + (q - Plan(kb.p)).normalized());
    if (out.norm() < 0.1) return std::nullopt;
    const Vec2 free = q + (4.0 * kStill / out.norm()) * out;
    const std::optional<CenterPoint> beside = locator_.Height(free, &ka);
    if (beside && beside->z > z_ + kHeightSlack) return std::nullopt;
    q = free;
  }
  return LevelPoint{q, ka, kb};
}

}  // namespace patchmill
