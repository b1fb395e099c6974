#include <fmt/format.h>

#include "cam/plan/plan.h"
#include "cam/plan/resolve.h"
#include "cam/region/reach_table.h"
#include "core/base/status.h"
#include "server/convert/report.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"
#include "server/limits.h"

namespace patchmill {
namespace {

absl::StatusOr<std::vector<double>> ReadRadii(const v1::TabulateReachRequest& request, double leave) {
  const auto& diameters = request.tool_diameters_mm();
  constexpr int kMost = static_cast<int>(kMaxReachRadii);
  if (diameters.empty() || diameters.size() > kMost) {
    return absl::InvalidArgumentError(
        fmt::format("tool_diameters_mm: {} given; must be 1 to {}", diameters.size(), kMost));
  }
  std::vector<double> radii;
  for (int i = 0; i < diameters.size(); ++i) {
    const double least = i == 0 ? limits::kMinDiameterMm : diameters[i - 1];
    const bool above = i == 0 ? diameters[i] >= least : diameters[i] > least;
    if (!(above && diameters[i] <= limits::kMaxDiameterMm)) {
      return absl::InvalidArgumentError(
          fmt::format("tool_diameters_mm[{}] = {:g}; must be {} {:g} and at most {:g}", i, diameters[i],
                      i == 0 ? "at least" : "above", least, limits::kMaxDiameterMm));
    }
    radii.push_back(0.5 * diameters[i] + leave);
  }
  return radii;
}

}  // namespace

absl::Status HandleTabulateReach(const Call& call, const v1::TabulateReachRequest& request,
                                 v1::TabulateReachResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  PM_RETURN_IF_ERROR(CheckThreads(request.max_threads(), "max_threads"));
  return RunJobThread(call, request.max_threads(), {}, [&](const RunContext& run) -> absl::Status {
    PM_ASSIGN_OR_RETURN(const PreparedJob prepared, PrepareJob(request.job(), v1::Post()));
    const Job& job = prepared.job;
    ReachTableParams params;
    PM_ASSIGN_OR_RETURN(params.radii, ReadRadii(request, job.operation.leave));
    params.tolerance = job.operation.tolerance;
    PM_RETURN_IF_ERROR(run.Check());
    PM_ASSIGN_OR_RETURN(const Surface surface, BuildPlacedSurface(prepared.model.model, job.setup, run));
    PM_ASSIGN_OR_RETURN(const Resolved resolved, Resolve(surface, job));
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
  });
}

}  // namespace patchmill
