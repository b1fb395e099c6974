// Fairing of a measured curve as an elastic beam [fairing].
//
// In turn: tangents of least energy for fixed points [fairing (7)], points of least energy for fixed tangents
// [fairing (8)] axis by axis within the bands, chords and end tangents anew. More iterations approach the
// uniform batten through what is locked. New chords may raise the energy that frozen ones saw fall; an
// iteration that would raise it goes a part of the way, and when no part helps the curve is as fair as it
// gets.
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/fairing/beam.h"
#include "core/fairing/fairing_terms.h"

namespace patchmill {

struct CurveFairing {
  std::vector<Vec3> points;  // in order along the curve, 2 to kMaxFairingPoints; well spaced is best
  FairingTerms terms;
  std::optional<Vec3> start_direction, end_direction;  // along increasing index; any length but 0
};

struct FairedCurve {
  Beam before, after;            // the fit through the given points, the faired curve
  std::vector<int> node;         // of each given point; neighbours that coincide share one, and their locks
  std::vector<double> energies;  // V of the fit, then after each iteration: falls strictly
  bool settled = false;          // ended by the stop rule or because nothing lowers V, not at max_iterations
  std::vector<Vec3> moved;       // after - given, by given point; |component| <= band up to one rounding
  long long rows = 0;            // equations eliminated, the measure of the cost

  int iterations() const { return static_cast<int>(energies.size()) - 1; }
};

// Cost O(n) per iteration: 4 n rows where no band holds, at most (3 kMaxBoxSolves + 1 + kMaxHalvings) n.
// Errors: INVALID_ARGUMENT with field path (see CheckFairing; all points coincide; a direction of length 0),
// those of `run`.
absl::StatusOr<FairedCurve> FairCurve(const CurveFairing& curve, const RunContext& run = {});

}  // namespace patchmill
