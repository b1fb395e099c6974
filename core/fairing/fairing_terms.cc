#include "core/fairing/fairing_terms.h"

#include <cmath>

#include <fmt/format.h>

#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr const char* kAxisNames[] = {"x", "y", "z"};

template <class... Args>
absl::Status Invalid(fmt::format_string<Args...> format, Args&&... args) {
  return absl::InvalidArgumentError(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace

absl::Status CheckFairing(const std::vector<Vec3>& points, int min_count, const FairingTerms& terms) {
  const auto count = static_cast<long long>(points.size());
  if (count < min_count || count > kMaxFairingPoints) {
    return Invalid("points: {} of them; must be {} to {}", count, min_count, kMaxFairingPoints);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) return Invalid("points[{}] is not finite", i);
  }
  for (int a = 0; a < 3; ++a) {
    if (!(terms.band[a] >= 0.0)) return Invalid("band.{} = {}; must be >= 0", kAxisNames[a], terms.band[a]);
  }
  for (std::size_t k = 0; k < terms.locks.size(); ++k) {
    const int point = terms.locks[k].point;
    if (point < 0 || point >= count) {
      return Invalid("locks[{}].point = {}; must be in [0, {}]", k, point, count - 1);
    }
  }
  if (terms.max_iterations < 0 || terms.max_iterations > kMaxFairingIterations) {
    return Invalid("max_iterations = {}; must be in [0, {}]", terms.max_iterations, kMaxFairingIterations);
  }
  return absl::OkStatus();
}

CurvatureSigns SignsOf(const std::vector<Vec3>& curvatures, double diagonal) {
  CurvatureSigns signs(curvatures.size());
  for (std::size_t i = 0; i < signs.size(); ++i) {
    for (int plane = 0; plane < 3; ++plane) {
      const double turn = curvatures[i][plane] * diagonal;
      signs[i][static_cast<std::size_t>(plane)] =
          static_cast<signed char>(std::abs(turn) <= kCurvatureSignEps ? 0 : (turn > 0.0 ? 1 : -1));
    }
  }
  return signs;
}

bool Settled(FairingStop stop, const CurvatureSigns& last, const CurvatureSigns& now, double last_energy,
             double energy) {
  if (stop == FairingStop::kIterations || last != now) return false;
  return stop == FairingStop::kSigns || last_energy - energy <= kSettledEnergyDrop * last_energy;
}

double Diagonal(const std::vector<Vec3>& points) {
  Box3 box;
  for (const Vec3& p : points) box.Add(p);
  return box.Diagonal();
}

}  // namespace patchmill
