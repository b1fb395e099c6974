#include "core/fairing/fair_curve.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/error_details.h"
#include "core/base/index.h"
#include "core/base/status.h"
#include "core/fairing/fairing_loop.h"

namespace patchmill {
namespace {

using Hold = BoxQuadratic::Hold;

absl::Status CheckDirection(const std::optional<Vec3>& direction, const char* field) {
  if (!direction || (direction->allFinite() && std::isnormal(direction->norm()))) return absl::OkStatus();
  return FieldError(field, fmt::format("= ({}, {}, {}); must have a length", direction->x(), direction->y(),
                                       direction->z()));
}

// The given points without repetition.
struct Nodes {
  std::vector<Vec3> points;
  std::vector<int> node;  // of each given point
};

Nodes MergeCoincident(const std::vector<Vec3>& points) {
  Nodes nodes;
  const double near = kCoincidentShare * Diagonal(points);
  for (const Vec3& p : points) {
    if (nodes.points.empty() || (p - nodes.points.back()).norm() > near) nodes.points.push_back(p);
    nodes.node.push_back(static_cast<int>(nodes.points.size()) - 1);
  }
  return nodes;
}

// The rows of [fairing (8)] and their residuals, for all three components. They are solved for the steps of
// the points, not for their places. So points that are fair already do not creep with the rounding of large
// coordinates.
class ChainSystem {
 public:
  explicit ChainSystem(const Beam& beam) : rows_(At(beam.count())), force_(At(beam.count())) {
    for (int i = 1; i + 1 < beam.count(); ++i) {
      rows_[At(i)] = PositionRowOf(beam, i);
      const PositionRow& row = rows_[At(i)];
      force_[At(i)] = 0.5 * row.rhs + row.before * (beam.points[At(i - 1)] - beam.points[At(i)]) +
                      row.after * (beam.points[At(i + 1)] - beam.points[At(i)]);
    }
  }

  // The steps along one axis that lead to the least energy within the limits.
  BoxStep LeastAlong(int axis, const std::vector<Vec3>& points, const FairingLimits& limits) const {
    BoxQuadratic f;
    limits.SetBounds(axis, points, f);
    for (const PositionRow& row : rows_) f.diagonal.push_back(row.before + row.after);
    f.slope = [&](const std::vector<double>& x, std::size_t i) {
      const PositionRow& row = rows_[i];
      return row.before * (x[i] - x[i - 1]) + row.after * (x[i] - x[i + 1]) - force_[i][axis];
    };
    f.solve = [&](const std::vector<Hold>& holds) { return Solve(axis, f, holds); };
    return MinimizeInBox(f);
  }

 private:
  std::vector<double> Solve(int axis, const BoxQuadratic& f, const std::vector<Hold>& holds) const {
    const std::size_t n = rows_.size();
    std::vector<double> x(n, 0.0), upper(n, 0.0);
    for (std::size_t i = 1; i + 1 < n; ++i) {
      if (holds[i] != Hold::kFree) {
        x[i] = holds[i] == Hold::kLower ? f.lower[i] : f.upper[i];
        continue;
      }
      const PositionRow& row = rows_[i];
      const double pivot = row.before * (1.0 - upper[i - 1]) + row.after;
      upper[i] = row.after / pivot;
      x[i] = (force_[i][axis] + row.before * x[i - 1]) / pivot;
    }
    for (std::size_t i = n - 1; i-- > 1;) x[i] += upper[i] * x[i + 1];
    return x;
  }

  std::vector<PositionRow> rows_;
  std::vector<Vec3> force_;  // half of rhs - lhs, at the present points
};

// The functions that RunFairing needs, for a curve.
struct CurveModel {
  using State = Beam;
  const CurveFairing& curve;
  const FairingLimits& limits;
  long long rows = 0;

  Beam Fit(std::vector<Vec3> points) {
    rows += static_cast<long long>(points.size());
    return FitBeam(std::move(points), curve.start_direction, curve.end_direction);
  }
  static const std::vector<Vec3>& Points(const Beam& beam) { return beam.points; }
  static double Energy(const Beam& beam) { return patchmill::Energy(beam); }
  static std::vector<Vec3> Curvatures(const Beam& beam) { return ProjectedCurvatures(beam); }
  absl::StatusOr<std::vector<Vec3>> Target(const Beam& beam) {
    const ChainSystem system(beam);
    std::vector<Vec3> target = beam.points;
    for (int axis = 0; axis < 3; ++axis) {
      if (!curve.terms.axes[At(axis)]) continue;
      const BoxStep step = system.LeastAlong(axis, beam.points, limits);
      rows += step.solves * static_cast<long long>(target.size());
      for (std::size_t i = 0; i < target.size(); ++i) target[i][axis] += step.x[i];
    }
    return target;
  }
};

}  // namespace

absl::StatusOr<FairedCurve> FairCurve(const CurveFairing& curve, const RunContext& run) {
  PM_RETURN_IF_ERROR(CheckFairing(curve.points, 2, curve.terms));
  PM_RETURN_IF_ERROR(CheckDirection(curve.start_direction, "start_direction"));
  PM_RETURN_IF_ERROR(CheckDirection(curve.end_direction, "end_direction"));
  Nodes nodes = MergeCoincident(curve.points);
  if (nodes.points.size() < 2) return FieldError("points", "all coincide");
  std::vector<bool> ends(nodes.points.size(), false);
  ends.front() = ends.back() = true;
  FairingLimits limits = MakeLimits(nodes.points, curve.terms, ends);
  for (const PointLock& lock : curve.terms.locks) limits.Lock(nodes.node[At(lock.point)], lock.axes);

  CurveModel model{curve, limits};
  FairedCurve faired;
  faired.before = model.Fit(nodes.points);
  PM_ASSIGN_OR_RETURN(FairingRun<Beam> done, RunFairing(model, faired.before, limits, curve.terms, run));
  faired.after = std::move(done.state);
  faired.energies = std::move(done.energies);
  faired.settled = done.settled;
  faired.rows = model.rows;
  faired.node = std::move(nodes.node);
  faired.moved.reserve(curve.points.size());
  for (const int node : faired.node)
    faired.moved.push_back(faired.after.points[At(node)] - nodes.points[At(node)]);
  return faired;
}

}  // namespace patchmill
