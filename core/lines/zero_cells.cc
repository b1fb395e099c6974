#include "core/lines/zero_cells.h"

#include <algorithm>
#include <bitset>
#include <cmath>

#include "core/base/progress_throttle.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

// All sets of places of a 3 x 3 grid, as bits, that a straight line can divide from the other places. There
// are 58 sets. Half-planes with small integer coefficients give all of them.
std::bitset<512> CutsByLines() {
  std::bitset<512> cuts;
  for (int a = -3; a <= 3; ++a) {
    for (int b = -3; b <= 3; ++b) {
      for (int c = -13; c <= 13; c += 2) {  // odd numbers, compared with even ones
        unsigned in = 0;
        for (int place = 0; place < 9; ++place) {
          if (2 * (a * (place / 3 - 1) + b * (place % 3 - 1)) > c) in |= 1U << place;
        }
        cuts.set(in);
      }
    }
  }
  PM_CHECK(cuts.count() == 58);
  return cuts;
}

constexpr int kExtraLevels = 2;  // levels beyond those for the shape, where only samples show a limit
// A node this near to a side of its cell (in sides) is a vertex of the side. Coordinates of nodes are known
// to about 1e-13.
constexpr double kOnSide = 1e-7;

struct Levels {
  int start = 1;    // for the shape
  int sampled = 1;  // where samples show a limit
  int finest = 1;   // where a form is not settled
};

// Estimates the turn of the normal and the length of the sides on a 5 x 5 grid.
Levels ChooseLevels(const Piece& piece, const ZeroMeshParams& params) {
  constexpr int n = 4;
  double turn = 0.0, side = 0.0;
  Vec3 points[n + 1][n + 1];
  std::optional<Vec3> normals[n + 1][n + 1];
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const SurfaceJet jet = Evaluate(piece, double(i) / n, double(j) / n);
      points[i][j] = jet.p;
      normals[i][j] = UnitNormal(jet);
    }
  }
  const auto compare = [&](int i, int j, int k, int l) {
    side = std::max(side, n * (points[i][j] - points[k][l]).norm());
    if (normals[i][j] && normals[k][l]) {
      turn = std::max(turn, n * std::acos(std::clamp(normals[i][j]->dot(*normals[k][l]), -1.0, 1.0)));
    }
  };
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      if (i < n) compare(i, j, i + 1, j);
      if (j < n) compare(i, j, i, j + 1);
    }
  }
  const double cells = std::max({1.0, turn / params.max_turn, side / params.max_cell});
  const int fine_enough = std::clamp(
      static_cast<int>(std::floor(std::log2(std::max(2.0, side / params.min_cell)))), 1, kZeroMaxLevel);
  Levels levels;
  levels.start = std::max(1, std::min({static_cast<int>(std::ceil(std::log2(cells))), fine_enough,
                                       kZeroMaxLevel - kExtraLevels}));
  levels.finest = std::max(levels.start, fine_enough);
  levels.sampled = std::min(levels.start + kExtraLevels, levels.finest);
  return levels;
}

class Divider {
 public:
  Divider(const Piece& piece, std::span<const ZeroField> fields, const ZeroMeshParams& params,
          ZeroVertices& vertices)
      : piece_(piece), fields_(fields), params_(params), vertices_(vertices) {}

  ZeroCells Run() {
    std::vector<OpenForm> open;
    for (std::size_t k = 0; k < fields_.size(); ++k) {
      std::optional<BernsteinForm> form;
      if (fields_[k].form && !Stopped()) form = fields_[k].form(piece_.net);
      if (form) {
        if (!params_.skip_negligible) form->negligible = 0.0;
        open.push_back({k, *std::move(form)});
      } else {
        sampled_.push_back(k);
      }
    }
    if (params_.curves_only && sampled_.empty() && Settled(ZeroCell{}, open)) return {};
    levels_ = ChooseLevels(piece_, params_);
    result_.corners.assign(static_cast<std::size_t>((kZeroGrid + 1) * (kZeroGrid + 1)), false);
    std::vector<Task> level(1);
    level[0].open = std::move(open);
    while (!level.empty() && !Stopped()) level = Refine(std::move(level));
    return std::move(result_);
  }

 private:
  bool Stopped() const { return params_.run != nullptr && params_.run->Cancelled(); }

  struct OpenForm {
    std::size_t field;
    BernsteinForm form;
  };
  struct Task {
    ZeroCell cell;
    std::vector<OpenForm> open;
    bool divide = false;
  };

  void Tell(const Task& task, const std::vector<Task>& level) {
    if (params_.run == nullptr) return;
    throttle_.ReportIfDue(*params_.run, "cells", static_cast<std::size_t>(&task - level.data()),
                          level.size());
  }

  // Removes forms with one sign and forms whose sign does not matter. A form with a node stays open even if
  // it is negligible: all values are small around a node, and without the node its sectors would be joined at
  // random.
  bool Settled(const ZeroCell& cell, std::vector<OpenForm>& open) {
    std::erase_if(open, [&](const OpenForm& f) {
      const FormSign sign = SignOf(f.form);
      if (sign != FormSign::kZero || !fields_[f.field].node) return sign != FormSign::kOpen;
      return IsRounding(f.form) || !NodeIn(f.field, cell);
    });
    return open.empty();
  }
  std::optional<Vec2> NodeIn(std::size_t k, const ZeroCell& cell) const {
    const double cells = 1 << cell.level, slack = kOnSide / cells;
    return fields_[k].node(
        piece_, {std::max(0.0, cell.i / cells - slack), std::min(1.0, (cell.i + 1) / cells + slack),
                 std::max(0.0, cell.j / cells - slack), std::min(1.0, (cell.j + 1) / cells + slack)});
  }

  // The points at which field k is sampled: 3 x 3 for a smooth field, corners and middle for a limit.
  std::vector<int> Samples(const ZeroCell& cell, std::size_t k) {
    std::vector<int> ids;
    for (int place = 0; place < 9; place += fields_[k].smooth ? 1 : 2) ids.push_back(Place(cell, place));
    return ids;
  }
  // The 3 x 3 vertices of a cell, row by row.
  int Place(const ZeroCell& cell, int place) {
    const int step = kZeroGrid >> cell.level;
    return vertices_.OnGrid(cell.i * step + place / 3 * step / 2, cell.j * step + place % 3 * step / 2);
  }
  bool Differ(const ZeroCell& cell, std::size_t k) {
    bool seen[2] = {false, false};
    for (const int id : Samples(cell, k)) {
      const int sign = vertices_.Sign(id, k);
      if (sign != 0) seen[sign > 0] = true;
    }
    return seen[0] && seen[1];
  }

  // True if a straight line divides the signs at 3 x 3 places. Then the cell is not divided for the limit.
  // Bends of the limit are found when arcs are refined, and where curves meet it.
  bool MayBeStraight(const ZeroCell& cell, std::size_t k) {
    static const std::bitset<512> cuts = CutsByLines();
    unsigned positive = 0;
    for (int place = 0; place < 9; ++place) {
      const int sign = vertices_.Sign(Place(cell, place), k);
      if (sign == 0) return false;
      if (sign > 0) positive |= 1U << place;
    }
    return cuts.test(positive);
  }

  // Takes one level of cells and returns the next one. Signs of a whole level are evaluated together.
  std::vector<Task> Refine(std::vector<Task> level) {
    const int depth = level.front().cell.level;
    const bool proofs_only = sampled_.empty();
    for (Task& task : level) {
      if (Stopped()) return {};
      Tell(task, level);
      if (Settled(task.cell, task.open) && params_.curves_only && proofs_only) continue;
      task.divide = depth < levels_.start;
      for (const OpenForm& f : task.open) Decide(f, task);
    }
    if (params_.curves_only && proofs_only)
      std::erase_if(level, [](const Task& task) { return task.open.empty(); });
    if (depth < levels_.sampled) {
      for (const std::size_t k : sampled_) {
        std::vector<int> ids;
        for (const Task& task : level) {
          if (task.divide) continue;
          for (const int id : Samples(task.cell, k)) ids.push_back(id);
        }
        vertices_.Ask(ids, k);
        std::vector<Task*> differing;
        ids.clear();
        for (Task& task : level) {
          if (task.divide || !Differ(task.cell, k)) continue;
          differing.push_back(&task);
          if (fields_[k].smooth) continue;
          for (int place = 1; place < 9; place += 2) ids.push_back(Place(task.cell, place));
        }
        vertices_.Ask(ids, k);
        for (Task* task : differing) task->divide = fields_[k].smooth || !MayBeStraight(task->cell, k);
      }
    }
    std::vector<Task> next;
    for (Task& task : level) {
      if (Stopped()) return {};
      Tell(task, level);
      if (task.divide) {
        Divide(task, next);
      } else {
        AddCell(task.cell);
      }
    }
    return next;
  }

  // Decides about an open form. The cell is done if it has at most one arc and no node, its border included.
  // Otherwise the cell is divided. At the finest level the node is searched.
  void Decide(const OpenForm& f, Task& task) {
    if (task.divide || (IsGraph(f.form) && !(fields_[f.field].node && MayBeFlat(f.form)))) return;
    if (task.cell.level < levels_.finest) {
      task.divide = true;
    } else {
      task.cell.settled = false;
      FindNode(f.field, task.cell);
    }
  }

  static void Divide(Task& task, std::vector<Task>& next) {
    std::array<std::vector<OpenForm>, 4> parts;
    for (OpenForm& f : task.open) {
      std::array<BernsteinForm, 4> quarters = Quarters(f.form);
      for (std::size_t q = 0; q < 4; ++q) parts[q].push_back({f.field, std::move(quarters[q])});
    }
    task.open.clear();
    const ZeroCell& cell = task.cell;
    for (int q = 0; q < 4; ++q) {
      next.push_back({{cell.level + 1, 2 * cell.i + q / 2, 2 * cell.j + q % 2},
                      std::move(parts[static_cast<std::size_t>(q)])});
    }
  }

  bool Near(int id, const Vec2& q, double slack) const {
    return std::max(std::abs(vertices_[id].u - q.x()), std::abs(vertices_[id].v - q.y())) <= slack;
  }

  // Returns the vertex on a side of cells. Cells that share the side share the vertex.
  int OnSide(const Vec2& q, double slack) {
    for (const int id : result_.on_sides) {
      if (Near(id, q, slack)) return id;
    }
    result_.on_sides.push_back(vertices_.Add(q));
    return result_.on_sides.back();
  }

  // Finds a crossing of the field's curves with themselves in the closed cell. It becomes a vertex inside the
  // cell, on a side or at a corner. Every sector between the curves gets a vertex on the sides.
  void FindNode(std::size_t k, ZeroCell& cell) {
    if (!fields_[k].node || cell.node) return;
    const double cells = 1 << cell.level;
    const double slack = kOnSide / cells;
    std::optional<Vec2> node = NodeIn(k, cell);
    if (!node) return;
    bool on_line[2];
    for (int c = 0; c < 2; ++c) {
      const double line = std::round((*node)[c] * cells);
      on_line[c] = std::abs((*node)[c] * cells - line) <= kOnSide;
      if (on_line[c]) (*node)[c] = line / cells;
    }
    cell.node = on_line[0] && on_line[1]   ? vertices_.OnGrid(static_cast<int>(node->x() * kZeroGrid),
                                                              static_cast<int>(node->y() * kZeroGrid))
                : on_line[0] || on_line[1] ? OnSide(*node, slack)
                                           : vertices_.Add(*node);
    vertices_.PutOn(*cell.node, k);
    const Vec2 low(cell.i / cells, cell.j / cells), high((cell.i + 1) / cells, (cell.j + 1) / cells);
    SampleSide(k, *node, low, {high.x(), low.y()}, slack);
    SampleSide(k, *node, {high.x(), low.y()}, high, slack);
    SampleSide(k, *node, {low.x(), high.y()}, high, slack);
    SampleSide(k, *node, low, {low.x(), high.y()}, slack);
  }

  // A sector of a node may leave through a side whose ends lie in other sectors. Each such sector gets a
  // vertex. The sectors are found along rays at equal angles around the node.
  void SampleSide(std::size_t k, const Vec2& node, const Vec2& from, const Vec2& to, double slack) {
    constexpr int kRays = 24;  // per half turn
    const Vec2 along = to - from;
    const double distance = std::abs(Cross(along, node - from)) / along.squaredNorm();  // in sides
    if (distance == 0.0) return;
    const double foot = (node - from).dot(along) / along.squaredNorm();
    std::vector<double> places = {0.0};
    for (int i = 1; i < kRays; ++i) {
      const double t = foot - distance / std::tan(kPi * i / kRays);
      if (t > kOnSide && t < 1.0 - kOnSide) places.push_back(t);
    }
    places.push_back(1.0);
    std::vector<std::int8_t> sign;
    for (const double t : places) sign.push_back(SignAt(k, from + t * along));
    for (std::size_t first = 1, last; first + 1 < places.size(); first = last + 1) {
      for (last = first; last + 2 < places.size() && sign[last + 1] == sign[first];) ++last;
      const bool with_an_end = sign[first] == 0 || (first == 1 && sign[0] == sign[first]) ||
                               (last + 2 == places.size() && sign[last + 1] == sign[first]);
      if (!with_an_end) OnSide(from + places[(first + last) / 2] * along, slack);
    }
  }
  std::int8_t SignAt(std::size_t k, const Vec2& q) const {
    return vertices_.SignOf(k, fields_[k].value(Evaluate(piece_, q.x(), q.y())));
  }

  void AddCell(const ZeroCell& cell) {
    const int step = kZeroGrid >> cell.level;
    for (const int a : {0, 1}) {
      for (const int b : {0, 1})
        result_
            .corners[static_cast<std::size_t>((cell.i + a) * step * (kZeroGrid + 1) + (cell.j + b) * step)] =
            true;
    }
    result_.cells.push_back(cell);
  }

  const Piece& piece_;
  std::span<const ZeroField> fields_;
  const ZeroMeshParams& params_;
  ZeroVertices& vertices_;
  Levels levels_;
  std::vector<std::size_t> sampled_;  // fields without a form
  ZeroCells result_;
  ProgressThrottle throttle_;
};

}  // namespace

ZeroCells DivideForFields(const Piece& piece, std::span<const ZeroField> fields, const ZeroMeshParams& params,
                          ZeroVertices& vertices) {
  return Divider(piece, fields, params, vertices).Run();
}

}  // namespace patchmill
