#include "core/curve/fitted_tangents.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/curve/hosaka_fit.h"

namespace patchmill {
namespace {

double AngleBetween(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

EdgeTangents Lengthened(const EdgeDirections& ends, const HosakaFit& fit) {
  return {fit.b * ends.u1, fit.c * ends.u2};
}

// Rotation into the own axes of the segment with these directions.
absl::StatusOr<Eigen::Matrix3d> AxesOf(const EdgeDirections& ends) {
  return HosakaAxes({ends.p1, ends.p2 - ends.p1, ends.u1, -ends.u2, {}});
}

}  // namespace

absl::StatusOr<EdgeTangents> ArcTangents(const EdgeDirections& ends) {
  const Vec3 chord = ends.p2 - ends.p1;
  const double length = chord.norm();
  if (!(length > 0.0)) return absl::InvalidArgumentError("the ends of the edge are the same point");
  const double turn = AngleBetween(chord, ends.u1) + AngleBetween(-chord, ends.u2);
  if (!(turn < 2.0 * std::numbers::pi - 1e-6)) {
    return absl::InvalidArgumentError("both end directions point away from the other end; no arc leaves so");
  }
  // The ratio of length and chord tends to 1 as the angle tends to 0.
  const double t = turn > 1e-6 ? ArcTangentLength(length, turn) : length;
  return EdgeTangents{t * ends.u1, t * ends.u2};
}

absl::StatusOr<EdgeTangents> TangentsThroughPoint(const EdgeDirections& ends, const Vec3& point) {
  PM_ASSIGN_OR_RETURN(const Eigen::Matrix3d axes, AxesOf(ends));
  PM_ASSIGN_OR_RETURN(const HosakaFit fit, FitThroughPoint((ends.p2 - ends.p1).norm(), axes * ends.u1,
                                                           -(axes * ends.u2), axes * (point - ends.p1)));
  return Lengthened(ends, fit);
}

absl::StatusOr<EdgeTangents> TangentsWithPeak(const EdgeDirections& ends, const Vec3& peak) {
  PM_ASSIGN_OR_RETURN(const Eigen::Matrix3d axes, AxesOf(ends));
  const Vec3 q = axes * (peak - ends.p1);
  PM_ASSIGN_OR_RETURN(const HosakaFit fit,
                      FitPeak((ends.p2 - ends.p1).norm(), axes * ends.u1, -(axes * ends.u2), q.y(), q.z()));
  return Lengthened(ends, fit);
}

absl::StatusOr<EdgeTangents> TangentsWithSlope(const EdgeDirections& ends, const Vec3& point,
                                               const std::optional<Vec3>& direction) {
  const Vec3 chord = ends.p2 - ends.p1, q = point - ends.p1;
  const double length = chord.norm();
  const Vec3 x = chord.normalized(), by_first = x.cross(ends.u1), by_last = x.cross(ends.u2);
  const Vec3 normal = by_first.norm() >= by_last.norm() ? by_first : by_last;
  if (!(normal.norm() > 1e-9)) {
    return absl::InvalidArgumentError("both end tangents lie along the chord; their plane is undefined");
  }
  const Vec3 z = normal.normalized(), y = z.cross(x);
  const Vec3 along = direction ? direction->normalized() : x;
  const double out = std::max({std::abs(z.dot(ends.u1)), std::abs(z.dot(ends.u2)), std::abs(z.dot(along)),
                               std::abs(z.dot(q)) / length});
  if (!(out <= kMaxOutOfPlane)) {
    return absl::InvalidArgumentError(fmt::format(
        "is one of plane curves; end tangents, point, slope and chord leave their plane by {:.3g} of "
        "the chord; at most {:g}",
        out, kMaxOutOfPlane));
  }
  const auto angle = [&](const Vec3& v) { return std::atan2(v.dot(y), v.dot(x)); };
  PM_ASSIGN_OR_RETURN(const std::vector<HosakaFit> fits, FitSlope(length, angle(ends.u1), angle(-ends.u2),
                                                                  Vec2(q.dot(x), q.dot(y)), angle(along)));
  if (fits.empty()) {
    return absl::InvalidArgumentError(
        "no segment with these end directions passes the point with that slope");
  }
  return Lengthened(
      ends, *std::ranges::min_element(fits, {}, [](const HosakaFit& fit) { return std::max(fit.b, fit.c); }));
}

HosakaSegment LedThrough(const HermiteCurve& curve, double t, const Vec3& point,
                         const std::optional<Vec3>& derivative) {
  HosakaSegment segment{curve.p0, curve.p1 - curve.p0, curve.d0, curve.d1, {}};
  const CurveJet without = Evaluate(segment, t);
  if (!derivative) {
    const double w = t * t * (t - 1.0) * (t - 1.0);
    segment.extra = {(point - without.p) / w};
    return segment;
  }
  segment.extra.assign(2, Vec3::Zero());
  for (int k = 0; k < 3; ++k) {
    const ExtraTerm term = FitExtraTerm(t, point[k], (*derivative)[k], without.p[k], without.d[k]);
    segment.extra[0][k] = term.d0;
    segment.extra[1][k] = term.d1;
  }
  return segment;
}

}  // namespace patchmill
