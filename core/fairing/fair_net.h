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
  int count_u = 0, count_v = 0;  // each >= 2; their product is at most kMaxFairingPoints
  std::vector<Vec3> points;      // neighbours along both families must not coincide
  FairingTerms terms;            // locks by index of the point
};

struct BeamNet {
  std::vector<Beam> u;  // index: j
  std::vector<Beam> v;  // index: i
  std::vector<Vec3> points;
};

// The cubic splines through the lines of a net.
BeamNet FitNet(int count_u, std::vector<Vec3> points);

double Energy(const BeamNet& net);  // of all beams

// The five-term equation of an inner node [fairing (13)]: the sum of the equations of its two beams
// [fairing (8)]. Its lhs - rhs is dV/dP_ij / 12. The system of the free nodes is symmetric positive definite.
struct FiveTermRow {
  PositionRow u, v;
};
FiveTermRow FiveTermRowOf(const BeamNet& net, int i, int j);

struct FairedNet {
  BeamNet before, after;
  std::vector<double> energies;  // V of the fit, then V after each iteration; strictly decreasing
  bool settled = false;          // as FairedCurve::settled; the signs are those of both families
  std::vector<Vec3> moved;       // new minus given place
};

// One iteration finds the tangents of both families [fairing (7)]. Then it solves the five-term system axis
// by axis with sparse Cholesky factors; one solve suffices where no band holds. The rest is as in FairCurve.
// Cost about O(n^1.5) for n nodes. Errors: INVALID_ARGUMENT with a field path, also for neighbours that
// coincide, and those of `run`, which is checked before each axis.
absl::StatusOr<FairedNet> FairNet(const NetFairing& net, const RunContext& run = {});

}  // namespace patchmill
