#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "cam/picture/preview.h"
#include "cam/plan/plan.h"
#include "cam/plan/resolve.h"
#include "core/base/status.h"
#include "core/lines/patch_crossings.h"
#include "server/convert/fields.h"
#include "server/convert/lines.h"
#include "server/convert/report.h"
#include "server/convert/setup.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"
#include "server/limits.h"
#include "server/placed_surface.h"

namespace patchmill {
namespace {

struct Order {
  Job job;
  std::vector<LineOrder> lines;
  double tolerance = 0.01, min_loop = 0.1;  // mm
};

absl::StatusOr<Order> ReadOrder(const v1::TraceLinesRequest& request) {
  FieldErrors errors;
  Order order;
  order.job.setup = FromProto(request.setup(), "setup", errors);
  if (request.families().empty()) errors.Missing("families");
  if (request.families_size() > limits::kMaxLineFamilies) {
    errors.Add("families", fmt::format("has {} elements; must have at most {}", request.families_size(),
                                       limits::kMaxLineFamilies));
    return errors.ToStatus();
  }
  for (int k = 0; k < request.families_size(); ++k) {
    order.lines.push_back(FromProto(request.families(k), fmt::format("families[{}]", k), errors));
  }
  if (request.has_tolerance_mm()) order.tolerance = request.tolerance_mm();
  Require(errors, "tolerance_mm", order.tolerance, order.tolerance >= 1e-6 && order.tolerance <= 100.0,
          "in [1e-06, 100]");
  if (request.has_min_loop_mm()) order.min_loop = request.min_loop_mm();
  Require(errors, "min_loop_mm", order.min_loop, order.min_loop >= 1e-3 && order.min_loop <= 1000.0,
          "in [0.001, 1000]");
  RequireBytes(errors, "name", request.name(), limits::kMaxNameBytes);
  PM_RETURN_IF_ERROR(errors.ToStatus());
  return order;
}

// One level of one family, with its curves.
struct Level {
  int family = 0;
  double level = 0.0;
  std::vector<ZeroCurve> curves;
};

// Counts the points of all lines and compares them with the limit of an answer.
class PointCount {
 public:
  absl::Status Add(const std::vector<ZeroCurve>& curves) {
    for (const ZeroCurve& curve : curves) points_ += static_cast<double>(curve.points.size());
    if (points_ <= limits::kMaxPolylinePoints) return absl::OkStatus();
    return LimitError("line_points", limits::kMaxPolylinePoints, points_);
  }

 private:
  double points_ = 0.0;
};

absl::StatusOr<std::vector<ZeroCurve>> TraceFlow(const Surface& surface, FlowParams flow, double tolerance,
                                                 const RunContext& run) {
  constexpr double kUsual = 1.0 / 40.0, kClosest = 1e-3;  // shares of the diagonal of the box
  const double diagonal = surface.box.Diagonal();
  if (flow.spacing == 0.0) flow.spacing = kUsual * diagonal;
  if (flow.spacing < kClosest * diagonal)
    return LimitError("1/spacing_mm", 1.0 / (kClosest * diagonal), 1.0 / flow.spacing);
  flow.tolerance = tolerance;
  flow.max_points = static_cast<std::size_t>(limits::kMaxPolylinePoints);
  return TraceFlowLines(surface, flow, run);
}

absl::StatusOr<std::vector<Level>> Trace(const Surface& surface, const std::vector<LineOrder>& lines,
                                         const Order& order, const Vec3& zero, const RunContext& run) {
  std::vector<Level> levels;
  std::vector<ZeroField> fields;
  std::vector<std::size_t> of_field;  // position of its level
  PointCount points;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const int family = static_cast<int>(k);
    if (lines[k].crossings) {
      PM_ASSIGN_OR_RETURN(Crossings3d crossings,
                          FindPatchCrossings(surface, {.tolerance = order.tolerance}, run));
      PM_RETURN_IF_ERROR(points.Add(crossings.curves));
      levels.push_back({family, 0.0, std::move(crossings.curves)});
      continue;
    }
    if (lines[k].flow) {
      PM_ASSIGN_OR_RETURN(std::vector<ZeroCurve> flow,
                          TraceFlow(surface, *lines[k].flow, order.tolerance, run));
      PM_RETURN_IF_ERROR(points.Add(flow));
      levels.push_back({family, 0.0, std::move(flow)});
      continue;
    }
    std::vector<double> wanted = lines[k].levels;
    if (!HasLevels(lines[k])) {
      wanted = {0.0};
    } else if (wanted.empty() && lines[k].count > 0) {
      wanted = ChooseLevels(surface, lines[k].family, lines[k].count, zero);
    }
    for (const double level : wanted) {
      of_field.push_back(levels.size());
      levels.push_back({family, level, {}});
      fields.push_back(FieldOf(lines[k].family, level));
    }
  }
  ZeroMeshParams params;
  params.min_cell = order.min_loop;
  params.max_cell = std::max(params.max_cell, params.min_cell);
  // A few fields at a time, so that too many points are noticed before they fill the memory.
  constexpr std::size_t kAtOnce = 8;
  for (std::size_t first = 0; first < fields.size(); first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, fields.size() - first);
    PM_ASSIGN_OR_RETURN(
        std::vector<std::vector<ZeroCurve>> curves,
        TraceZeroCurves(surface, std::span(fields).subspan(first, count), params, order.tolerance, run));
    for (std::size_t k = 0; k < count; ++k) {
      PM_RETURN_IF_ERROR(points.Add(curves[k]));
      levels[of_field[first + k]].curves = std::move(curves[k]);
    }
  }
  return levels;
}

// From blue for the lowest level of a family to red for the highest.
std::string Color(double share) {
  const auto mix = [&](int a, int b) { return a + static_cast<int>(share * (b - a)); };
  return fmt::format("#{:02x}{:02x}{:02x}", mix(20, 200), mix(70, 30), mix(190, 30));
}

std::string Draw(const Surface& surface, const std::vector<LineOrder>& lines,
                 const std::vector<Level>& levels, const Vec3& zero, const std::string& title) {
  PreviewInput input;
  input.surface = &surface;
  input.title = title;
  input.program_zero = zero;
  std::vector<int> count(lines.size(), 0), seen(lines.size(), 0);
  for (const Level& level : levels) ++count[static_cast<std::size_t>(level.family)];
  for (const Level& level : levels) {
    const auto family = static_cast<std::size_t>(level.family);
    const LineOrder& order = lines[family];
    PreviewLines drawn;
    drawn.name =
        fmt::format("{}: {}", Describe(order.kind, WireLevel(order, level.level, zero)), level.curves.size());
    const int n = count[family];
    drawn.color = Color(n > 1 ? static_cast<double>(seen[family]++) / (n - 1)
                              : static_cast<double>(family) / std::max<std::size_t>(1, lines.size() - 1));
    for (const ZeroCurve& curve : level.curves) {
      std::vector<Vec3> points;
      for (const SurfacePoint& p : curve.points) points.push_back(p.p);
      if (curve.closed && !points.empty()) points.push_back(points.front());
      drawn.polylines.push_back(std::move(points));
    }
    input.lines.push_back(std::move(drawn));
  }
  return DrawPreview(input);
}

}  // namespace

absl::Status HandleTraceLines(const Call& call, const v1::TraceLinesRequest& request,
                              v1::TraceLinesResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  PM_RETURN_IF_ERROR(CheckThreads(request.max_threads(), "max_threads"));
  PM_ASSIGN_OR_RETURN(const Order order, ReadOrder(request));
  return RunQuickCall(
      call, {.max_threads = request.max_threads()}, [&](const RunContext& run) -> absl::Status {
        PM_ASSIGN_OR_RETURN(LoadedModel model, LoadModel(request.source(), "source", run, ModelsOf(call)));
        PM_RETURN_IF_ERROR(RequireSound(model));
        PM_ASSIGN_OR_RETURN(UprightModel upright, MakeUpright(std::move(model), order.job.setup, run));
        Job job = order.job;
        job.setup = std::move(upright.setup);
        PM_ASSIGN_OR_RETURN(const std::shared_ptr<const Surface> built,
                            PlacedSurface(std::move(upright.model.model), upright.model.digest, job.setup,
                                          run, ModelsOf(call)));
        const Surface& surface = *built;
        PM_ASSIGN_OR_RETURN(const Resolved resolved, Resolve(surface, job, run));
        const Vec3& zero = resolved.program_zero;
        std::vector<LineOrder> lines;
        const OccurringNormals normals = NeedsNormals(order.lines) ? NormalsOf(surface) : OccurringNormals();
        for (const LineOrder& line : order.lines) lines.push_back(Chosen(Placed(line, zero), normals));
        PM_ASSIGN_OR_RETURN(const std::vector<Level> levels, Trace(surface, lines, order, zero, run));
        for (const Level& level : levels) {
          v1::LineSet& set = *response->add_sets();
          const LineOrder& line = lines[static_cast<std::size_t>(level.family)];
          set.set_family_index(level.family);
          set.set_kind(line.kind);
          set.set_level(HasLevels(line) ? WireLevel(line, level.level, zero) : 0.0);
          double length = 0.0;
          for (const ZeroCurve& curve : level.curves) {
            *set.add_lines() = ToProto(surface, curve, zero);
            length += LengthOf(curve);
          }
          set.set_length_mm(length);
          AddChosen(line, set);
        }
        AddDiagnostics(HeaderRemarks(upright.model.remarks), zero, response->mutable_diagnostics());
        AddDiagnostics(surface.network.findings, zero, response->mutable_diagnostics());
        *response->mutable_patch_ids() = PatchIds(surface.network.model);
        if (request.picture()) {
          v1::ArtifactChunk& picture = *response->mutable_picture();
          picture.set_name("lines.svg");
          picture.set_media_type("image/svg+xml");
          picture.set_data(Draw(surface, lines, levels, zero, request.name()));
        }
        return absl::OkStatus();
      });
}

}  // namespace patchmill
