#include "cam/plan/resolve.h"

#include <fmt/format.h>

#include "core/surface/extent.h"

namespace patchmill {

Budget SplitBudget(double tolerance) {
  return {.chord = 0.5 * tolerance,
          .rounding = 0.1 * tolerance,
          .certificate = 0.1 * tolerance,
          .controller = 0.3 * tolerance};
}

absl::StatusOr<Resolved> Resolve(const Surface& surface, const Job& job) {
  Resolved r;
  r.box = TightBox(surface);
  switch (job.setup.zero) {
    case Setup::Zero::kPoint:
      r.program_zero = job.setup.zero_point;
      r.zero_name = fmt::format("model point {:.4f} {:.4f} {:.4f}", r.program_zero.x(), r.program_zero.y(),
                                r.program_zero.z());
      if (r.program_zero.isZero()) r.zero_name = "model origin";
      break;
    case Setup::Zero::kTopCenter:
      r.program_zero = Lift(Plan(r.box.Center()), r.box.max.z());
      r.zero_name = "top center of the model's box";
      break;
    case Setup::Zero::kBottomCorner:
      r.program_zero = r.box.min;
      r.zero_name = "lower left bottom corner of the model's box";
      break;
  }
  const double zero_z = r.program_zero.z();
  const Operation& op = job.operation;
  r.radius = BallRadius(op.tool);
  r.plan_radius = r.radius + op.leave;
  r.budget = SplitBudget(op.tolerance);
  const double top = r.box.max.z();
  r.stock_top_z = job.setup.stock_top_z ? *job.setup.stock_top_z + zero_z : top + job.setup.allowance;
  if (r.stock_top_z < top - 1e-6) {
    return absl::InvalidArgumentError(
        fmt::format("setup.stock.top_z_mm = {:.6g}; must be at least the model's top, {:.6g}",
                    r.stock_top_z - zero_z, top - zero_z));
  }
  r.floor_z = op.floor_z ? *op.floor_z + zero_z : r.box.min.z();
  const double highest = std::max(top, r.stock_top_z);
  r.clearance_z = op.clearance_z ? *op.clearance_z + zero_z
                                 : highest + op.clearance_above.value_or(kDefaultClearanceAbove);
  if (r.clearance_z < highest) {
    return absl::InvalidArgumentError(fmt::format(
        "operations[0].heights.clearance_z_mm = {:.6g}; must be at least {:.6g}, the highest point of model "
        "and stock",
        r.clearance_z - zero_z, highest - zero_z));
  }
  return r;
}

VerifyParams MakeVerifyParams(const Job& job, const Resolved& resolved) {
  VerifyParams p;
  p.tolerance = job.operation.tolerance;
  p.scallop = job.operation.scallop;
  p.leave = job.operation.leave;
  p.certainty = std::min(1e-3, 0.1 * job.operation.tolerance);
  p.floor_z = resolved.floor_z;
  p.program_zero = resolved.program_zero;
  p.stock_top_z = resolved.stock_top_z;
  p.allowance = job.setup.allowance;
  p.zigzag_angle = job.operation.zigzag_angle;
  if (job.operation.strategy == Strategy::kContour) p.strategy = ForcedStrategy::kContour;
  if (job.operation.strategy == Strategy::kZigzag) p.strategy = ForcedStrategy::kZigzag;
  return p;
}

}  // namespace patchmill
