#include "cam/path/zlevel/level_oracle.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

// mm: shorter exits, and shorter steps of the contact, do not count. A place is known to about the square of
// the contact's last step.
constexpr double kMinExitLength = 1e-10;
constexpr double kMinContactStep = 1e-6;
// mm: h may exceed c by this much at a border point (rounding of the contact, not of the method).
constexpr double kHeightSlack = 1e-9;
// mm: largest move of a border point out of a disc's rim at a vertical wall, where h jumps. kVertical is the
// cosine of the slope from which on a wall counts as vertical: there rounding in plan moves h.
constexpr double kLargestNudge = 8e-10;
constexpr double kVertical = 1e-4;
constexpr int kMostSlides = 60;     // steps on one branch
constexpr int kMostCrossings = 16;  // of sides, on one branch
constexpr int kMostBranches = 60;   // along one straight way

}  // namespace

double LevelOracle::ForbiddenRadius(const Vec3& p) const {
  const double below = std::max(0.0, z_ - p.z());
  const double square = radius_ * radius_ - below * below;
  return square > 0.0 ? std::sqrt(square) : 0.0;
}

double LevelOracle::Excess(const Vec2& q, const Vec3& contact) const {
  return std::hypot(q.x() - contact.x(), q.y() - contact.y(), std::max(0.0, z_ - contact.z())) - radius_;
}

double LevelOracle::ExitLength(const Vec2& q, const Vec3& contact, const Vec2& direction) const {
  const Vec2 d = q - Xy(contact);
  const double rho = ForbiddenRadius(contact);
  const double b = d.dot(direction), c = d.squaredNorm() - rho * rho;
  if (c >= 0.0) return 0.0;
  const double root = std::sqrt(b * b - c);
  return b > 0.0 ? -c / (b + root) : root - b;
}

std::optional<SurfacePoint> LevelOracle::Obstacle(const Vec2& q, const SurfacePoint* hint) const {
  if (hint != nullptr) {
    const SurfacePoint near = DeepestOnBranch(*hint, q);
    if (Excess(q, near.p) < -kMinExitLength) return near;
  }
  if (locator_.Free(Center(q))) return std::nullopt;
  const std::optional<CenterPoint> h = locator_.Height(q, hint);
  if (!h || h->z <= z_) return std::nullopt;
  return h->contact;
}

std::optional<SurfacePoint> LevelOracle::Beyond(const RaySlide& slide) const {
  const int side = slide.held_by();
  if (side < 0) return std::nullopt;
  return sides_.Across(slide.at().piece, side, side % 2 == 0 ? slide.at().u : slide.at().v);
}

SurfacePoint LevelOracle::DeepestOnBranch(const SurfacePoint& from, const Vec2& q) const {
  Way way{q, Vec2::Zero()};
  return LeaveBranch(way, from, kInfinity);
}

SurfacePoint LevelOracle::LeaveBranch(Way& way, const SurfacePoint& from, double reach) const {
  RaySlide slide(locator_.surface(), from);
  const auto step = [&](RaySlide& on) {
    const double moved = on.Step(Center(way.At()));
    const double exit = way.direction == Vec2::Zero() ? 0.0 : ExitLength(way.At(), on.at().p, way.direction);
    way.gone += exit;
    return moved >= kMinContactStep || exit >= 0.1 * kMinExitLength;
  };
  int crossings = 0;
  for (int k = 0; k < kMostSlides && way.gone < reach; ++k) {
    if (step(slide)) continue;
    const std::optional<SurfacePoint> next = Beyond(slide);
    if (!next || ++crossings > kMostCrossings) break;
    RaySlide across(locator_.surface(), *next);
    if (!step(across)) break;
    slide = across;
  }
  return slide.at();
}

LevelPoint LevelOracle::Exit(const Vec2& start, const SurfacePoint& contact, const Vec2& direction,
                             double reach) const {
  Way way{start, direction};
  SurfacePoint at = contact;
  double nudge = kMinExitLength;
  for (int branch = 0; branch < kMostBranches; ++branch) {
    at = LeaveBranch(way, at, reach);
    if (way.gone >= reach) return {start + reach * direction, at, std::nullopt};
    if (nudge == kMinExitLength && z_ - at.p.z() < kVertical * radius_) {
      // The step makes sure that rounding does not decide on which side the point lies.
      way.gone += nudge;
      nudge *= 2.0;
    }
    if (locator_.Free(Center(way.At()), kHeightSlack)) return {way.At(), at, std::nullopt};
    const std::optional<CenterPoint> h = locator_.Height(way.At(), &at);
    if (!h || h->z <= z_ + kHeightSlack) return {way.At(), at, std::nullopt};
    const double before = way.gone;
    const SurfacePoint last = at;
    at = LeaveBranch(way, h->contact, reach);
    if (way.gone - before >= kMinExitLength) continue;
    // Rounding decides on which side of the rim the point lies.
    if (nudge > kLargestNudge) return {way.At(), last, std::nullopt};
    way.gone += nudge;
    nudge *= 2.0;
  }
  // The walk found no end. The place it reached is taken if it is free within the slack, else the far end,
  // which is free.
  if (!locator_.Free(Center(way.At()), kHeightSlack)) way.gone = reach;
  return {way.At(), at, std::nullopt};
}

std::optional<LevelPoint> LevelOracle::RootOnLine(const Vec2& m, const Vec2& direction, const SurfacePoint& a,
                                                  const SurfacePoint& b, const Stretch& stretch) const {
  // Inside a disc of one of the two contacts the walk goes outward from m. Else it starts at the first rim
  // behind m; it passes m again if m lies in some third disc.
  double back = kInfinity;
  const SurfacePoint* hit = nullptr;
  for (const SurfacePoint* k : {&a, &b}) {
    const Vec2 d = m - Xy(k->p);
    const double along = d.dot(direction), rho = ForbiddenRadius(k->p), outside = d.squaredNorm() - rho * rho;
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
  if (hit != nullptr && back <= stretch.back) {
    start = *hit;
  } else {
    back = 0.0;
    std::optional<SurfacePoint> obstacle = Obstacle(m, &a);
    if (!obstacle && stretch.crossed) {
      back = stretch.back;
      obstacle = Obstacle(m - back * direction, &a);
    }
    if (!obstacle) return std::nullopt;
    start = *obstacle;
  }
  const double reach = back + stretch.front;
  const Vec2 from = m - back * direction;
  LevelPoint root = Exit(from, start, direction, reach);
  // The walk stopped at the end of the stretch, and nothing shows that this place is free.
  if ((root.q - from).norm() >= reach - kMinExitLength) return std::nullopt;
  return root;
}

std::optional<LevelPoint> LevelOracle::Corner(const LevelPoint& a, const LevelPoint& b, double reach) const {
  const Vec2 middle = 0.5 * (a.q + b.q);
  SurfacePoint ka = a.contact, kb = b.contact;
  Vec2 q = middle;
  for (int step = 0; step < 30; ++step) {
    const Vec2 pa = Xy(ka.p), pb = Xy(kb.p), apart = pb - pa;
    const double ra = ForbiddenRadius(ka.p), rb = ForbiddenRadius(kb.p), d2 = apart.squaredNorm();
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
    ka = DeepestOnBranch(ka, q);
    kb = DeepestOnBranch(kb, q);
  }
  if ((ka.p - kb.p).norm() < 1e-6 * radius_) return std::nullopt;
  if (!locator_.Free(Center(q), kHeightSlack)) {
    // A third contact covers the corner, or it is the rim of a vertical wall (where h jumps). At a wall a
    // place a hair outward is free.
    const Vec2 out = ((q - Xy(ka.p)).normalized() + (q - Xy(kb.p)).normalized());
    if (out.norm() < 0.1) return std::nullopt;
    const Vec2 free = q + (4.0 * kMinExitLength / out.norm()) * out;
    if (!locator_.Free(Center(free), kHeightSlack)) return std::nullopt;
    q = free;
  }
  return LevelPoint{q, ka, kb};
}

}  // namespace patchmill
