// Fairing of a measured curve as an elastic beam [fairing].
//
// An iteration has three steps: tangents of least energy for fixed points [fairing (7)]; points of least
// energy within the bands for fixed tangents, axis by axis [fairing (8)]; new chords and end tangents. More
// iterations approach the uniform batten through the locked points. The energy with the new chords may be
// higher than the energy with the frozen ones. An iteration that would raise the energy goes a part of the
// way only. If no part of the way lowers it, the iterations end.
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/fairing/beam.h"
#include "core/fairing/fairing_terms.h"

namespace patchmill {

struct CurveFairing {
  std::vector<Vec3> points;  // in order along the curve, 2 to kMaxFairingPoints; best well spaced
  FairingTerms terms;
  std::optional<Vec3> start_direction, end_direction;  // in the direction of increasing index; any length > 0
};

struct FairedCurve {
  Beam before, after;            // the fit through the given points; the faired curve
  std::vector<int> node;         // of each given point; neighbours that coincide share a node and its locks
  std::vector<double> energies;  // V of the fit, then V after each iteration; strictly decreasing
  bool settled = false;          // ended by the stop rule, or because nothing lowers V; not by max_iterations
  std::vector<Vec3> moved;       // new minus given place of each point; |component| <= band up to rounding
  long long rows = 0;            // number of eliminated equations, the measure of the cost

  int iterations() const { return static_cast<int>(energies.size()) - 1; }
};

// Cost O(n) per iteration: 4 n rows where no band holds, at most (3 kMaxBoxSolves + 1 + kMaxHalvings) n.
// Errors: INVALID_ARGUMENT with a field path (see CheckFairing; also if all points coincide or a direction
// has length 0), and those of `run`.
absl::StatusOr<FairedCurve> FairCurve(const CurveFairing& curve, const RunContext& run = {});

}  // namespace patchmill
