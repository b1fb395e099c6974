#include "cam/post/arc_chords.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace patchmill {

namespace {

// The radii at both ends may differ by the slack, or by kRelativeRadiusSlack of the radius if that is more,
// but never by more than kMostSlacks times the slack.
constexpr double kRelativeRadiusSlack = 1e-3;  // of the radius
constexpr double kMostSlacks = 100.0;
constexpr double kRadiusSlack = 0.005;  // mm, of R words
constexpr double kFullCircle = 1e-10;   // rad; a smaller sweep means a full circle

}  // namespace

absl::StatusOr<ArcChords> ChordArc(const PlaneArc& arc, double chord_error, std::size_t max_chords) {
  const Vec2 start = Xy(arc.from) - arc.center, end = Xy(arc.to) - arc.center;
  const double r0 = start.norm(), r1 = end.norm();
  const double difference = std::abs(r1 - r0);
  if (!(std::min(r0, r1) > 1e-9)) return absl::InvalidArgumentError("arc of no radius");
  const double slack = std::min(std::max(arc.radius_slack, kRelativeRadiusSlack * std::max(r0, r1)),
                                kMostSlacks * arc.radius_slack);
  if (difference > slack) {
    return absl::InvalidArgumentError(
        fmt::format("arc radii {:.4f} mm at the start and {:.4f} mm at the end differ", r0, r1));
  }
  double sweep = std::atan2(Cross(start, end), start.dot(end));
  if (arc.clockwise) sweep = -sweep;
  if (sweep < kFullCircle) sweep += 2.0 * kPi;
  const double more_turns = std::max(0, arc.turns - 1);
  sweep += 2.0 * kPi * more_turns;
  // |chord - arc| <= r dtheta^2 / 8 if both are followed at the same rate.
  const double largest = std::max(r0, r1);
  const double chords =
      std::max(std::ceil(sweep * std::sqrt(largest / (8.0 * chord_error))), 4.0 * (more_turns + 1.0));
  if (!(chords <= static_cast<double>(max_chords))) {
    return absl::ResourceExhaustedError(
        fmt::format("arc needs {:.0f} chords; at most {} are left", chords, max_chords));
  }
  const auto count = static_cast<std::size_t>(chords);
  const double start_angle = std::atan2(start.y(), start.x());
  ArcChords result;
  result.points.reserve(count);
  for (std::size_t i = 1; i < count; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(count);
    const double angle = start_angle + (arc.clockwise ? -t : t) * sweep;
    const double r = r0 + t * (r1 - r0);
    result.points.push_back(Lift(arc.center + r * Vec2(std::cos(angle), std::sin(angle)),
                                 arc.from.z() + t * (arc.to.z() - arc.from.z())));
  }
  result.points.push_back(arc.to);
  const double step = sweep / static_cast<double>(count);
  result.chord_error = largest * step * step / 8.0 + difference;
  return result;
}

absl::StatusOr<Vec2> CenterFromRadius(const Vec2& from, const Vec2& to, double radius, bool clockwise) {
  const Vec2 chord = to - from;
  const double half = 0.5 * chord.norm();
  if (!(half > 0.0)) return absl::InvalidArgumentError("arc with R whose ends are equal");
  const double r = std::abs(radius);
  if (half > r + std::max(kRadiusSlack, kRelativeRadiusSlack * r)) {
    return absl::InvalidArgumentError(
        fmt::format("arc radius {:.4f} mm is less than half the distance of its ends, {:.4f} mm", r, half));
  }
  const double height = std::sqrt(std::max(0.0, r * r - half * half));
  const Vec2 left = Vec2(-chord.y(), chord.x()).normalized();
  // The centre of the shorter counter-clockwise arc lies left of the chord.
  const double side = clockwise == (radius > 0.0) ? -1.0 : 1.0;
  return from + 0.5 * chord + side * height * left;
}

}  // namespace patchmill
