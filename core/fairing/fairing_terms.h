// What fairing may move, how far, and when it ends. The same for curves and nets [fairing, section 4].
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
// A curvature, multiplied by the diagonal of the points' box, has the sign 0 if it is at most this.
inline constexpr double kCurvatureSignEps = 1e-9;
// Neighbours that are at most this share of the diagonal apart are one point.
inline constexpr double kCoincidentShare = 1e-12;
// kSignsAndEnergy ends when the energy falls by no more than this share.
inline constexpr double kSettledEnergyDrop = 1e-3;

using Axes = std::array<bool, 3>;  // x, y, z

// A point whose marked components stay as given, bit by bit.
struct PointLock {
  int point = 0;  // 0-based index of the given points
  Axes axes{true, true, true};
};

enum class FairingStop {
  kIterations,      // after max_iterations
  kSigns,           // when no curvature of a projection changed its sign in the last iteration
  kSignsAndEnergy,  // when, in addition, the energy fell by at most kSettledEnergyDrop of itself
};

// How a band is kept.
enum class BandRule {
  kLeastEnergy,  // the least energy that the bands allow: [fairing (8)] within a box
  kCut,  // the rule of the paper: find the least energy without bands, then cut each component back to its
         // band. It leaves kinks where bands are narrow, and then often ends early (see FairedCurve::settled)
};

struct FairingTerms {
  Axes axes{true, true, true};            // components that may move at all
  Vec3 band = Vec3::Constant(kInfinity);  // >= 0: how far a component may move from its given value
  std::vector<PointLock> locks;           // the ends of a curve and the border of a net are always locked
  BandRule band_rule = BandRule::kLeastEnergy;
  int max_iterations = 50;                 // [0, kMaxFairingIterations]; 0 gives only the fit through the
                                           // points
  FairingStop stop = FairingStop::kSigns;  // never before the first iteration
};

// Returns a FieldError with path, value and constraint if a point is not finite, if the number of points is
// not in [min_count, kMaxFairingPoints], or if a term is out of its range.
absl::Status CheckFairing(const std::vector<Vec3>& points, int min_count, const FairingTerms& terms);

// The signs -1, 0, 1 of curvatures; see kCurvatureSignEps.
using CurvatureSigns = std::vector<std::array<signed char, 3>>;
CurvatureSigns SignsOf(const std::vector<Vec3>& curvatures, double diagonal);

// True if the stop rule holds after an iteration that led from the state `last` to the state `now`.
bool Settled(FairingStop stop, const CurvatureSigns& last, const CurvatureSigns& now, double last_energy,
             double energy);

// An iteration that would raise the energy goes half of the way instead, and half of that again, so many
// times.
inline constexpr int kMaxHalvings = 10;

double Diagonal(const std::vector<Vec3>& points);

}  // namespace patchmill
