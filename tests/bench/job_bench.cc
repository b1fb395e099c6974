// Whole jobs, from the model to the verified program, and the verifier alone; on all cores, wall clock.
#include <benchmark/benchmark.h>

#include "cam/path/stepover/across_feed.h"
#include "cam/path/stepover/step_over.h"
#include "cam/plan/job_preview.h"
#include "cam/plan/plan.h"
#include "cam/plan/region_points.h"
#include "cam/plan/resolve.h"
#include "core/base/enum_array.h"
#include "core/base/status.h"
#include "tests/bench/bench_parts.h"
#include "tests/bench/over_plain.h"

namespace patchmill::bench {
namespace {

absl::StatusOr<JobResult> RunVerified(const Surface& surface, const Job& job) {
  absl::StatusOr<JobResult> result = RunJob(surface, job, RunContext());
  if (result.ok() && result->program.empty()) {
    return absl::InternalError(std::string("no program: ") + Name(result->report.outcome));
  }
  return result;
}

// m of passes of each kind.
EnumArray<PassKind, double> LengthsByKind(const LinkResult& motion) {
  EnumArray<PassKind, double> lengths{};
  for (const CutterPath& pass : motion.passes) lengths[pass.kind] += 1e-3 * Length(pass);
  return lengths;
}

// mm: the integral of LeastCutLength, but with the step across the passes that each place gets (contours, or
// the lines of its region as if they did not bend) instead of the widest step. It is the feed length if
// passes cost no more than the scallop needs. The rest of the feed is for their ends, for steps narrower
// than necessary, and for links.
double FeedInItsDirections(const Surface& surface, const Job& job, const JobResult& result, double radius) {
  const RegionMap& map = result.regions;
  const RegionPoints points(surface, map);
  const auto reachable = [&](RegionId id) {
    return map.regions[id.index()].kind != RegionKind::kUnreachable;
  };
  double sum = 0.0;
  for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
    points.VisitPiece(i, reachable, [&](const RegionPoint& at) {
      const SurfaceJet& jet = at.jet;
      const Vec3& e = at.normal;
      const RegionChoice& choice = result.report.choices[at.region.index()];
      const auto across = e.z() < std::cos(job.operation.steep_angle)
                              ? AcrossContours(e)
                              : AcrossLines(e, LineAt(choice, map.ComponentAt(i, at.cell), jet.p));
      const FundamentalForms forms = Forms(jet, e);
      const PrincipalCurvatures k = Principal(forms);
      if (!across || !(k.k_max * radius < 1.0)) return;
      const double step = CenterStep(radius, choice.scallop, NormalCurvature(forms, jet, *across));
      const double centers = (1.0 - k.k_min * radius) * (1.0 - k.k_max * radius);
      if (step > 0.0) sum += jet.du.cross(jet.dv).norm() * centers / step;
    });
  }
  return sum * points.Share();
}

absl::StatusOr<JobResult> RunFromModel(const PatchModel& model, const Job& job) {
  PM_ASSIGN_OR_RETURN(const Surface surface, BuildPlacedSurface(model, job.setup, RunContext()));
  return RunVerified(surface, job);
}

// Everything that a request costs except the wire (JobOverWire): placing, surface, RunJob. peak_MB is the
// largest resident memory of the process. It includes parts kept by earlier benchmarks: run this one alone
// for a figure.
void MeasureJob(benchmark::State& state, Part part) {
  const PatchModel& model = ModelOf(part);
  const Job job = JobOf(part);
  JobResult result;
  ResetPeakMemory();
  for (auto _ : state) {
    auto made = RunFromModel(model, job);
    if (!made.ok()) return state.SkipWithError(made.status().ToString().c_str());
    result = *std::move(made);
  }
  state.counters["peak_MB"] = PeakMemory();
  const JobReport& report = result.report;
  const EnumArray<PassKind, double> lengths = LengthsByKind(result.motion);
  state.counters["moves"] = report.point_count;
  state.counters["feed_m"] = 1e-3 * report.verify.cut_length;
  state.counters["over_least"] = report.verify.cut_length / report.least_cut_length;
  if (const auto resolved = Resolve(SurfaceOf(part), job, RunContext()); resolved.ok()) {
    state.counters["directions_over_least"] =
        FeedInItsDirections(SurfaceOf(part), job, result, resolved->plan_radius) / report.least_cut_length;
  }
  state.counters["lines_m"] = lengths[PassKind::kZigzag];
  state.counters["contours_m"] = lengths[PassKind::kContour];
  state.counters["borders_m"] = lengths[PassKind::kBorder];
  state.counters["rest_m"] = lengths[PassKind::kPencil] + lengths[PassKind::kRest];
  state.counters["retracts"] = static_cast<double>(report.motion.retract_count);
  state.counters["program_MB"] = 1e-6 * static_cast<double>(result.program.size());
  for (const StageTime& stage : report.stages) state.counters["s_" + stage.name] = stage.seconds;
  TellInstructionSet(state, 2, [&] { benchmark::DoNotOptimize(RunFromModel(model, job)); });
}
BENCHMARK_CAPTURE(MeasureJob, two_hills, Part::kTwoHills)
    ->Name("Job/two_hills")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(MeasureJob, teapot, Part::kTeapot)
    ->Name("Job/teapot")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

// The verifier on the program of Job/teapot. The items are the moves of the program.
void MeasureVerify(benchmark::State& state, Part part) {
  const Surface& surface = SurfaceOf(part);
  const Job job = JobOf(part);
  const auto resolved = Resolve(surface, job, RunContext());
  if (!resolved.ok()) return state.SkipWithError(resolved.status().ToString().c_str());
  const auto result = RunVerified(surface, job);
  if (!result.ok()) return state.SkipWithError(result.status().ToString().c_str());
  const VerifyParams params = MakeVerifyParams(job, *resolved);
  for (auto _ : state) {
    const auto report = VerifyProgramText(surface, job.operation.tool, result->program, params, RunContext());
    if (!report.ok() || !report->ok()) return state.SkipWithError("the program does not verify");
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(result->report.point_count) * state.iterations());
}
BENCHMARK_CAPTURE(MeasureVerify, teapot, Part::kTeapot)
    ->Name("Verify/teapot")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace patchmill::bench
