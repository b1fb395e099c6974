#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "cam/picture/preview.h"
#include "cam/plan/plan.h"
#include "cam/plan/resolve.h"
#include "core/base/status.h"
#include "server/convert/fields.h"
#include "server/convert/lines.h"
#include "server/convert/report.h"
#include "server/convert/setup.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"
#include "server/limits.h"
#include "server/placed_surface.h"
#include "server/trace_levels.h"

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

// From blue for the lowest level of a family to red for the highest.
std::string Color(double share) {
  const auto mix = [&](int a, int b) { return a + static_cast<int>(share * (b - a)); };
  return fmt::format("#{:02x}{:02x}{:02x}", mix(20, 200), mix(70, 30), mix(190, 30));
}

std::string Draw(const Surface& surface, const std::vector<LineOrder>& lines,
                 const std::vector<TracedLevel>& levels, const Vec3& zero, const std::string& title) {
  PreviewInput input;
  input.surface = &surface;
  input.title = title;
  input.program_zero = zero;
  std::vector<int> count(lines.size(), 0), seen(lines.size(), 0);
  for (const TracedLevel& level : levels) ++count[static_cast<std::size_t>(level.family)];
  for (const TracedLevel& level : levels) {
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

// One for each family of lines of curvature that has no line because of the shape.
Diagnostics UmbilicFindings(const std::vector<TracedLevel>& levels) {
  Diagnostics findings;
  for (const TracedLevel& level : levels) {
    if (!level.all_umbilic) continue;
    findings.push_back(MakeInfo(
        "CURVATURES_ALIKE",
        fmt::format(
            "there are no lines of curvature: both principal curvatures are alike (to {:g} of their mean) "
            "all over the surface, as on planes and spheres",
            kUmbilic),
        {.field = fmt::format("families[{}]", level.family)}));
  }
  return findings;
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
        TraceParams params{{}, order.tolerance, zero};
        params.mesh.min_cell = order.min_loop;
        params.mesh.max_cell = std::max(params.mesh.max_cell, order.min_loop);
        PM_ASSIGN_OR_RETURN(const std::vector<TracedLevel> levels, TraceLevels(surface, lines, params, run));
        for (const TracedLevel& level : levels) {
          const LineOrder& line = lines[static_cast<std::size_t>(level.family)];
          v1::LineSet& set = *response->add_sets() = SetOf(level, line, zero);
          for (const ZeroCurve& curve : level.curves) *set.add_lines() = ToProto(surface, curve, zero);
        }
        AddDiagnostics(HeaderRemarks(upright.model.remarks), zero, response->mutable_diagnostics());
        AddDiagnostics(UmbilicFindings(levels), zero, response->mutable_diagnostics());
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
