#include "core/trim/grid_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/math/bernstein.h"

namespace patchmill {
namespace {

int DegreeOf(const GridGraph& graph) { return static_cast<int>(graph.c.size()) - 1; }

double PolynomialAt(const std::vector<double>& c, double s) {
  std::array<double, kMaxBasisDegree + 1> b;
  const int n = static_cast<int>(c.size()) - 1;
  AllBernstein(n, s, b.data());
  double sum = 0.0;
  for (int i = 0; i <= n; ++i) sum += b[static_cast<std::size_t>(i)] * c[static_cast<std::size_t>(i)];
  return sum;
}

}  // namespace

bool GridGraph::level() const {
  return std::all_of(c.begin(), c.end(), [this](double x) { return x == c.front(); });
}
double GridGraph::lowest(int axis) const {
  return (axis == 0) == along_u ? from : std::min(c.front(), c.back());
}
double GridGraph::highest(int axis) const {
  return (axis == 0) == along_u ? to : std::max(c.front(), c.back());
}

GridGraph StraightGraph(const Vec2& a, const Vec2& b) {
  const Vec2 d = (b - a).cwiseAbs();
  GridGraph graph;
  graph.along_u = d.x() >= d.y();
  const int axis = graph.along_u ? 0 : 1;
  const Vec2 &low = a[axis] < b[axis] ? a : b, &high = a[axis] < b[axis] ? b : a;
  graph.from = low[axis];
  graph.to = high[axis];
  graph.c = {low[1 - axis], high[1 - axis]};
  return graph;
}

double ValueAt(const GridGraph& graph, double x) {
  if (x <= graph.from) return graph.c.front();
  if (x >= graph.to) return graph.c.back();
  return PolynomialAt(graph.c, (x - graph.from) / (graph.to - graph.from));
}

double WhereValue(const GridGraph& graph, double value) {
  double low = 0.0, high = 1.0;
  const bool rises = graph.c.back() > graph.c.front();
  while (true) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high || high - low < 1e-17) break;
    ((PolynomialAt(graph.c, middle) < value) == rises ? low : high) = middle;
  }
  return graph.from + 0.5 * (low + high) * (graph.to - graph.from);
}

GraphParts CutGraph(const GridGraph& graph, int axis, double at) {
  const bool own = (axis == 0) == graph.along_u;
  const double x = own ? at : WhereValue(graph, at);
  const double s = std::clamp((x - graph.from) / (graph.to - graph.from), 0.0, 1.0);
  GridGraph before = graph, after = graph;
  if (!graph.level()) {  // a level graph stays exactly level
    KeepLeft(before.c.data(), DegreeOf(graph), 1, s);
    KeepRight(after.c.data(), DegreeOf(graph), 1, s);
  }
  before.to = after.from = x;
  before.c.back() = after.c.front() = own ? before.c.back() : at;
  const bool rises = own || graph.c.back() > graph.c.front();
  return rises ? GraphParts{before, after} : GraphParts{after, before};
}

std::optional<GridGraph> TurnedGraph(const GridGraph& graph, int degree) {
  if (graph.c.front() == graph.c.back()) return std::nullopt;
  GridGraph turned;
  turned.along_u = !graph.along_u;
  const bool rises = graph.c.back() > graph.c.front();
  turned.from = rises ? graph.c.front() : graph.c.back();
  turned.to = rises ? graph.c.back() : graph.c.front();
  std::vector<double> values;
  for (int k = 0; k <= degree; ++k) {
    const double x = turned.from + (turned.to - turned.from) * k / degree;
    values.push_back(k == 0 ? (rises ? graph.from : graph.to)
                            : (k == degree ? (rises ? graph.to : graph.from) : WhereValue(graph, x)));
  }
  turned.c = ThroughValues(values);
  return turned;
}

std::vector<double> ThroughValues(const std::vector<double>& values) {
  std::vector<double> c = values;
  if (values.size() == 3) c[1] = 2.0 * values[1] - 0.5 * (values[0] + values[2]);
  if (values.size() == 4) {
    c[1] = (-5.0 * values[0] + 18.0 * values[1] - 9.0 * values[2] + 2.0 * values[3]) / 6.0;
    c[2] = (2.0 * values[0] - 9.0 * values[1] + 18.0 * values[2] - 5.0 * values[3]) / 6.0;
  }
  const double low = std::min(c.front(), c.back()), high = std::max(c.front(), c.back());
  const bool rises = c.back() >= c.front();
  for (std::size_t i = 1; i + 1 < c.size(); ++i) {
    c[i] = rises ? std::clamp(c[i], c[i - 1], high) : std::clamp(c[i], low, c[i - 1]);
  }
  return c;
}

}  // namespace patchmill
