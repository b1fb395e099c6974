#include "core/fairing/fair_net.h"

#include <array>
#include <utility>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <fmt/format.h>

#include "core/base/error_details.h"
#include "core/base/index.h"
#include "core/base/status.h"
#include "core/fairing/fairing_loop.h"

namespace patchmill {
namespace {

using Hold = BoxQuadratic::Hold;
using Sparse = Eigen::SparseMatrix<double>;

absl::Status CheckApart(const NetFairing& net) {
  const double near = kCoincidentShare * Diagonal(net.points);
  const auto point = [&](int i, int j) { return net.points[At(i * net.count_v + j)]; };
  for (int i = 0; i < net.count_u; ++i) {
    for (int j = 0; j < net.count_v; ++j) {
      const bool u = i + 1 < net.count_u && !((point(i + 1, j) - point(i, j)).norm() > near);
      const bool v = j + 1 < net.count_v && !((point(i, j + 1) - point(i, j)).norm() > near);
      if (!u && !v) continue;
      return FieldError("points", fmt::format("coincide at the nodes ({}, {}) and ({}, {})", i, j,
                                              u ? i + 1 : i, u ? j : j + 1));
    }
  }
  return absl::OkStatus();
}

// The five-term rows of all inner nodes and their residuals.
class NetSystem {
 public:
  explicit NetSystem(const BeamNet& net)
      : count_v_(static_cast<int>(net.u.size())), rows_(net.points.size()), force_(net.points.size()) {
    for (int i = 1; i + 1 < static_cast<int>(net.v.size()); ++i) {
      for (int j = 1; j + 1 < count_v_; ++j) {
        const std::size_t at = At(i * count_v_ + j);
        const FiveTermRow row = FiveTermRowOf(net, i, j);
        rows_[at] = {row.u.before, row.u.after, row.v.before, row.v.after};
        force_[at] = 0.5 * (row.u.rhs + row.v.rhs);
        for (std::size_t k = 0; k < 4; ++k) {
          force_[at] += rows_[at][k] * (net.points[Neighbor(at, k)] - net.points[at]);
        }
      }
    }
  }

  BoxStep LeastAlong(int axis, const std::vector<Vec3>& points, const FairingLimits& limits) {
    BoxQuadratic f;
    limits.SetBounds(axis, points, f);
    for (const Weights& w : rows_) f.diagonal.push_back(w[0] + w[1] + w[2] + w[3]);
    f.slope = [&](const std::vector<double>& x, std::size_t at) {
      double slope = -force_[at][axis];
      for (std::size_t k = 0; k < 4; ++k) slope += rows_[at][k] * (x[at] - x[Neighbor(at, k)]);
      return slope;
    };
    f.solve = [&](const std::vector<Hold>& holds) { return Solve(axis, f, holds); };
    return MinimizeInBox(f);
  }

 private:
  using Weights = std::array<double, 4>;  // 1/C^3 of W, E, S, N; 0 on the border

  std::size_t Neighbor(std::size_t at, std::size_t k) const {
    const std::size_t step = k < 2 ? At(count_v_) : 1;
    return k % 2 == 0 ? at - step : at + step;
  }

  // Held nodes move to the right-hand side. The free nodes are numbered in their order.
  std::vector<double> Solve(int axis, const BoxQuadratic& f, const std::vector<Hold>& holds) const {
    const std::size_t n = rows_.size();
    std::vector<double> x(n, 0.0);
    std::vector<int> unknown(n, -1);
    int count = 0;
    for (std::size_t at = 0; at < n; ++at) {
      if (holds[at] == Hold::kFree) {
        unknown[at] = count++;
      } else {
        x[at] = holds[at] == Hold::kLower ? f.lower[at] : f.upper[at];
      }
    }
    if (count == 0) return x;
    Eigen::VectorXd rhs(count);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t at = 0; at < n; ++at) {
      if (unknown[at] < 0) continue;
      rhs[unknown[at]] = force_[at][axis];
      entries.emplace_back(unknown[at], unknown[at], f.diagonal[at]);
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t other = Neighbor(at, k);
        if (unknown[other] < 0) {
          rhs[unknown[at]] += rows_[at][k] * x[other];
        } else {
          entries.emplace_back(unknown[at], unknown[other], -rows_[at][k]);
        }
      }
    }
    Sparse h(count, count);
    h.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Sparse> factor(h);
    PM_CHECK(factor.info() == Eigen::Success);  // the diagonal dominates, and the border is held
    const Eigen::VectorXd solved = factor.solve(rhs);
    for (std::size_t at = 0; at < n; ++at) {
      if (unknown[at] >= 0) x[at] = solved[unknown[at]];
    }
    return x;
  }

  int count_v_;
  std::vector<Weights> rows_;
  std::vector<Vec3> force_;  // half of rhs - lhs, at the present points
};

// The functions that RunFairing needs, for a net.
struct NetModel {
  using State = BeamNet;
  const NetFairing& net;
  const FairingLimits& limits;
  const RunContext& run;

  BeamNet Fit(std::vector<Vec3> points) const { return FitNet(net.count_u, std::move(points)); }
  static const std::vector<Vec3>& Points(const BeamNet& state) { return state.points; }
  static double Energy(const BeamNet& state) { return patchmill::Energy(state); }
  static std::vector<Vec3> Curvatures(const BeamNet& state) {
    std::vector<Vec3> all;
    for (const std::vector<Beam>* family : {&state.u, &state.v}) {
      for (const Beam& beam : *family) {
        const std::vector<Vec3> curvatures = ProjectedCurvatures(beam);
        all.insert(all.end(), curvatures.begin(), curvatures.end());
      }
    }
    return all;
  }
  absl::StatusOr<std::vector<Vec3>> Target(const BeamNet& state) const {
    NetSystem system(state);
    std::vector<Vec3> target = state.points;
    for (int axis = 0; axis < 3; ++axis) {
      if (!net.terms.axes[At(axis)]) continue;
      PM_RETURN_IF_ERROR(run.Check());
      const BoxStep step = system.LeastAlong(axis, state.points, limits);
      for (std::size_t at = 0; at < target.size(); ++at) target[at][axis] += step.x[at];
    }
    return target;
  }
};

}  // namespace

BeamNet FitNet(int count_u, std::vector<Vec3> points) {
  PM_CHECK(count_u >= 2 && points.size() % At(count_u) == 0);
  const int count_v = static_cast<int>(points.size()) / count_u;
  BeamNet net;
  for (int j = 0; j < count_v; ++j) {
    std::vector<Vec3> line;
    for (int i = 0; i < count_u; ++i) line.push_back(points[At(i * count_v + j)]);
    net.u.push_back(FitBeam(std::move(line), {}, {}));
  }
  for (int i = 0; i < count_u; ++i) {
    const auto begin = points.begin() + i * count_v;
    net.v.push_back(FitBeam({begin, begin + count_v}, {}, {}));
  }
  net.points = std::move(points);
  return net;
}

double Energy(const BeamNet& net) {
  double energy = 0.0;
  for (const Beam& beam : net.u) energy += Energy(beam);
  for (const Beam& beam : net.v) energy += Energy(beam);
  return energy;
}

FiveTermRow FiveTermRowOf(const BeamNet& net, int i, int j) {
  return {PositionRowOf(net.u[At(j)], i), PositionRowOf(net.v[At(i)], j)};
}

absl::StatusOr<FairedNet> FairNet(const NetFairing& net, const RunContext& run) {
  if (net.count_u < 2 || net.count_v < 2 ||
      static_cast<long long>(net.count_u) * net.count_v != static_cast<long long>(net.points.size())) {
    return FieldError("points", fmt::format("are {}; must be count_u x count_v = {} x {}, each >= 2",
                                            net.points.size(), net.count_u, net.count_v));
  }
  PM_RETURN_IF_ERROR(CheckFairing(net.points, 4, net.terms));
  PM_RETURN_IF_ERROR(CheckApart(net));
  std::vector<bool> border(net.points.size(), false);
  for (int i = 0; i < net.count_u; ++i) {
    for (int j = 0; j < net.count_v; ++j) {
      border[At(i * net.count_v + j)] = i == 0 || j == 0 || i + 1 == net.count_u || j + 1 == net.count_v;
    }
  }
  FairingLimits limits = MakeLimits(net.points, net.terms, border);
  for (const PointLock& lock : net.terms.locks) limits.Lock(lock.point, lock.axes);
  NetModel model{net, limits, run};
  FairedNet faired;
  faired.before = model.Fit(net.points);
  PM_ASSIGN_OR_RETURN(FairingRun<BeamNet> done, RunFairing(model, faired.before, limits, net.terms, run));
  faired.after = std::move(done.state);
  faired.energies = std::move(done.energies);
  faired.settled = done.settled;
  for (std::size_t at = 0; at < net.points.size(); ++at) {
    faired.moved.push_back(faired.after.points[at] - net.points[at]);
  }
  return faired;
}

}  // namespace patchmill
