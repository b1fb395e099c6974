// Joining, evaluation and lines of the shape kernel.
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/joining/join_network.h"
#include "core/lines/line_family.h"
#include "core/lines/zero_curves.h"
#include "core/patch/patch.h"
#include "tests/bench/bench_parts.h"

namespace patchmill::bench {
namespace {

// cells x cells quads on a wavy sheet; with lines through all vertices and G2-Gregory faces, or edges from
// normals.
CurveNetwork Sheet(int cells, bool curvature) {
  const int side = cells + 1;
  CurveNetwork network;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      NetworkVertex vertex;
      vertex.position = Vec3(i, j, 3 * std::sin(0.11 * i) * std::cos(0.07 * j));
      network.vertices.push_back(vertex);
      if (i + 1 == side || j + 1 == side) continue;
      const int a = i * side + j;
      network.faces.push_back({"",
                               {a, a + side, a + side + 1, a + 1},
                               curvature ? PatchScheme::kG2Gregory : PatchScheme::kAuto,
                               {}});
    }
  }
  for (int k = 0; curvature && k < side; ++k) {
    NetworkLine row, column;
    for (int j = 0; j < side; ++j)
      row.vertices.push_back(k * side + j), column.vertices.push_back(j * side + k);
    network.lines.push_back(row);
    network.lines.push_back(column);
  }
  return network;
}

// 100 x 100 of them; items are faces.
void JoinFaces(benchmark::State& state, bool curvature) {
  const CurveNetwork network = Sheet(100, curvature);
  for (auto _ : state) {
    const JoinedNetwork joined = JoinNetwork(network);
    if (joined.model.patches.size() != network.faces.size()) state.SkipWithError("not joined");
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(network.faces.size()));
}
BENCHMARK_CAPTURE(JoinFaces, tangent_planes, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(JoinFaces, curvature, true)->Unit(benchmark::kMillisecond);

// Position, first and second derivatives at scattered places of one patch; items are places.
void SurfaceJets(benchmark::State& state, const PatchShape& shape) {
  std::vector<Vec2> places;
  for (int k = 0; k < 1024; ++k) {  // additive recurrence: no pattern along u or v
    const double u = 0.5 + k * 0.7548776662466927, v = 0.5 + k * 0.5698402909980532;
    places.emplace_back(u - std::floor(u), v - std::floor(v));
  }
  for (auto _ : state) {
    Vec3 sum = Vec3::Zero();
    for (const Vec2& q : places) {
      const SurfaceJet jet = Evaluate(shape, q.x(), q.y());
      sum += jet.p + jet.du + jet.dv + jet.duu + jet.duv + jet.dvv;
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(places.size()));
}

PatchShape Bicubic() {
  BezierPatch patch;
  patch.degree_u = patch.degree_v = 3;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) patch.points.push_back(Vec3(i, j, std::sin(1.3 * i) * std::cos(0.9 * j)));
  }
  return patch;
}
PatchShape OfSheet(bool curvature) { return JoinNetwork(Sheet(5, curvature)).model.patches[12].shape; }

BENCHMARK_CAPTURE(SurfaceJets, bicubic, Bicubic());
BENCHMARK_CAPTURE(SurfaceJets, gregory, OfSheet(false));
BENCHMARK_CAPTURE(SurfaceJets, g2_gregory, OfSheet(true));

// 100 levels between the lowest and the highest place, all cores; items are levels.
void TraceLines(benchmark::State& state, Part part) {
  const Surface& surface = SurfaceOf(part);
  constexpr int kLevels = 100;
  std::vector<ZeroField> fields;
  for (int k = 0; k < kLevels; ++k) {
    const double share = (k + 0.5) / kLevels;
    fields.push_back(
        FieldOf(ContourLines(), (1 - share) * surface.box.min.z() + share * surface.box.max.z()));
  }
  std::size_t curves = 0, points = 0;
  for (auto _ : state) {
    const auto traced = TraceZeroCurves(surface, fields, ZeroMeshParams(), 0.01, RunContext());
    if (!traced.ok()) return state.SkipWithError("not traced");
    curves = points = 0;
    for (const auto& level : *traced) {
      curves += level.size();
      for (const ZeroCurve& curve : level) points += curve.points.size();
    }
  }
  state.SetItemsProcessed(state.iterations() * kLevels);
  state.counters["curves"] = static_cast<double>(curves);
  state.counters["points"] = static_cast<double>(points);
}
BENCHMARK_CAPTURE(TraceLines, teapot, Part::kTeapot)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace patchmill::bench
