#include "cam/plan/resolve.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "cam/limits/reach_tolerance.h"
#include "cam/limits/upper_cylinders.h"
#include "cam/plan/beside_part.h"
#include "cam/plan/patch_selection.h"
#include "core/base/error_details.h"
#include "core/base/status.h"
#include "core/surface/extent.h"

namespace patchmill {
namespace {

// Above what models are rounded by, below what anyone would tell apart.
constexpr double kSplitSlack = Radians(0.01);

}  // namespace

Budget SplitBudget(double tolerance) {
  // Arcs need the larger share: a chord of an exact arc is as far from it as the share of chords allows. Rest
  // passes and links stay straight; they use both shares, which are together ReachTolerance.
  return {.chord = 0.2 * tolerance,
          .arc = 0.3 * tolerance,
          .rounding = 0.1 * tolerance,
          .certificate = 0.1 * tolerance,
          .controller = 0.3 * tolerance};
}

namespace {

// The floor in the placed frame, raised to a coordinate of the program. Finer coordinates than this round to
// places that count as on the floor.
double FloorOnGrid(double floor_z, double zero_z, double tick) {
  constexpr double kFine = 1.5e-4;  // mm
  if (tick < kFine || !std::isfinite(floor_z)) return floor_z;
  return zero_z + tick * std::ceil((floor_z - zero_z) / tick - 1e-6);
}

// The avoided patches with those of skipped faces.
std::vector<bool> WithSkipped(std::vector<bool> avoided, const PatchModel& model) {
  for (std::size_t i = 0; i < model.patches.size(); ++i) {
    if (!IsSkipped(model, PatchId(i))) continue;
    avoided.resize(model.patches.size(), false);
    avoided[i] = true;
  }
  return avoided;
}

Outline Shifted(const std::vector<Ring>& rings, const Vec3& by) {
  std::vector<Ring> moved = rings;
  for (Ring& ring : moved) {
    for (Vec2& p : ring) p += Xy(by);
  }
  return Outline(moved);
}

// Adds the obstacle as it limits ball and shank, and for each cylinder of the holder as an obstacle that is
// as much wider and lower as the cylinder is wider and begins higher.
void AddObstacle(const Obstacle& obstacle, const Tool& tool, std::vector<Obstacle>& obstacles) {
  obstacles.push_back(obstacle);
  for (const UpperCylinder& cylinder : UpperCylindersOf(tool)) {
    if (cylinder.part != UpperPart::kHolder) continue;
    Obstacle lower = obstacle;
    const double wider = cylinder.radius - WidestRadius(tool);
    lower.of_holder = true;
    lower.margin += wider;
    lower.top_z -= wider + cylinder.rise + BallRadius(tool);
    obstacles.push_back(std::move(lower));
  }
}

// The stock as it limits the holder: one obstacle for each of its cylinders.
void AddStock(const std::shared_ptr<const StockSolid>& stock, const Operation& op,
              std::vector<Obstacle>& obstacles) {
  if (stock == nullptr) return;
  for (const UpperCylinder& cylinder : UpperCylindersOf(op.tool)) {
    if (cylinder.part != UpperPart::kHolder) continue;
    Obstacle body;
    body.name = "the stock";
    body.stock = stock;
    body.of_holder = true;
    body.top_z = -kInfinity;
    // Moves may violate a limit by half the tolerance, and the verifier allows nothing.
    const double wider = cylinder.radius - WidestRadius(op.tool);
    body.margin = wider + stock->accuracy() + op.tolerance;
    body.lower = body.margin + cylinder.rise + BallRadius(op.tool) - op.tolerance;
    obstacles.push_back(std::move(body));
  }
}

absl::StatusOr<Containment> ResolveContainment(const Surface& surface, const Job& job, const Resolved& r,
                                               const RunContext& run) {
  const Vec3& zero = r.program_zero;
  const Selection& selection = job.operation.selection;
  Containment c;
  PM_ASSIGN_OR_RETURN(c.selected,
                      SelectPatches(surface.network, selection.patches, "selection.patch_ids", run));
  PM_ASSIGN_OR_RETURN(c.avoided,
                      SelectPatches(surface.network, selection.avoid, "selection.avoid_patch_ids", run));
  c.avoided = WithSkipped(std::move(c.avoided), surface.network.model);
  c.avoid_margin = selection.avoid_margin;
  if (!selection.boundary.empty()) {
    c.boundary = {Shifted(selection.boundary, zero), selection.boundary_mode, selection.boundary_offset};
  }
  if (job.operation.top_z) c.top_z = *job.operation.top_z + zero.z();
  for (std::size_t k = 0; k < job.setup.obstacles.size(); ++k) {
    const ObstacleOutline& o = job.setup.obstacles[k];
    const std::string name = o.id.empty() ? fmt::format("#{}", k) : fmt::format("\"{}\"", o.id);
    AddObstacle({name, Shifted({o.outline}, zero), o.top_z + zero.z(), o.margin}, job.operation.tool,
                c.obstacles);
  }
  AddStock(r.stock, job.operation, c.obstacles);
  PM_ASSIGN_OR_RETURN(c.beside, FindBesideStrips(surface,
                                                 {.radius = BallRadius(job.operation.tool),
                                                  .tolerance = job.operation.tolerance,
                                                  .mill_outside = selection.mill_outside,
                                                  .selected = c.selected},
                                                 run));
  return c;
}

Ring CircleAround(const Vec2& center, double radius) {
  constexpr int kCorners = 720;  // the polygon lies around the circle, by 1e-5 of its radius
  Ring ring;
  for (int k = 0; k < kCorners; ++k) {
    const double angle = 2.0 * kPi * k / kCorners;
    ring.push_back(center + radius / std::cos(kPi / kCorners) * Vec2(std::cos(angle), std::sin(angle)));
  }
  return ring;
}

// The outline of the stock in the placed frame.
Ring StockOutline(const Setup& setup, const Box3& box, const Vec3& zero) {
  if (const auto* block = std::get_if<BlockStock>(&setup.stock_body)) {
    const Vec2 low = Xy(box.min).array() - block->margin, high = Xy(box.max).array() + block->margin;
    return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  }
  if (const auto* cylinder = std::get_if<CylinderStock>(&setup.stock_body)) {
    const Vec2 center = cylinder->center ? Vec2(*cylinder->center + Xy(zero)) : Xy(box.Center());
    return CircleAround(center, 0.5 * cylinder->diameter);
  }
  Ring outline = std::get<OutlineStock>(setup.stock_body).outline;
  for (Vec2& p : outline) p += Xy(zero);
  return outline;
}

absl::StatusOr<std::shared_ptr<const StockSolid>> ResolveStock(const Surface& surface, const Setup& setup,
                                                               const Resolved& r, const RunContext& run) {
  if (std::holds_alternative<NoStockBody>(setup.stock_body)) return nullptr;
  if (const auto* model = std::get_if<ModelStock>(&setup.stock_body)) {
    PM_ASSIGN_OR_RETURN(StockSolid solid,
                        StockSolid::OfModel(*model->surface, r.stock_top_z,
                                            setup.allowance_stated ? &surface : nullptr, run));
    return std::make_shared<const StockSolid>(std::move(solid));
  }
  const Ring ring = StockOutline(setup, r.box, r.program_zero);
  if (const std::string fault = OutlineFault({ring}); !fault.empty())
    return FieldError("setup.stock", "is no outline: " + fault);
  if (!setup.allowance_stated)
    return std::make_shared<const StockSolid>(StockSolid::Whole(Outline({ring}), r.stock_top_z));
  PM_ASSIGN_OR_RETURN(StockSolid solid, StockSolid::Roughed(Outline({ring}), r.stock_top_z, surface, run));
  return std::make_shared<const StockSolid>(std::move(solid));
}

// `stock`: as an earlier Resolve made it; null: it is made.
absl::StatusOr<Resolved> ResolveWith(const Surface& surface, const Job& job,
                                     std::shared_ptr<const StockSolid> stock, const RunContext& run) {
  Resolved r;
  r.box = TightBox(surface);
  PM_RETURN_IF_ERROR(run.Check());
  switch (job.setup.zero) {
    case Setup::Zero::kPoint:
      r.program_zero = job.setup.zero_point;
      r.zero_name = fmt::format("model point {:.4f} {:.4f} {:.4f}", r.program_zero.x(), r.program_zero.y(),
                                r.program_zero.z());
      if (r.program_zero.isZero()) r.zero_name = "model origin";
      break;
    case Setup::Zero::kTopCenter:
      r.program_zero = Lift(Xy(r.box.Center()), r.box.max.z());
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
  r.split_angle = op.steep_angle - kSplitSlack;
  r.budget = SplitBudget(op.tolerance);
  if (job.dialect.follows_exactly) r.budget.controller = 0.0;
  if (!job.dialect.follows_exactly && job.dialect.path_tolerance.empty())
    r.budget.controller = job.control_deviation.value_or(0.0);
  const double top = r.box.max.z();
  r.stock_top_z = top + job.setup.allowance.floors;
  if (const auto* model = std::get_if<ModelStock>(&job.setup.stock_body)) {
    if (model->surface == nullptr) return FieldError("setup.stock.model", "is missing");
    r.stock_box = TightBox(*model->surface);
    r.stock_top_z = std::max(r.stock_top_z, r.stock_box->max.z());
  }
  if (job.setup.stock_top_z) r.stock_top_z = *job.setup.stock_top_z + zero_z;
  if (r.stock_top_z < top - 1e-6) {
    return FieldError("setup.stock.top_z_mm",
                      fmt::format("= {:.6g}; must be at least the model's top, {:.6g}",
                                  r.stock_top_z - zero_z, top - zero_z));
  }
  r.stock = std::move(stock);
  if (r.stock == nullptr) {
    PM_ASSIGN_OR_RETURN(r.stock, ResolveStock(surface, job.setup, r, run));
  }
  r.depth_limit = {std::max(job.setup.allowance.walls, op.accept_depth),
                   std::max(job.setup.allowance.floors, op.accept_depth)};
  r.floor_z = op.floor_z ? *op.floor_z + zero_z : r.box.min.z();
  r.plan_floor_z = FloorOnGrid(r.floor_z, zero_z, TickOf(job.dialect, job.unit));
  PM_ASSIGN_OR_RETURN(r.containment, ResolveContainment(surface, job, r, run));
  double highest = std::max(top, r.stock_top_z);
  for (const Obstacle& o : r.containment.obstacles) highest = std::max(highest, o.top_z + o.margin);
  r.clearance_z = op.clearance_z ? *op.clearance_z + zero_z
                                 : highest + op.clearance_above.value_or(kDefaultClearanceAbove);
  if (r.clearance_z < highest) {
    return FieldError("heights.clearance_z_mm",
                      fmt::format("= {:.6g}; must be at least {:.6g}, the highest point of model, stock and "
                                  "obstacles with their margins",
                                  r.clearance_z - zero_z, highest - zero_z));
  }
  return r;
}

}  // namespace

absl::StatusOr<Resolved> Resolve(const Surface& surface, const Job& job, const RunContext& run) {
  return ResolveWith(surface, job, nullptr, run);
}

absl::StatusOr<Resolved> Resolve(const Surface& surface, const Job& job,
                                 std::shared_ptr<const StockSolid> stock, const RunContext& run) {
  return ResolveWith(surface, job, std::move(stock), run);
}

namespace {

Finish FinishOf(const RegionChoice& choice) {
  Finish finish;
  finish.scallop = choice.scallop;
  finish.zigzag_angle = choice.zigzag_angle;
  if (choice.strategy == Strategy::kContour) finish.strategy = ForcedStrategy::kContour;
  if (choice.strategy == Strategy::kZigzag) finish.strategy = ForcedStrategy::kZigzag;
  return finish;
}

}  // namespace

VerifyParams MakeVerifyParams(const Job& job, const Resolved& resolved, const std::vector<PlanPart>& parts) {
  VerifyParams p;
  p.finish = FinishOf(ChoiceOf(job.operation));
  for (const PlanPart& part : parts) {
    FinishPart& to = p.parts.emplace_back();
    to.finish = FinishOf(part.choice);
    to.where = part.where;
  }
  p.tolerance = job.operation.tolerance;
  p.leave = job.operation.leave;
  p.certainty = std::min(1e-3, 0.1 * job.operation.tolerance);
  p.floor_z = resolved.floor_z;
  p.program_zero = resolved.program_zero;
  p.stock_top_z = resolved.stock_top_z;
  p.allowance = job.setup.allowance;
  p.stock = resolved.stock;
  p.machine = job.setup.machine;
  p.depth_limit = resolved.depth_limit;
  p.keep_feed = job.operation.keep_feed;
  p.containment = resolved.containment;
  return p;
}

}  // namespace patchmill
