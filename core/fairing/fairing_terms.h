// What may move in fairing, how far, and when it ends: the same for curves and nets [fairing, section 4].
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include <absl/status/status.h>

#include "core/base/vec.h"

namespace patchmill {

inline constexpr int kMaxFairingPoints = 100'000;
inline constexpr int kMaxFairingIterations = 10'000;
// Curvature times the diagonal of the points' box below which a sign counts as none.
inline constexpr double kCurvatureSignEps = 1e-9;
// Neighbours nearer than this share of the diagonal are one point.
inline constexpr double kCoincidentShare = 1e-12;
// Relative fall of the energy below which kSignsAndEnergy is content.
inline constexpr double kSettledEnergyDrop = 1e-3;

using Axes = std::array<bool, 3>;  // x, y, z

// A point whose components stay as given, bit by bit.
struct PointLock {
  int point = 0;  // 0-based index of the given points
  Axes axes{true, true, true};
};

enum class FairingStop {
  kIterations,      // after max_iterations
  kSigns,           // when no curvature of a projection changed its sign in the last iteration
  kSignsAndEnergy,  // when besides the energy fell by less than kSettledEnergyDrop of itself
};

// How a band is kept.
enum class BandRule {
  kLeastEnergy,  // the least energy that the bands allow: [fairing (8)] within a box
  kCut,  // the paper's: the least energy without bands, then each component cut back to its band. Kinks
         // where bands are narrow, and then often ends early, see FairedCurve::settled
};

struct FairingTerms {
  Axes axes{true, true, true};            // components that may move at all
  Vec3 band = Vec3::Constant(kInfinity);  // >= 0: the most that a component may leave its given value
  std::vector<PointLock> locks;           // ends (of a net: its border) are always locked
  BandRule band_rule = BandRule::kLeastEnergy;
  int max_iterations = 50;                 // [0, kMaxFairingIterations]; 0: only the fit through the points
  FairingStop stop = FairingStop::kSigns;  // never before the first iteration
};

// FieldError with path, value and constraint for points that are not finite or whose number is not in
// [min_count, kMaxFairingPoints], and for terms out of their ranges.
absl::Status CheckFairing(const std::vector<Vec3>& points, int min_count, const FairingTerms& terms);

// Signs -1, 0, 1 of curvatures, see kCurvatureSignEps.
using CurvatureSigns = std::vector<std::array<signed char, 3>>;
CurvatureSigns SignsOf(const std::vector<Vec3>& curvatures, double diagonal);

// Whether the stop rule holds after an iteration that led from one state to the next.
bool Settled(FairingStop stop, const CurvatureSigns& last, const CurvatureSigns& now, double last_energy,
             double energy);

// An iteration that would raise the energy goes half the way instead, and half of that again, so many times.
inline constexpr int kMaxHalvings = 10;

double Diagonal(const std::vector<Vec3>& points);

}  // namespace patchmill
