#include "cam/toolpath/arc.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

constexpr double kNoTurn = 1e-10;  // rad; a smaller turn means a full circle

Eigen::Index FirstAxis(ArcPlane plane) {
  switch (plane) {
    case ArcPlane::kXy:
      return 0;
    case ArcPlane::kZx:
      return 2;
    case ArcPlane::kYz:
      return 1;
  }
  return 0;
}

}  // namespace

Vec3 ToPlane(ArcPlane plane, const Vec3& p) {
  const Eigen::Index k = FirstAxis(plane);
  return {p[k], p[(k + 1) % 3], p[(k + 2) % 3]};
}

Vec3 FromPlane(ArcPlane plane, const Vec3& p) {
  const Eigen::Index k = FirstAxis(plane);
  Vec3 q;
  q[k] = p.x();
  q[(k + 1) % 3] = p.y();
  q[(k + 2) % 3] = p.z();
  return q;
}

double Sweep(const Arc& arc, const ArcEnds& ends) {
  const Vec2 a = Xy(ToPlane(arc.plane, ends.from)) - arc.center;
  const Vec2 b = Xy(ToPlane(arc.plane, ends.to)) - arc.center;
  const double turn = std::atan2(Cross(a, b), a.dot(b)), sweep = arc.clockwise ? -turn : turn;
  return sweep < kNoTurn ? sweep + 2.0 * kPi : sweep;
}

double ArcLength(const Arc& arc, const ArcEnds& ends) {
  const Vec3 from = ToPlane(arc.plane, ends.from), to = ToPlane(arc.plane, ends.to);
  const double radius = 0.5 * ((Xy(from) - arc.center).norm() + (Xy(to) - arc.center).norm());
  return std::hypot(Sweep(arc, ends) * radius, to.z() - from.z());
}

Vec3 PlaceOn(const Arc& arc, const ArcEnds& ends, double t) {
  if (t <= 0.0) return ends.from;
  if (t >= 1.0) return ends.to;
  const Vec3 from = ToPlane(arc.plane, ends.from), to = ToPlane(arc.plane, ends.to);
  const Vec2 a = Xy(from) - arc.center, b = Xy(to) - arc.center;
  const double turn = (arc.clockwise ? -t : t) * Sweep(arc, ends);
  const double radius = (1.0 - t) * a.norm() + t * b.norm();
  const Vec2 out = a.normalized();
  const Vec2 at(std::cos(turn) * out.x() - std::sin(turn) * out.y(),
                std::sin(turn) * out.x() + std::cos(turn) * out.y());
  return FromPlane(arc.plane, Lift(arc.center + radius * at, (1.0 - t) * from.z() + t * to.z()));
}

std::vector<Vec3> ChordEnds(const Arc& arc, const ArcEnds& ends, double sagitta) {
  const double radius = std::max((Xy(ToPlane(arc.plane, ends.from)) - arc.center).norm(),
                                 (Xy(ToPlane(arc.plane, ends.to)) - arc.center).norm());
  // A chord over the angle s deviates by r (1 - cos(s / 2)), which is at most r s^2 / 8.
  const double count = std::max(1.0, std::ceil(Sweep(arc, ends) * std::sqrt(radius / (8.0 * sagitta))));
  std::vector<Vec3> places;
  for (double k = 1.0; k < count; k += 1.0) places.push_back(PlaceOn(arc, ends, k / count));
  places.push_back(ends.to);
  return places;
}

std::vector<Vec3> TurningPlaces(const Arc& arc, const ArcEnds& ends) {
  const Vec2 a = Xy(ToPlane(arc.plane, ends.from)) - arc.center;
  const double begin = std::atan2(a.y(), a.x()), sweep = Sweep(arc, ends);
  std::vector<Vec3> places;
  for (int quarter = 0; quarter < 4; ++quarter) {
    double turn = 0.5 * kPi * quarter - begin;
    if (arc.clockwise) turn = -turn;
    turn = std::fmod(turn + 4.0 * kPi, 2.0 * kPi);
    if (turn > 0.0 && turn < sweep) places.push_back(PlaceOn(arc, ends, turn / sweep));
  }
  return places;
}

}  // namespace patchmill
