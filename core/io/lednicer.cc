#include "core/io/lednicer.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace patchmill {
namespace {

// A nose bulges forward a little between its points: x may shrink by this share of the chord.
constexpr double kBackStep = 0.005;

// Whether x grows from `nose` on along the points [from, to).
bool GrowsFrom(const Vec3& nose, const std::vector<Vec3>& points, std::size_t from, std::size_t to) {
  double low = nose.x(), high = nose.x();
  for (const Vec3& p : points) low = std::min(low, p.x()), high = std::max(high, p.x());
  double before = nose.x();
  for (std::size_t k = from; k < to; ++k) {
    if (!(points[k].x() >= before - kBackStep * (high - low))) return false;
    before = points[k].x();
  }
  return high > low && from < to;
}

// A way to read the points: the upper side is [0, split), the lower one [split, end). The nose is the first
// point of one or of both.
struct Reading {
  std::size_t split = 0;
  bool nose_above = true, nose_below = true;
};

bool Fits(const Reading& reading, const std::vector<Vec3>& points) {
  const Vec3& nose = points[reading.nose_above ? 0 : reading.split];
  if (reading.nose_above && reading.nose_below && points[reading.split] != nose) return false;
  return GrowsFrom(nose, points, reading.nose_above ? 1 : 0, reading.split) &&
         GrowsFrom(nose, points, reading.split + (reading.nose_below ? 1 : 0), points.size());
}

}  // namespace

std::optional<LednicerCounts> CountsOf(const std::vector<Vec3>& rows, bool empty_line_after_first) {
  if (rows.size() < 3) return std::nullopt;
  const Vec3& first = rows.front();
  const auto count = [](double x) { return x >= 2.0 && x <= 1e6 && x == std::floor(x); };
  if (!count(first.x()) || !count(first.y())) return std::nullopt;
  const LednicerCounts counts{static_cast<std::size_t>(first.x()), static_cast<std::size_t>(first.y())};
  const std::size_t sum = counts.upper + counts.lower, points = rows.size() - 1;
  if (sum != points && sum != points + 1 && !empty_line_after_first) return std::nullopt;
  return counts;
}

absl::StatusOr<std::vector<Vec3>> JoinSides(const LednicerCounts& counts, const std::vector<Vec3>& points) {
  const std::size_t sum = counts.upper + counts.lower;
  if (sum != points.size() && sum != points.size() + 1) {
    return absl::InvalidArgumentError(fmt::format(
        "these look like the counts of Lednicer's form, but {} and {} points are announced and {} follow; "
        "correct the counts, or list the points in one run without them",
        counts.upper, counts.lower, points.size()));
  }
  std::vector<Reading> ways;
  if (sum == points.size()) {
    ways = {{counts.upper, true, true}};
  } else {
    ways = {{counts.upper, true, false}, {counts.upper - 1, false, true}};
  }
  std::erase_if(ways, [&](const Reading& way) { return !Fits(way, points); });
  if (ways.size() != 1) {
    return absl::InvalidArgumentError(fmt::format(
        "these look like the counts of Lednicer's form, but {} points from the nose to the tail and {} "
        "more are not found{}; list the points in one run without the counts",
        counts.upper, counts.lower,
        sum == points.size() ? ", each with the same first point" : ", with one row for the nose"));
  }
  const Reading& way = ways.front();
  std::vector<Vec3> run(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(way.split));
  std::ranges::reverse(run);
  const std::size_t lower = way.split + (way.nose_above && way.nose_below ? 1 : 0);
  run.insert(run.end(), points.begin() + static_cast<std::ptrdiff_t>(lower), points.end());
  return run;
}

}  // namespace patchmill
