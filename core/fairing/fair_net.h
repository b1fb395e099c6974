// Fairing of a net of measured points as two families of beams [fairing, section 7].
//
//      v ^    (i,j+1)            node (i,j) is points[i * count_v + j]; beams u run along i with j fixed,
//        |  W  (i,j)  E          beams v along j with i fixed. Four segments meet at an inner node.
//        +----> u                The border stays: fair it first, curve by curve (fair_curve.h).
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/fairing/beam.h"
#include "core/fairing/fairing_terms.h"

namespace patchmill {

struct NetFairing {
  int count_u = 0, count_v = 0;  // >= 2 each, together at most kMaxFairingPoints
  std::vector<Vec3> points;      // neighbours along both families apart
  FairingTerms terms;            // locks by index of the point
};

struct BeamNet {
  std::vector<Beam> u;  // by j
  std::vector<Beam> v;  // by i
  std::vector<Vec3> points;
};

// The cubic splines through the lines of a net.
BeamNet FitNet(int count_u, std::vector<Vec3> points);

double Energy(const BeamNet& net);  // of all beams

// The five-term equation of an inner node [fairing (13)]: the sum of the two equations of its beams
// [fairing (8)], whose lhs - rhs is dV/dP_ij / 12. Over the free nodes symmetric positive definite.
struct FiveTermRow {
  PositionRow u, v;
};
FiveTermRow FiveTermRowOf(const BeamNet& net, int i, int j);

struct FairedNet {
  BeamNet before, after;
  std::vector<double> energies;  // V of the fit, then after each iteration: falls strictly
  bool settled = false;          // as FairedCurve::settled; signs of both families
  std::vector<Vec3> moved;       // after - given
};

// One iteration: the tangents of both families [fairing (7)], then the five-term system axis by axis, by
// sparse Cholesky factors, one solve where no band holds; else as FairCurve. About O(n^1.5) for n nodes.
// Errors: INVALID_ARGUMENT with field path, also for neighbours that coincide; those of `run`, asked before
// each axis.
absl::StatusOr<FairedNet> FairNet(const NetFairing& net, const RunContext& run = {});

}  // namespace patchmill
