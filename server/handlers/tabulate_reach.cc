#include <utility>

#include <fmt/format.h>

#include "cam/plan/plan.h"
#include "cam/plan/resolve.h"
#include "cam/region/figures/reach_table.h"
#include "core/base/status.h"
#include "server/convert/fields.h"
#include "server/convert/report.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"
#include "server/limits.h"
#include "server/placed_surface.h"

namespace patchmill {
namespace {

absl::Status CheckDiameters(const google::protobuf::RepeatedField<double>& diameters) {
  constexpr int kMost = static_cast<int>(kMaxReachRadii);
  FieldErrors errors;
  if (diameters.empty()) errors.Missing("tool_diameters_mm");
  if (diameters.size() > kMost) {
    errors.Add("tool_diameters_mm",
               fmt::format("has {} elements; must have at most {}", diameters.size(), kMost));
    return errors.ToStatus();
  }
  for (int i = 0; i < diameters.size(); ++i) {
    const std::string field = fmt::format("tool_diameters_mm[{}]", i);
    const double d = diameters[i];
    if (!Require(errors, field, d, d >= limits::kMinDiameterMm && d <= limits::kMaxDiameterMm,
                 fmt::format("in [{}, {}]", limits::kMinDiameterMm, limits::kMaxDiameterMm))) {
      continue;
    }
    if (i > 0)
      Require(errors, field, d, d > diameters[i - 1],
              fmt::format("above the one before, {:.10g}", diameters[i - 1]));
  }
  return errors.ToStatus();
}

}  // namespace

absl::Status HandleTabulateReach(const Call& call, const v1::TabulateReachRequest& request,
                                 v1::TabulateReachResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  PM_RETURN_IF_ERROR(CheckThreads(request.max_threads(), "max_threads"));
  PM_RETURN_IF_ERROR(CheckDiameters(request.tool_diameters_mm()));
  const auto make = [&](const RunContext& run) -> absl::Status {
    PM_ASSIGN_OR_RETURN(PreparedJob prepared, PrepareJob(request.job(), v1::Post(), run, ModelsOf(call)));
    const Job& job = prepared.job;
    ReachTableParams params;
    for (const double d : request.tool_diameters_mm()) params.radii.push_back(0.5 * d + job.operation.leave);
    params.tolerance = job.operation.tolerance;
    if (const double least = 4.0 * params.tolerance - 2.0 * job.operation.leave;
        request.tool_diameters_mm(0) <= least) {
      FieldErrors errors;
      Require(errors, "tool_diameters_mm[0]", request.tool_diameters_mm(0), false,
              fmt::format("above {:.10g}, four tolerances less twice the stock to leave", least));
      return errors.ToStatus();
    }
    PM_RETURN_IF_ERROR(run.Check());
    PM_ASSIGN_OR_RETURN(const std::shared_ptr<const Surface> built,
                        PlacedSurface(std::move(prepared.model.model), prepared.model.digest, job.setup, run,
                                      ModelsOf(call)));
    const Surface& surface = *built;
    PM_ASSIGN_OR_RETURN(const Resolved resolved, Resolve(surface, job, run));
    params.floor_z = resolved.floor_z - job.operation.leave;
    PM_ASSIGN_OR_RETURN(const ReachTableResult table, ReachTable(surface, params, run));
    response->set_area_mm2(table.area);
    for (int i = 0; i < request.tool_diameters_mm_size(); ++i) {
      v1::ReachEntry& entry = *response->add_entries();
      entry.set_tool_diameter_mm(request.tool_diameters_mm(i));
      entry.set_unreachable_area_mm2(table.unreachable[static_cast<std::size_t>(i)]);
      entry.set_largest_tool_area_mm2(table.largest[static_cast<std::size_t>(i)]);
    }
    AddDiagnostics(job.model_remarks, resolved.program_zero, response->mutable_diagnostics());
    AddDiagnostics(surface.network.findings, resolved.program_zero, response->mutable_diagnostics());
    return absl::OkStatus();
  };
  return RunJobCall(call, {.max_threads = request.max_threads()},
                    [&](const RunContext& run) { return InJob(make(run)); });
}

}  // namespace patchmill
