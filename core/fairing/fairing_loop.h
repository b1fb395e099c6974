// The iteration of fairing, the same for curves and nets [fairing, section 4]. For use within this folder.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/error_details.h"
#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/fairing/box_minimum.h"
#include "core/fairing/fairing_terms.h"

namespace patchmill {

// How far each node may move from its given place.
struct FairingLimits {
  std::vector<Vec3> given;
  std::vector<Axes> locked;
  Vec3 band = Vec3::Constant(kInfinity);
  BandRule rule = BandRule::kLeastEnergy;

  void Lock(int node, const Axes& axes);
  // Writes the bounds of the steps along one axis from `points` into f.lower and f.upper. Both are 0 where
  // the node is locked. With BandRule::kCut the other nodes have no bounds.
  void SetBounds(int axis, const std::vector<Vec3>& points, BoxQuadratic& f) const;
  // The points a share of the way from `from` to `to`. They stay within the bands in spite of rounding;
  // locked components do not change at all.
  std::vector<Vec3> Part(double share, const std::vector<Vec3>& from, const std::vector<Vec3>& to) const;
};

// The limits of points. `fixed` marks the points that are locked: the ends of a curve, the border of a net.
FairingLimits MakeLimits(std::vector<Vec3> given, const FairingTerms& terms, const std::vector<bool>& fixed);

template <class State>
struct FairingRun {
  State state;
  std::vector<double> energies;
  bool settled = false;
};

// Model has: State; State Fit(std::vector<Vec3> points); const std::vector<Vec3>& Points(const State&);
// double Energy(const State&); std::vector<Vec3> Curvatures(const State&); absl::StatusOr<std::vector<Vec3>>
// Target(const State&), which returns the points of least energy for fixed tangents.
template <class Model>
absl::StatusOr<FairingRun<typename Model::State>> RunFairing(Model& model, typename Model::State first,
                                                             const FairingLimits& limits,
                                                             const FairingTerms& terms,
                                                             const RunContext& run) {
  using State = typename Model::State;
  const double diagonal = Diagonal(limits.given);
  FairingRun<State> out;
  out.state = std::move(first);
  out.energies.push_back(model.Energy(out.state));
  if (!std::isfinite(out.energies.back())) {
    return FieldError("points", "are too near each other for the range of numbers; scale them up");
  }
  CurvatureSigns signs = SignsOf(model.Curvatures(out.state), diagonal);
  for (int iteration = 1; iteration <= terms.max_iterations && !out.settled; ++iteration) {
    PM_RETURN_IF_ERROR(run.Check());
    PM_ASSIGN_OR_RETURN(const std::vector<Vec3> target, model.Target(out.state));
    const double last_energy = out.energies.back();
    bool better = false;
    double share = 1.0;
    for (int halving = 0; halving <= kMaxHalvings && !better; ++halving, share *= 0.5) {
      State next = model.Fit(limits.Part(share, model.Points(out.state), target));
      const double energy = model.Energy(next);
      better = energy < last_energy;  // false where nodes coincide: the energy is NaN or infinite
      if (!better) continue;
      out.state = std::move(next);
      out.energies.push_back(energy);
    }
    if (!better) {
      out.settled = true;
      break;
    }
    CurvatureSigns now = SignsOf(model.Curvatures(out.state), diagonal);
    out.settled = Settled(terms.stop, signs, now, last_energy, out.energies.back());
    signs = std::move(now);
    run.Progress("fairing", static_cast<double>(iteration) / terms.max_iterations);
  }
  return out;
}

}  // namespace patchmill
