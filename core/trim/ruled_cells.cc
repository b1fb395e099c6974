#include "core/trim/ruled_cells.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/index.h"
#include "core/math/tensor_bernstein.h"
#include "core/trim/strip_net.h"
#include "core/trim/trapezoids.h"

namespace patchmill {
namespace {

constexpr double kThinnestRuled = 1e-6;  // mm
// mm: walls closer to each other become one. Ends of borders move by a tenth of the border tolerance at most.
constexpr double kSameWall = 1e-5;

// The graph as an arc in the carrier's parameters, from its lower end in U to the higher one.
BorderArc ArcOf(const GridGraph& graph, GridCell cell) {
  BorderArc arc;
  const auto n = graph.c.size() - 1;
  for (std::size_t k = 0; k <= n; ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(n);
    const double x = k == n ? graph.to : graph.from + part * (graph.to - graph.from);
    const double u = graph.along_u ? x : graph.c[k], v = graph.along_u ? graph.c[k] : x;
    arc.points.push_back({std::clamp(u - cell.i, 0.0, 1.0), std::clamp(v - cell.j, 0.0, 1.0), 1.0});
  }
  if (arc.x0() > arc.x1()) std::reverse(arc.points.begin(), arc.points.end());
  return arc;
}

// Whether u runs evenly along the arcs.
bool RunsEvenly(const BorderArc& arc) {
  const int n = arc.degree();
  for (int k = 0; k <= n; ++k) {
    const double even = arc.x0() + (arc.x1() - arc.x0()) * k / n;
    if (std::abs(arc.points[At(k)].x() - even) > 1e-13) return false;
  }
  return true;
}

GridGraph GraphOf(const BorderArc& arc) {
  GridGraph graph{true, arc.x0(), arc.x1(), {}};
  for (const Vec3& p : arc.points) graph.c.push_back(std::clamp(p.y(), 0.0, 1.0));
  return graph;
}

ScaledBernstein<double> ScaledOf(const BorderArc& arc, int axis, bool complement) {
  const int n = arc.degree();
  ScaledBernstein<double> form(n, 0, 0.0);
  for (int k = 0; k <= n; ++k) {
    const double x = std::clamp(arc.points[At(k)][axis], 0.0, 1.0);
    form(k, 0) = Binomial(n, k) * (complement ? 1.0 - x : x);
  }
  return form;
}

// S(u(s), v(s)) for a carrier that is linear in v.
std::vector<Vec4> RowOn(const BernsteinNet& carrier, const BorderArc& arc) {
  const int p = carrier.degree_u, n = arc.degree();
  const auto u = ScaledOf(arc, 0, false), w = ScaledOf(arc, 0, true), v = ScaledOf(arc, 1, false),
             rest = ScaledOf(arc, 1, true);
  ScaledBernstein<Vec4> row(p * n + n, 0, Vec4::Zero());
  for (int i = 0; i <= p; ++i) {
    ScaledBernstein<double> basis(0, 0, Binomial(p, i));
    for (int k = 0; k < p; ++k) {
      ScaledBernstein<double> next(basis.m + n, 0, 0.0);
      basis.MultiplyInto(k < i ? u : w, next);
      basis = next;
    }
    for (const bool high : {false, true}) {
      ScaledBernstein<double> factor(basis.m + n, 0, 0.0);
      basis.MultiplyInto(high ? v : rest, factor);
      const Vec4& point = carrier.points[At(2 * i + (high ? 1 : 0))];
      for (int k = 0; k <= factor.m; ++k) row(k, 0) += factor(k, 0) * point;
    }
  }
  return row.Unscaled();
}

}  // namespace

bool IsRuled(const CarrierGrid& grid) {
  return grid.v.count() == 1 &&
         std::all_of(grid.carriers.begin(), grid.carriers.end(), [](const Piece& piece) {
           return piece.net.degree_v == 1 && 3 * piece.net.degree_u + 3 <= kMaxDegree;
         });
}

absl::StatusOr<RuledPatches> CutRuledCarrier(const CarrierGrid& grid, GridCell cell,
                                             const std::vector<GridGraph>& border, const RunContext& run) {
  const BernsteinNet& carrier = grid.carrier(cell.i, cell.j).net;
  std::vector<BorderArc> arcs;
  for (const GridGraph& graph : border) {
    BorderArc arc = ArcOf(graph, cell);
    if (arc.x0() < arc.x1()) arcs.push_back(std::move(arc));
  }
  const SurfaceJet jet = JetAt(grid, cell, {cell.i + 0.5, cell.j + 0.5});
  const double per_u = std::max(jet.du.norm(), 1e-12 * grid.size);
  const WalledArcs walled = ArcsBetweenWalls(std::move(arcs), kSameWall / per_u);
  const absl::StatusOr<Trapezoids> cut =
      CutIntoTrapezoids(walled.arcs, kThinnestRuled / std::max(jet.dv.norm(), 1e-12 * grid.size), run);
  if (!cut.ok()) return cut.status();
  RuledPatches patches{{}, walled.moved * per_u};
  std::vector<BernsteinNet>& nets = patches.nets;
  for (const ArcPair& pair : cut->pairs) {
    if (RunsEvenly(pair.below)) {
      const Strip strip{GraphOf(pair.below), GraphOf(pair.above)};
      const bool level = strip.low.level() && strip.high.level();
      nets.push_back(level ? SubNet(carrier, strip.low.from, strip.low.to, strip.low.c[0], strip.high.c[0])
                           : StripNet(carrier, strip));
      continue;
    }
    const std::vector<Vec4> low = RowOn(carrier, pair.below), high = RowOn(carrier, pair.above);
    BernsteinNet net{static_cast<int>(low.size()) - 1, 1, carrier.rational, {}};
    for (std::size_t k = 0; k < low.size(); ++k) {
      net.points.push_back(low[k]);
      net.points.push_back(high[k]);
    }
    nets.push_back(std::move(net));
  }
  return patches;
}

}  // namespace patchmill
