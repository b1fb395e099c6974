#include "cam/region/figures/nearest_center.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <span>
#include <vector>

#include "cam/location/free_center.h"

namespace patchmill {
namespace {

constexpr double kHeightGap = 1e-3;                   // in R: gap to which heights are proven
constexpr double kSettledGap = 1e-5;                  // in R: the same in Settle
constexpr double kMinDescentStep = 1e-3;              // in R: a shorter step ends a descent
constexpr double kMinDistanceGain = 0.005;            // of a distance: smaller gains are not looked for
constexpr double kFirstStep = 0.1, kLastStep = 1e-5;  // in R: step sizes of Settle
constexpr int kMostLooks = 600;                       // heights in one call of Settle
constexpr int kSteps = 30;                            // of one descent
constexpr int kMisses = 2;              // steps of a descent that may fail in a row before steps are halved
constexpr int kRing = 16;               // directions of FromAround
constexpr int kMostBetween = 6;         // halvings between two columns of one direction
constexpr std::size_t kMostSpaces = 8;  // latest half-spaces of a descent; all triples of them are tried

// One column allows centres c with normal . c >= offset.
struct HalfSpace {
  Vec3 normal;
  double offset = 0.0;
};

double Outside(const HalfSpace& space, const Vec3& x) { return space.offset - space.normal.dot(x); }

// The point nearest to p on the planes of up to three half-spaces. nullopt if it is not the nearest point of
// their common part, because one of them does not hold it back.
std::optional<Vec3> Foot(std::span<const HalfSpace* const> active, const Vec3& p) {
  const auto n = static_cast<Eigen::Index>(active.size());
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> normals(3, n);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> lack(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    normals.col(i) = active[static_cast<std::size_t>(i)]->normal;
    lack[i] = Outside(*active[static_cast<std::size_t>(i)], p);
  }
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> gram = normals.transpose() * normals;
  if (gram.determinant() < 1e-9) return std::nullopt;
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> push = gram.inverse() * lack;
  if (push.minCoeff() < 0.0) return std::nullopt;
  return p + normals * push;
}

// The point nearest to p that lies in all half-spaces. nullopt if there is none or if rounding hides it.
std::optional<Vec3> NearestIn(std::span<const HalfSpace> spaces, const Vec3& p, double slack) {
  if (spaces.empty()) return p;
  const auto try_these = [&](std::initializer_list<const HalfSpace*> active) -> std::optional<Vec3> {
    const auto foot = Foot({active.begin(), active.size()}, p);
    const auto in = [&](const HalfSpace& space) { return Outside(space, *foot) <= slack; };
    return foot && std::all_of(spaces.begin(), spaces.end(), in) ? foot : std::nullopt;
  };
  for (const HalfSpace& a : spaces)
    if (const auto foot = try_these({&a})) return foot;
  for (std::size_t i = 0; i < spaces.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (const auto foot = try_these({&spaces[i], &spaces[j]})) return foot;
  for (std::size_t i = 0; i < spaces.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t k = 0; k < j; ++k)
        if (const auto foot = try_these({&spaces[i], &spaces[j], &spaces[k]})) return foot;
  return std::nullopt;
}

}  // namespace

Column NearestCenter::Descend(Column at) const {
  if (at.distance == kInfinity) return at;
  const double slack = kMinDescentStep * kMinDescentStep * locator_.radius();
  std::vector<HalfSpace> spaces;
  // Where the border of the free centres bends away from p, a half-space may exclude centres that are free
  // elsewhere. Such half-spaces are dropped.
  const auto excludes = [&](const HalfSpace& space) { return Outside(space, at.center) > slack; };
  const auto learn = [&](const Column& column) {
    if (column.held) {
      if (spaces.size() == kMostSpaces) spaces.erase(spaces.begin());
      spaces.push_back({column.normal, column.normal.dot(column.center)});
    }
    return std::erase_if(spaces, excludes) == 0 && column.held;
  };
  learn(at);
  double share = 1.0;
  int misses = 0;
  for (int i = 0; i < kSteps && at.distance > enough_; ++i) {
    const auto foot = NearestIn(spaces, p_, slack);
    if (!foot) break;
    const Vec2 step = share * Xy(*foot - at.center);
    if (step.norm() < kMinDescentStep * locator_.radius()) break;
    const Column next = At(Xy(at.center) + step, at);
    const bool nearer = next.distance < at.distance;
    if (nearer) at = next;
    const bool learned = learn(next);
    misses = nearer ? 0 : misses + 1;
    if (nearer) share = std::min(1.0, 2.0 * share);
    if (misses > 0 && (!learned || misses > kMisses)) share *= 0.5;
  }
  return at;
}

Column NearestCenter::Beside(const Vec3& normal, Column known) const {
  const double radius = locator_.radius();
  const auto center = FreeCenterNear(
      locator_, p_, normal,
      {.lowest_z = params_.floor_z + radius, .most = std::min(known.distance, 33.0 * radius) - radius});
  if (!center || (params_.operation_limits != nullptr && !params_.operation_limits->Allows(*center)))
    return known;
  const double distance = (*center - p_).norm();
  if (distance >= known.distance) return known;
  return {.center = *center, .normal = Vec3::UnitZ(), .held = false, .distance = distance};
}

Column NearestCenter::FromAround(Column known) const {
  const double farthest = 0.95 * std::min(known.distance, 33.0 * locator_.radius());
  const double nearest = 0.12 * std::min(known.distance, locator_.radius());
  std::vector<double> radii;
  for (double radius = farthest; radius > nearest; radius *= 0.75) radii.push_back(radius);
  std::array<Column, kRing> ring;  // the nearest of the columns in each direction
  for (int i = 0; i < kRing; ++i) {
    const double angle = 2.0 * kPi * i / kRing;
    const Vec2 way(std::cos(angle), std::sin(angle));
    Column& best = ring[static_cast<std::size_t>(i)];
    // No centre of a column is nearer to p than the column's radius.
    RingColumn inner;  // its radius is 0 if there is none
    for (auto radius = radii.rbegin(); radius != radii.rend() && *radius < best.distance; ++radius) {
      RingColumn outer{*radius, At(Xy(p_) + *radius * way, inner.column)};
      const bool drops = inner.radius > 0.0 && outer.column.distance < inner.column.distance;
      if (drops) outer.column = AlongRay(outer.column);
      if (outer.column.distance < best.distance) best = outer.column;
      if (inner.radius > 0.0) best = Between(way, inner, outer, kMostBetween, best);
      if (best.distance <= enough_) return best;
      inner = outer;
    }
  }
  for (std::size_t i = 0; i < kRing; ++i) {
    const double before = ring[(i + kRing - 1) % kRing].distance, after = ring[(i + 1) % kRing].distance;
    if (ring[i].distance == kInfinity || ring[i].distance > before || ring[i].distance >= after) continue;
    const Column found = Descend(ring[i]);
    if (found.distance < known.distance) known = found;
    if (known.distance <= enough_) return known;
  }
  return Polish(known);
}

Column NearestCenter::Settle(Column at) const {
  if (at.distance == kInfinity) return at;
  const double radius = locator_.radius();
  double step = kFirstStep * radius;
  for (int looks = 0; looks < kMostLooks && step > kLastStep * radius; looks += 8) {
    Column best = at;
    for (int k = 0; k < 8; ++k) {
      const double angle = 0.25 * kPi * k;
      const Column next =
          At(Xy(at.center) + step * Vec2(std::cos(angle), std::sin(angle)), at, kSettledGap * radius);
      if (next.distance < best.distance) best = next;
    }
    if (best.distance < at.distance) {
      at = best;
    } else {
      step *= 0.5;
    }
  }
  return at;
}

// Looks for a centre nearer than `best` between two columns in one direction from p, and returns the nearest.
// Right beside an overhang the ball drops, and no slope shows where. It assumes that no column in between is
// lower than the lower of the two.
Column NearestCenter::Between(const Vec2& way, const RingColumn& inner, const RingColumn& outer, int halvings,
                              Column best) const {
  const Column &a = inner.column, &b = outer.column;
  if (halvings == 0 || a.distance == kInfinity || b.distance == kInfinity) return best;
  if (best.distance <= enough_) return best;
  const double height = std::min(a.center.z(), b.center.z()) - p_.z();
  if (std::hypot(inner.radius, height) >= (1.0 - kMinDistanceGain) * best.distance) return best;
  RingColumn middle;
  middle.radius = 0.5 * (inner.radius + outer.radius);
  middle.column = At(Xy(p_) + middle.radius * way, a);
  if (middle.column.distance < best.distance) best = middle.column;
  best = Between(way, inner, middle, halvings - 1, best);
  return Between(way, middle, outer, halvings - 1, best);
}

// Turns the centre around p and descends again. This finds nearer centres along the foot of a vertical wall,
// where the half-spaces of columns give no direction along the wall.
Column NearestCenter::Polish(Column at) const {
  if (at.distance == kInfinity) return at;
  for (double turn = kPi / kRing; turn > 0.01; turn *= 0.5)
    for (const double angle : {turn, -turn}) {
      const Column turned = At(Xy(p_) + Eigen::Rotation2Dd(angle) * Xy(at.center - p_), at);
      if (turned.distance > (1.0 + kMinDescentStep) * at.distance) continue;
      const Column found = Descend(AlongRay(turned));
      if (found.distance < at.distance) at = found;
    }
  return at;
}

// Moves the centre along its direction from p as near as the limits of the operation allow. Limits have no
// slope that a descent could follow.
Column NearestCenter::AlongRay(Column at) const {
  if (at.distance == kInfinity || params_.operation_limits == nullptr ||
      params_.operation_limits->AllowsAll())
    return at;
  const Vec2 span = Xy(at.center - p_);
  double inner = 0.75, outer = 1.0;  // of the span; the column at `inner` is taken to be no nearer
  while (outer - inner > kMinDescentStep) {
    const double share = 0.5 * (inner + outer);
    const Column column = At(Xy(p_) + share * span, at);
    const bool nearer = column.distance < at.distance;
    if (nearer) at = column;
    (nearer ? outer : inner) = share;
  }
  return at;
}

Column NearestCenter::At(const Vec2& q, const Column& near, double gap) const {
  const double radius = locator_.radius();
  Column column;
  double low = params_.floor_z + radius;
  const auto allowed =
      params_.operation_limits != nullptr
          ? params_.operation_limits->HeightsOver(q, kHeightGap * radius, std::max(low, p_.z()))
          : std::optional(AllowedHeights());
  if (!allowed) return column;
  const auto height = locator_.Height(q, near.contact ? &*near.contact : nullptr, gap);
  if (height) column.contact = height->contact;
  if (allowed->lowest > low) {
    low = allowed->lowest;
    column.normal = allowed->normal;
  }
  if (height && height->z > low) {
    low = height->z;
    column.normal = (Lift(q, low) - height->contact.p) / radius;
  }
  column.center = Lift(q, std::max(low, p_.z()));
  column.held = low > p_.z();
  if (low > allowed->highest) {
    column.center.z() = low;  // the ball is too high, but its half-space leads to lower balls
    column.held = true;
    return column;
  }
  if (p_.z() > allowed->highest) {
    column.center.z() = allowed->highest;
    column.normal = -Vec3::UnitZ();
    column.held = true;
  }
  column.distance = (column.center - p_).norm();
  return column;
}

Column NearestCenter::At(const Vec2& q, const Column& near) const {
  return At(q, near, kHeightGap * locator_.radius());
}

}  // namespace patchmill
