// A job's open choices made definite: heights, zero, budget shares. Placed frame unless said otherwise.
#pragma once

#include <memory>
#include <optional>

#include <absl/status/statusor.h>

#include "cam/limits/stock_solid.h"
#include "cam/plan/job.h"
#include "cam/plan/region_choices.h"

namespace patchmill {

// The tolerance is the whole budget ([machining M8]).
struct Budget {
  double chord = 0.0;        // straight moves of passes against the exact path
  double arc = 0.0;          // fitted arcs and moves against these straight moves
  double rounding = 0.0;     // four decimals need 5e-5 mm
  double certificate = 0.0;  // height certificates; the gap itself is a tenth of it
  double controller = 0.0;   // what the control may smooth: P of G64
};
Budget SplitBudget(double tolerance);

struct Resolved {
  Box3 box;  // of the surface
  Vec3 program_zero = Vec3::Zero();
  std::string zero_name;
  double stock_top_z = 0.0;
  std::optional<Box3> stock_box;  // of a stock with a model of its own
  double floor_z = 0.0;           // tip
  // Tip: what is planned with. It is the floor, or where coordinates are coarser than the floor's slack, the
  // lowest coordinate that is not below it.
  double plan_floor_z = 0.0;
  double clearance_z = 0.0;  // tip
  double radius = 0.0;       // ball
  double plan_radius = 0.0;  // ball + stock to leave: what is planned with
  // Rad: contours cut what is this steep. It lies just below the steep angle: a plane or a cone of that very
  // angle is then steep all over, whatever its rounding.
  double split_angle = 0.0;
  Budget budget;
  std::shared_ptr<const StockSolid> stock;  // null: none but the allowance over the surface
  StockDepth depth_limit = 0.0;             // cuts into the stock may be so deep
  Containment containment;
};

// INVALID_ARGUMENT when heights contradict each other (clearance below model, stock or obstacles, stock top
// below the model), and for patches that the model does not have. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<Resolved> Resolve(const Surface& surface, const Job& job, const RunContext& run);
// Resolves a job that has the set-up of an earlier one, but other tools or limits: `stock` is the
// Resolved::stock of the earlier one, which is not made again.
absl::StatusOr<Resolved> Resolve(const Surface& surface, const Job& job,
                                 std::shared_ptr<const StockSolid> stock, const RunContext& run);

// How a program of this job is verified. `parts`: as PartsOf gives them (cam/plan/region_choices.h); empty:
// the whole surface is one part.
VerifyParams MakeVerifyParams(const Job& job, const Resolved& resolved,
                              const std::vector<PlanPart>& parts = {});

}  // namespace patchmill
