#include "core/trim/face_cells.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <tuple>
#include <utility>

#include <absl/status/status.h>
#include <absl/strings/str_format.h>

#include "core/math/bernstein.h"
#include "core/trim/ruled_cells.h"
#include "core/trim/strip_net.h"

namespace patchmill {
namespace {

constexpr double kThinnestStrip = 1e-6;  // mm
constexpr int kMaxCuts = 200;            // one within another
// A line through a cell that no symmetry of a part prefers.
constexpr double kProbe = 0.41421356;

struct Cell {
  double low[2], high[2];  // grid coordinates
  double middle(int axis) const { return 0.5 * (low[axis] + high[axis]); }
};

GridGraph LevelGraph(bool along_u, double from, double to, double value) {
  return {along_u, from, to, {value, value}};
}

// Lines of constant coordinate that continue one another become one. Others stay as they are.
std::vector<GridGraph> WithoutNeedlessEnds(std::vector<GridGraph> graphs) {
  const auto key = [](const GridGraph& g) {
    return std::make_tuple(!g.level(), !g.along_u, g.c.front(), g.from);
  };
  std::stable_sort(graphs.begin(), graphs.end(),
                   [&](const GridGraph& a, const GridGraph& b) { return key(a) < key(b); });
  std::vector<GridGraph> merged;
  for (GridGraph& g : graphs) {
    if (!merged.empty() && g.level() && merged.back().level() && merged.back().along_u == g.along_u &&
        merged.back().c.front() == g.c.front() && merged.back().to == g.from) {
      merged.back().to = g.to;
    } else {
      merged.push_back(std::move(g));
    }
  }
  return merged;
}

class CarrierCells {
 public:
  CarrierCells(const CarrierGrid& grid, GridCell at, const std::vector<GridGraph>& column, double tolerance)
      : grid_(grid), at_(at), column_(column), tolerance_(tolerance) {
    const SurfaceJet jet = JetAt(grid, at, {at.i + kProbe, at.j + kProbe});
    const BernsteinNet& net = grid.carrier(at.i, at.j).net;
    per_unit_[0] = std::max(jet.du.norm(), 1e-12 * grid.size);
    per_unit_[1] = std::max(jet.dv.norm(), 1e-12 * grid.size);
    max_degree_[0] = LargestStripDegree(net, true);
    max_degree_[1] = LargestStripDegree(net, false);
  }

  absl::Status Run(std::vector<GridGraph> graphs, FacePatches& out) {
    out_ = &out;
    const double i = at_.i, j = at_.j;
    return Divide({{i, j}, {i + 1.0, j + 1.0}}, std::move(graphs), 0);
  }

 private:
  absl::Status Divide(const Cell& cell, std::vector<GridGraph> graphs, int depth) {
    std::erase_if(graphs, [&](const GridGraph& g) {
      const int across = g.along_u ? 1 : 0;
      return g.level() && (g.c.front() <= cell.low[across] || g.c.front() >= cell.high[across]);
    });
    graphs = WithoutNeedlessEnds(std::move(graphs));
    if (graphs.empty()) {
      const Vec2 probe(cell.low[0] + kProbe * (cell.high[0] - cell.low[0]), cell.middle(1));
      if (InsideBorder(column_, probe)) EmitStrip(Bottom(cell, true), Top(cell, true), 0);
      return absl::OkStatus();
    }
    for (const bool along_u : {true, false}) {
      if (const auto stack = AsStack(cell, graphs, along_u)) {
        EmitStack(cell, *stack, along_u);
        return absl::OkStatus();
      }
    }
    if (depth > kMaxCuts) {
      if (const double size = SizeOf(cell); size <= tolerance_) {
        // Borders that cross by less than they may be off anyway: the middle decides.
        out_->border_error = std::max(out_->border_error, size);
        if (InsideBorder(column_, {cell.middle(0), cell.middle(1)}))
          EmitStrip(Bottom(cell, true), Top(cell, true), 0);
        return absl::OkStatus();
      }
      return absl::FailedPreconditionError(absl::StrFormat(
          "borders cross near the grid coordinates %.6f %.6f", cell.middle(0), cell.middle(1)));
    }
    const auto [axis, at] = BestCut(cell, graphs);
    Cell low = cell, high = cell;
    low.high[axis] = high.low[axis] = at;
    std::vector<GridGraph> below, above;
    for (const GridGraph& g : graphs) {
      if (g.highest(axis) <= at) {
        below.push_back(g);
      } else if (g.lowest(axis) >= at) {
        above.push_back(g);
      } else {
        GraphParts parts = CutGraph(g, axis, at);
        below.push_back(std::move(parts.low));
        above.push_back(std::move(parts.high));
      }
    }
    if (const absl::Status done = Divide(low, std::move(below), depth + 1); !done.ok()) return done;
    return Divide(high, std::move(above), depth + 1);
  }

  // About: the length of the cell's diagonal, mm.
  double SizeOf(const Cell& cell) const {
    const SurfaceJet jet = JetAt(grid_, at_, {cell.middle(0), cell.middle(1)});
    return std::hypot((cell.high[0] - cell.low[0]) * jet.du.norm(),
                      (cell.high[1] - cell.low[1]) * jet.dv.norm());
  }

  // The graphs from bottom to top, if all of them cross the cell from side to side along the axis.
  std::optional<std::vector<GridGraph>> AsStack(const Cell& cell, const std::vector<GridGraph>& graphs,
                                                bool along_u) const {
    const int axis = along_u ? 0 : 1;
    std::vector<GridGraph> stack;
    for (const GridGraph& g : graphs) {
      if (g.lowest(axis) != cell.low[axis] || g.highest(axis) != cell.high[axis]) return std::nullopt;
      if (g.along_u == along_u) {
        stack.push_back(g);
        continue;
      }
      const std::optional<GridGraph> turned =
          TurnedGraph(g, max_degree_[axis]);  // at least 1 here: g is no line
      if (!turned || TurningError(g, *turned) > tolerance_) return std::nullopt;
      stack.push_back(*turned);
    }
    const double probe = cell.low[axis] + kProbe * (cell.high[axis] - cell.low[axis]);
    std::stable_sort(stack.begin(), stack.end(), [&](const GridGraph& a, const GridGraph& b) {
      return ValueAt(a, probe) < ValueAt(b, probe);
    });
    for (std::size_t k = 0; k + 1 < stack.size(); ++k) {
      if (stack[k].c.front() > stack[k + 1].c.front() || stack[k].c.back() > stack[k + 1].c.back())
        return std::nullopt;
    }
    return stack;
  }

  double TurningError(const GridGraph& graph, const GridGraph& turned) const {
    double error = 0.0;
    for (int k = 0; k < 8; ++k) {
      const double x = turned.from + (turned.to - turned.from) * (k + 0.5) / 8.0;
      error = std::max(error, std::abs(ValueAt(turned, x) - WhereValue(graph, x)));
    }
    return error * per_unit_[turned.along_u ? 1 : 0];
  }

  void EmitStack(const Cell& cell, const std::vector<GridGraph>& stack, bool along_u) {
    const int axis = along_u ? 0 : 1;
    const double probe = cell.low[axis] + kProbe * (cell.high[axis] - cell.low[axis]);
    const double lowest = cell.low[1 - axis];
    const double first = 0.5 * (lowest + ValueAt(stack.front(), probe));
    bool inside = InsideBorder(column_, along_u ? Vec2(probe, first) : Vec2(first, probe));
    GridGraph below = Bottom(cell, along_u);
    for (const GridGraph& g : stack) {
      if (inside) EmitStrip(below, g, 0);
      below = g;
      inside = !inside;
    }
    if (inside) EmitStrip(below, Top(cell, along_u), 0);
  }

  static GridGraph Bottom(const Cell& cell, bool along_u) {
    const int axis = along_u ? 0 : 1;
    return LevelGraph(along_u, cell.low[axis], cell.high[axis], cell.low[1 - axis]);
  }
  static GridGraph Top(const Cell& cell, bool along_u) {
    const int axis = along_u ? 0 : 1;
    return LevelGraph(along_u, cell.low[axis], cell.high[axis], cell.high[1 - axis]);
  }

  void EmitStrip(GridGraph low, GridGraph high, int halvings) {
    const int axis = low.along_u ? 0 : 1;
    while (low.c.size() < high.c.size()) low.c = BernsteinElevate(low.c);
    while (high.c.size() < low.c.size()) high.c = BernsteinElevate(high.c);
    double most = 0.0;
    bool crossing = false;
    for (std::size_t k = 0; k < low.c.size(); ++k) {
      most = std::max(most, high.c[k] - low.c[k]);
      crossing = crossing || high.c[k] < low.c[k];
    }
    const double width = most * per_unit_[1 - axis];
    if (width < kThinnestStrip || (low.to - low.from) * per_unit_[axis] < kThinnestStrip) {
      out_->dropped_area += 0.5 * width * (low.to - low.from) * per_unit_[axis];
      return;
    }
    if (crossing && halvings < 6) {
      const double middle = 0.5 * (low.from + low.to);
      const GraphParts a = CutGraph(low, axis, middle), b = CutGraph(high, axis, middle);
      EmitStrip(a.low, b.low, halvings + 1);
      EmitStrip(a.high, b.high, halvings + 1);
      return;
    }
    for (std::size_t k = 0; k < low.c.size(); ++k) high.c[k] = std::max(high.c[k], low.c[k]);
    const double along = axis == 0 ? at_.i : at_.j, across = axis == 0 ? at_.j : at_.i;
    const auto local = [&](GridGraph g) {
      g.from = std::clamp(g.from - along, 0.0, 1.0);
      g.to = std::clamp(g.to - along, 0.0, 1.0);
      for (double& c : g.c) c = std::clamp(c - across, 0.0, 1.0);
      return g;
    };
    const Strip strip{local(low), local(high)};
    const BernsteinNet& carrier = grid_.carrier(at_.i, at_.j).net;
    if (strip.low.level() && strip.high.level()) {
      const double a0 = strip.low.from, a1 = strip.low.to, b0 = strip.low.c[0], b1 = strip.high.c[0];
      out_->nets.push_back(axis == 0 ? SubNet(carrier, a0, a1, b0, b1) : SubNet(carrier, b0, b1, a0, a1));
    } else {
      out_->nets.push_back(StripNet(carrier, strip));
    }
  }

  struct Cut {
    int axis = 0;
    double at = 0.0;
  };
  // At an end of a graph inside the cell, where the fewest others are cut; of equal ones the most central.
  static Cut BestCut(const Cell& cell, const std::vector<GridGraph>& graphs) {
    std::optional<Cut> best;
    std::pair<int, double> best_cost;
    for (int axis = 0; axis < 2; ++axis) {
      std::vector<double> ends;
      for (const GridGraph& g : graphs) {
        for (const double x : {g.lowest(axis), g.highest(axis)}) {
          if (x > cell.low[axis] && x < cell.high[axis]) ends.push_back(x);
        }
      }
      std::sort(ends.begin(), ends.end());
      ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
      for (const double x : ends) {
        int crossed = 0;
        for (const GridGraph& g : graphs) {
          if (g.lowest(axis) < x && x < g.highest(axis)) ++crossed;
        }
        const std::pair<int, double> cost(
            crossed, std::abs(x - cell.middle(axis)) / (cell.high[axis] - cell.low[axis]));
        if (!best || cost < best_cost) {
          best = Cut{axis, x};
          best_cost = cost;
        }
      }
    }
    if (best) return *best;
    const int axis = cell.high[0] - cell.low[0] >= cell.high[1] - cell.low[1] ? 0 : 1;
    return {axis, cell.middle(axis)};
  }

  const CarrierGrid& grid_;
  const GridCell at_;
  const std::vector<GridGraph>& column_;
  const double tolerance_;
  double per_unit_[2];
  int max_degree_[2];
  FacePatches* out_ = nullptr;
};

}  // namespace

bool InsideBorder(const std::vector<GridGraph>& border, const Vec2& place) {
  bool inside = false;
  for (const GridGraph& g : border) {
    if (!(g.lowest(0) <= place.x() && place.x() < g.highest(0)) || g.highest(1) <= place.y()) continue;
    const double v = g.along_u ? ValueAt(g, place.x()) : WhereValue(g, place.x());
    if (v > place.y()) inside = !inside;
  }
  return inside;
}

absl::StatusOr<FacePatches> CutFace(const CarrierGrid& grid, const std::vector<GridGraph>& border,
                                    double tolerance, const RunContext& run) {
  const auto rows = static_cast<std::size_t>(grid.v.count());
  std::vector<std::vector<GridGraph>> columns(static_cast<std::size_t>(grid.u.count()));
  std::vector<std::vector<GridGraph>> cells(grid.carriers.size());
  for (const GridGraph& g : border) {
    const GridCell at = CellAt(grid, 0.5 * (g.start() + g.end()));
    columns[static_cast<std::size_t>(at.i)].push_back(g);
    cells[static_cast<std::size_t>(at.i) * rows + static_cast<std::size_t>(at.j)].push_back(g);
  }
  FacePatches patches;
  const bool ruled = IsRuled(grid);
  for (int i = 0; i < grid.u.count(); ++i) {
    if (const absl::Status status = run.Check(); !status.ok()) return status;
    for (int j = 0; j < grid.v.count(); ++j) {
      const auto index = static_cast<std::size_t>(i) * rows + static_cast<std::size_t>(j);
      if (ruled) {
        absl::StatusOr<RuledPatches> cut =
            CutRuledCarrier(grid, {i, j}, WithoutNeedlessEnds(std::move(cells[index])), run);
        if (!cut.ok()) return cut.status();
        std::move(cut->nets.begin(), cut->nets.end(), std::back_inserter(patches.nets));
        patches.border_error = std::max(patches.border_error, cut->moved);
        continue;
      }
      CarrierCells carrier(grid, {i, j}, columns[static_cast<std::size_t>(i)], tolerance);
      if (const absl::Status status = carrier.Run(std::move(cells[index]), patches); !status.ok())
        return status;
    }
  }
  return patches;
}

}  // namespace patchmill
