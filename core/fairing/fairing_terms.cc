#include "core/fairing/fairing_terms.h"

#include <cmath>

#include <fmt/format.h>

#include "core/base/error_details.h"

namespace patchmill {
namespace {

constexpr const char* kAxisNames[] = {"x", "y", "z"};

}  // namespace

absl::Status CheckFairing(const std::vector<Vec3>& points, int min_count, const FairingTerms& terms) {
  const auto count = static_cast<long long>(points.size());
  if (count < min_count || count > kMaxFairingPoints) {
    return FieldError("points", fmt::format("are {}; must be {} to {}", count, min_count, kMaxFairingPoints));
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) return FieldError(fmt::format("points[{}]", i), "is not finite");
  }
  for (int a = 0; a < 3; ++a) {
    if (!(terms.band[a] >= 0.0)) {
      return FieldError(fmt::format("band.{}_mm", kAxisNames[a]),
                        fmt::format("= {}; must be >= 0", terms.band[a]));
    }
  }
  for (std::size_t k = 0; k < terms.locks.size(); ++k) {
    const int point = terms.locks[k].point;
    if (point < 0 || point >= count) {
      return FieldError(fmt::format("locks[{}].point_index", k),
                        fmt::format("= {}; must be in [0, {}]", point, count - 1));
    }
  }
  if (terms.max_iterations < 0 || terms.max_iterations > kMaxFairingIterations) {
    return FieldError("max_iterations",
                      fmt::format("= {}; must be in [0, {}]", terms.max_iterations, kMaxFairingIterations));
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
