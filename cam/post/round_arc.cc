#include "cam/post/round_arc.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

constexpr int kNear = 3;             // units: centres that far from the exact one are tried
constexpr double kLeastChord = 8.0;  // units, between different ends
constexpr double kTurnSlack = 0.05;  // rad: by how much rounding may change the sweep

Vec3 Place(const Ticks& ticks, double unit) {
  return unit *
         Vec3(static_cast<double>(ticks[0]), static_cast<double>(ticks[1]), static_cast<double>(ticks[2]));
}

}  // namespace

std::optional<Ticks> RoundedCenter(const ExactArc& exact, const Ticks& from, const Ticks& to, double unit) {
  const ArcPlane plane = exact.arc.plane;
  const double sweep = Sweep(exact.arc, exact.ends);
  const Vec3 start = Place(from, unit);
  const Vec2 exact_start = Xy(ToPlane(plane, exact.ends.from)), exact_end = Xy(ToPlane(plane, exact.ends.to));
  // From here on the start is the origin.
  const Vec2 chord = Xy(ToPlane(plane, Place({to[0] - from[0], to[1] - from[1], to[2] - from[2]}, unit)));
  const bool full = chord.isZero(), exact_full = (exact_end - exact_start).norm() < 1e-6;
  if (full != exact_full || (!full && chord.norm() < kLeastChord * unit)) return std::nullopt;
  Vec2 center = exact.arc.center - Xy(ToPlane(plane, start));
  Vec2 middle = Vec2::Zero();  // of the arc: the rounded one is to go through it; not of a full circle
  if (!full) {
    const Vec2 way = (exact_end - exact_start).normalized(), left(-way.y(), way.x());
    const double rise = (exact.arc.center - 0.5 * (exact_start + exact_end)).dot(left);
    const double radius = (exact_start - exact.arc.center).norm();
    const double height = exact.arc.clockwise ? rise + radius : rise - radius;
    const Vec2 to_left = Vec2(-chord.y(), chord.x()).normalized();
    center = 0.5 * chord + (height * height - 0.25 * chord.squaredNorm()) / (2.0 * height) * to_left;
    middle = 0.5 * chord + height * to_left;
  }
  const double i0 = std::round(center.x() / unit), j0 = std::round(center.y() / unit);
  double least = kInfinity;
  Vec2 best = Vec2::Zero();
  for (int i = -kNear; i <= kNear; ++i) {
    for (int j = -kNear; j <= kNear; ++j) {
      const Vec2 tried = unit * Vec2(i0 + i, j0 + j);
      const double r0 = tried.norm(), r1 = (chord - tried).norm(), difference = std::abs(r0 - r1);
      const double beside =
          full ? (tried - center).norm() : std::abs((middle - tried).norm() - 0.5 * (r0 + r1));
      const bool accepted = difference <= kEndRadiusSlack &&
                            difference <= kRelativeEndRadiusSlack * std::min(r0, r1) &&
                            difference <= 0.5 * unit && (full ? beside <= unit : beside <= 0.5 * unit);
      if (!accepted || !(difference + beside < least)) continue;
      least = difference + beside;
      best = Vec2(i0 + i, j0 + j);
    }
  }
  if (!(least < kInfinity)) return std::nullopt;
  const Arc rounded{plane, unit * best, exact.arc.clockwise};
  const double turned = Sweep(rounded, {Vec3::Zero(), FromPlane(plane, Lift(chord, 0.0))});
  if (!full && !(std::abs(turned - sweep) <= kTurnSlack)) return std::nullopt;
  const Vec3 offset = FromPlane(plane, Lift(best, 0.0));
  return Ticks{std::llround(offset.x()), std::llround(offset.y()), std::llround(offset.z())};
}

}  // namespace patchmill
