#include "cam/path/zlevel/level_trace.h"

#include <algorithm>
#include <cmath>

#include "cam/path/zlevel/level_cells.h"
#include "cam/path/zlevel/level_chains.h"
#include "cam/path/zlevel/loop_refine.h"

namespace patchmill {
namespace {

constexpr double kShift = 1e-3;  // mm: step by which a level moves up, away from a flat at its height
// rad: surface this far outside of the window is still traced, for the overlap at the ends of passes.
constexpr double kWindowMargin = Radians(15.0);
constexpr int kMostShifts = 1;  // then the finest cells grow instead: the ball may have no room there

double SignedArea(const std::vector<LevelPoint>& loop) {
  double twice = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i)
    twice += Cross(loop[i].q - loop[0].q, loop[(i + 1) % loop.size()].q - loop[0].q);
  return 0.5 * twice;
}

LevelContours Trace(const LevelContext& context, double z, const ContourParams& params,
                    const WantedLevel* wanted, const RunContext& run) {
  LevelContours level;
  level.z = z;
  LevelCellLimits limits;
  limits.smallest = params.resolution / kCellsPerResolution;
  for (int shifts = 0; !run.Cancelled();) {
    ContactCandidates items(context.locator, context.sides, context.bounds, level.z);
    const LevelOracle oracle(context.locator, context.sides, level.z);
    LevelCells cells = FindCells(items, oracle, limits, run, wanted);
    if (cells.cancelled) return level;
    if (cells.overflow && shifts < kMostShifts) {
      level.z += kShift;
      ++shifts;
      continue;
    }
    if (cells.overflow || cells.exhausted) {
      limits.smallest *= 2.0;
      continue;
    }
    const LoopTolerance tolerance{std::max(params.pass.chord_tolerance - params.pass.certificate_gap,
                                           0.5 * params.pass.chord_tolerance),
                                  ExcessTolerance(params.pass)};
    level.cell = cells.grid.unit;
    level.ambiguous_cells = cells.ambiguous;
    const auto first = std::find_if(cells.cells.begin(), cells.cells.end(),
                                    [](const LevelCell& cell) { return cell.ambiguous; });
    if (first != cells.cells.end()) level.ambiguous_at = oracle.Center(XyRectOf(cells.grid, *first).mid);
    const LevelEdges edges = FindCrossings(cells, items, oracle, run);
    if (run.Cancelled()) return level;
    for (const Chain& chain : BuildChains(cells, edges, wanted != nullptr)) {
      if (run.Cancelled()) return level;
      const std::vector<LevelPoint> points = RefineLoop(oracle, chain, tolerance, run);
      const bool undecided =
          chain.closed && std::all_of(chain.points.begin(), chain.points.end(),
                                      [](const ChainPoint& p) { return p.onward.Ambiguous(); });
      if (points.size() < (chain.closed ? 3 : 2) ||
          (undecided && std::abs(SignedArea(points)) < limits.smallest * limits.smallest)) {
        continue;
      }
      CutterPath path;
      path.kind = PassKind::kContour;
      path.closed = chain.closed;
      path.points.reserve(points.size());
      for (const LevelPoint& p : points) path.points.push_back({oracle.Center(p.q), p.contact, p.other});
      level.loops.push_back(std::move(path));
    }
    return level;
  }
  return level;
}

}  // namespace

LevelContours TraceLevel(const LevelContext& context, double z, const ContourParams& params,
                         const RunContext& run) {
  return Trace(context, z, params, nullptr, run);
}

LevelContours TraceLevel(const Locator& locator, double z, const ContourParams& params,
                         const RunContext& run) {
  return TraceLevel(LevelContext(locator, run), z, params, run);
}

LevelContours TracePasses(const LevelContext& context, double z, const NearSpotsMask* where,
                          const ContourParams& params, const RunContext& run) {
  WantedLevel wanted{params.pass.window, where};
  wanted.window.min -= kWindowMargin;
  wanted.window.max += kWindowMargin;
  return Trace(context, z, params, &wanted, run);
}

}  // namespace patchmill
