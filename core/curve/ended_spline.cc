#include "core/curve/ended_spline.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/curve/spline.h"

namespace patchmill {
namespace {

using Curves = std::vector<HermiteCurve>;

// Outside these limits the length of an end derivative is that of the circle.
constexpr double kLeastLength = 0.25, kMostLength = 4.0;
// Pull towards the circle's length, where the distance of the middle from the circle hardly depends on it.
constexpr double kPull = 0.02;
constexpr int kMostRounds = 100;

// An end with a direction: the unit direction along the spline; of the circular arc from the end to the other
// point of the end's span, the middle, the normal there, and the length that a cubic's
// end derivative has on it, as a share of the chord.
struct RoundEnd {
  Vec3 along = Vec3::Zero(), middle = Vec3::Zero(), normal = Vec3::Zero();
  double stretch = 1.0;
};

// `from` is the end, `leaving` the direction away from it, into the spline.
absl::StatusOr<RoundEnd> RoundFrom(const Vec3& from, const Vec3& to, const Vec3& leaving,
                                   std::string_view which) {
  const Vec3 chord = to - from, unit = chord.normalized();
  const double angle = std::atan2(unit.cross(leaving).norm(), unit.dot(leaving));
  if (!(angle <= kMaxEndAngle)) {
    return absl::InvalidArgumentError(
        fmt::format("{} direction is {:.3g} rad from the chord of the span there; must be at most {:g}",
                    which, angle, kMaxEndAngle));
  }
  RoundEnd end{leaving, 0.5 * (from + to), Vec3::Zero(), 1.0};
  if (angle < 1e-9) return end;
  end.normal = (leaving - unit * unit.dot(leaving)).normalized();
  end.middle += 0.5 * chord.norm() * std::tan(0.5 * angle) * end.normal;
  end.stretch = 1.0 / std::pow(std::cos(0.5 * angle), 2);
  return end;
}

Vec3 MiddleOf(const HermiteCurve& c) { return 0.5 * (c.p0 + c.p1) + 0.125 * (c.d0 - c.d1); }

// Solves splines through the same points with different ends.
class Solver {
 public:
  Solver(const std::vector<Vec3>& points, const std::array<std::optional<RoundEnd>, 2>& round)
      : points_(points), zeros_(points.size(), Vec3::Zero()), round_(round) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) spans_.push_back((points[i + 1] - points[i]).norm());
  }

  // The spline with given second derivatives where no direction is given.
  Curves Solve(const std::array<Vec3, 2>& second) const {
    const std::array<double, 2> length = Lengths(second);
    SplineEnds ends;
    for (const std::size_t e : {0, 1}) {
      (e == 0 ? ends.start_second : ends.end_second) = second[e];
      if (round_[e]) (e == 0 ? ends.start : ends.end) = Vec3(length[e] * round_[e]->along);
    }
    return SplineOver(points_, spans_, ends);
  }

 private:
  // The middles of both end spans depend linearly on the lengths of the end derivatives.
  std::array<double, 2> Lengths(const std::array<Vec3, 2>& second) const {
    const auto middles = [&](const Curves& c) { return std::array{MiddleOf(c.front()), MiddleOf(c.back())}; };
    const auto spline = [&](const std::vector<Vec3>& points, const std::array<Vec3, 2>& bend,
                            const std::array<double, 2>& length) {
      SplineEnds ends{{}, {}, bend[0], bend[1]};
      if (round_[0]) ends.start = Vec3(length[0] * round_[0]->along);
      if (round_[1]) ends.end = Vec3(length[1] * round_[1]->along);
      return middles(SplineOver(points, spans_, ends));
    };
    const std::array<Vec3, 2> none = {Vec3::Zero(), Vec3::Zero()};
    const auto rest = spline(points_, second, {0.0, 0.0});
    const std::array<std::array<Vec3, 2>, 2> effect = {spline(zeros_, none, {1.0, 0.0}),
                                                       spline(zeros_, none, {0.0, 1.0})};
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (const std::size_t at : {0, 1}) {
      const double span = at == 0 ? spans_.front() : spans_.back(), pull = std::pow(kPull * span, 2);
      normal(static_cast<int>(at), static_cast<int>(at)) += pull;
      if (!round_[at]) continue;
      right[static_cast<int>(at)] += pull * round_[at]->stretch;
      const Vec3& n = round_[at]->normal;
      const double missing = n.dot(round_[at]->middle - rest[at]);
      const Eigen::Vector2d x(n.dot(effect[0][at]), n.dot(effect[1][at]));
      right += missing * x;
      normal += x * x.transpose();
    }
    const Eigen::Vector2d found = normal.ldlt().solve(right);
    std::array<double, 2> lengths = {found[0], found[1]};
    for (const std::size_t e : {0, 1}) {
      if (!round_[e]) continue;
      const bool sound = lengths[e] >= kLeastLength && lengths[e] <= kMostLength;
      if (!sound) lengths[e] = round_[e]->stretch;
    }
    return lengths;
  }

  const std::vector<Vec3>& points_;
  const std::vector<Vec3> zeros_;
  const std::array<std::optional<RoundEnd>, 2>& round_;
  std::vector<double> spans_;
};

}  // namespace

absl::StatusOr<std::vector<HermiteCurve>> SplineWithEnds(const std::vector<Vec3>& points,
                                                         const SplineEnd& start, const SplineEnd& end) {
  auto natural = SplineThrough(points, false);  // checks the points
  if (!natural.ok()) return natural;
  const std::array<const SplineEnd*, 2> given = {&start, &end};
  std::array<std::optional<RoundEnd>, 2> round;
  bool bent = false;
  for (const std::size_t e : {0, 1}) {
    const char* which = e == 0 ? "start" : "end";
    const auto& [direction, curvature] = *given[e];
    if (direction && curvature) {
      return absl::InvalidArgumentError(
          fmt::format("{} has a direction and a curvature; give one of them", which));
    }
    if (curvature && !curvature->allFinite()) {
      return absl::InvalidArgumentError(fmt::format("{} curvature must be finite", which));
    }
    bent = bent || curvature.has_value();
    if (!direction) continue;
    if (!direction->allFinite() || !(direction->norm() > 0.0)) {
      return absl::InvalidArgumentError(fmt::format("{} direction must be finite and not zero", which));
    }
    const std::size_t n = points.size();
    const Vec3 unit = direction->normalized();
    PM_ASSIGN_OR_RETURN(round[e], e == 0 ? RoundFrom(points[0], points[1], unit, which)
                                         : RoundFrom(points[n - 1], points[n - 2], -unit, which));
    round[e]->along = unit;
  }
  const Solver solver(points, round);
  std::array<Vec3, 2> second = {Vec3::Zero(), Vec3::Zero()};
  // The second derivative is the curvature times the squared speed, which depends on the second derivative.
  for (int k = 0; k < kMostRounds; ++k) {
    const Curves curves = solver.Solve(second);
    if (!bent) return curves;
    double change = 0.0, size = 0.0;
    for (const std::size_t e : {0, 1}) {
      if (!given[e]->curvature) continue;
      const HermiteCurve& span = e == 0 ? curves.front() : curves.back();
      const Vec3 speed = (e == 0 ? span.d0 : span.d1) / (span.p1 - span.p0).norm();
      const Vec3& wanted = *given[e]->curvature;
      const Vec3 next = wanted * speed.squaredNorm() - speed * speed.dot(wanted);
      change = std::max(change, (next - second[e]).norm()), size = std::max(size, next.norm());
      second[e] = next;
    }
    if (!(size < kInfinity)) break;
    if (change <= 1e-13 * size) return solver.Solve(second);
  }
  return absl::InvalidArgumentError(
      "start or end curvature cannot be met by a spline through these points; take a smaller one or a "
      "direction");
}

}  // namespace patchmill
