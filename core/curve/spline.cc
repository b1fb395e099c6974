#include "core/curve/spline.h"

#include <fmt/format.h>

#include "core/base/status.h"

namespace patchmill {
namespace {

// below[i] x[i-1] + on[i] x[i] + above[i] x[i+1] = right[i]; diagonally dominant.
struct Rows {
  std::vector<double> below, on, above;
};

template <class Value>
std::vector<Value> Solve(const Rows& rows, std::vector<Value> right) {
  const std::size_t n = rows.on.size();
  std::vector<double> factor(n);
  double pivot = rows.on[0];
  right[0] = right[0] / pivot;
  for (std::size_t i = 1; i < n; ++i) {
    factor[i] = rows.above[i - 1] / pivot;
    pivot = rows.on[i] - rows.below[i] * factor[i];
    right[i] = (right[i] - rows.below[i] * right[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 0;) right[i] = right[i] - factor[i + 1] * right[i + 1];
  return right;
}

// Solves the rows of a closed chain, with the corners below[0] and above[n-1] [references:
// shermanmorrison1950].
std::vector<Vec3> SolveClosed(Rows rows, const std::vector<Vec3>& right) {
  const std::size_t n = rows.on.size();
  const double top = rows.below[0], bottom = rows.above[n - 1], gamma = -rows.on[0];
  rows.on[0] -= gamma;
  rows.on[n - 1] -= top * bottom / gamma;
  std::vector<double> u(n, 0.0);
  u[0] = gamma;
  u[n - 1] += bottom;
  const std::vector<double> z = Solve(rows, u);
  std::vector<Vec3> x = Solve(rows, right);
  const Vec3 share = (x[0] + top / gamma * x[n - 1]) / (1.0 + z[0] + top / gamma * z[n - 1]);
  for (std::size_t i = 0; i < n; ++i) x[i] -= z[i] * share;
  return x;
}

std::vector<HermiteCurve> Splined(const std::vector<Vec3>& points, const std::vector<double>& chord,
                                  bool closed, const SplineEnds& ends) {
  const std::size_t n = points.size(), spans = chord.size();
  const auto next = [n](std::size_t i) { return i + 1 == n ? 0 : i + 1; };
  // The unknowns are the derivatives m in the chord parameter. Equal second derivatives at point i:
  //   h1 m(i-1) + 2 (h0 + h1) m(i) + h0 m(i+1) = 3 (h1 slope(i-1) + h0 slope(i)),
  // where h0 and h1 are the chords before and after it.
  const auto slope = [&](std::size_t i) { return Vec3((points[next(i)] - points[i]) / chord[i]); };
  Rows rows{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  std::vector<Vec3> right(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (!closed && (i == 0 || i + 1 == n)) {
      const std::optional<Vec3>& given = i == 0 ? ends.start : ends.end;
      rows.on[i] = given ? 1.0 : 2.0;
      (i == 0 ? rows.above : rows.below)[i] = given ? 0.0 : 1.0;
      const Vec3 bend = i == 0 ? Vec3(-0.5 * chord.front() * ends.start_second)
                               : Vec3(0.5 * chord.back() * ends.end_second);
      right[i] = given ? *given : Vec3(3.0 * slope(i == 0 ? 0 : n - 2) + bend);
      continue;
    }
    const std::size_t before = i == 0 ? n - 1 : i - 1;
    const double h0 = chord[before], h1 = chord[i], sum = h0 + h1;
    rows.below[i] = h1 / sum;
    rows.on[i] = 2.0;
    rows.above[i] = h0 / sum;
    right[i] = 3.0 / sum * (h1 * slope(before) + h0 * slope(i));
  }
  const std::vector<Vec3> m = closed ? SolveClosed(rows, right) : Solve(rows, right);
  std::vector<HermiteCurve> curves;
  curves.reserve(spans);
  for (std::size_t i = 0; i < spans; ++i) {
    curves.push_back({points[i], chord[i] * m[i], points[next(i)], chord[i] * m[next(i)]});
  }
  return curves;
}

}  // namespace

absl::StatusOr<std::vector<HermiteCurve>> SplineThrough(const std::vector<Vec3>& points, bool closed,
                                                        const SplineEnds& ends) {
  const std::size_t n = points.size(), least = closed ? 3 : 2;
  if (n < least) {
    return absl::InvalidArgumentError(fmt::format("a {} spline through {} points; must have at least {}",
                                                  closed ? "closed" : "open", n, least));
  }
  const std::size_t spans = closed ? n : n - 1;
  const auto next = [n](std::size_t i) { return i + 1 == n ? 0 : i + 1; };
  std::vector<double> chord(spans);
  for (std::size_t i = 0; i < spans; ++i) {
    chord[i] = (points[next(i)] - points[i]).norm();
    if (!(chord[i] > 0.0 && chord[i] < kInfinity)) {
      return absl::InvalidArgumentError(fmt::format(
          "points {} and {} of a spline are {:g} apart; must be > 0 and finite", i, next(i), chord[i]));
    }
  }
  return Splined(points, chord, closed, ends);
}

std::vector<HermiteCurve> SplineOver(const std::vector<Vec3>& points, const std::vector<double>& spans,
                                     const SplineEnds& ends) {
  const bool closed = spans.size() == points.size();
  PM_CHECK(points.size() >= (closed ? 3 : 2) && (closed || spans.size() + 1 == points.size()));
  return Splined(points, spans, closed, ends);
}

}  // namespace patchmill
