#include "cam/path/zlevel/level_edges.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace patchmill {
namespace {

// mm: pairs of crossings closer to each other than this are not searched for ([contours, section 7]).
constexpr double kFinestEdge = 2e-4;
// Most candidates looked at for one edge. Where folds lie within microns of each other every stretch has tens
// of thousands of them. Such an edge is searched as coarsely as undecided cells are.
constexpr std::size_t kMostItems = 2'000'000;

// mm: a point this far inside of a known disc is forbidden without an evaluation of h.
constexpr double kClearlyInside = 1e-7;

struct Vertex {
  bool forbidden = false;
  SurfacePoint contact;  // when forbidden
};

// A stretch between two neighbouring vertices on a grid line.
struct Edge {
  std::int32_t x = 0, y = 0, length = 0;
  bool horizontal = true;
  std::array<std::int32_t, 2> cell = {-1, -1};  // below and above, or left and right of it; -1: decided
  std::int32_t first = 0, last = 0;             // crossings, in order along the edge
};

struct EdgeOfRim {
  std::int32_t edge = 0;
  bool backward = false;  // the rim runs against the edge
};

class Search {
 public:
  Search(LevelCells& cells, ContactCandidates& items, const LevelOracle& oracle)
      : cells_(cells), items_(items), oracle_(oracle) {}

  LevelEdges Run(const RunContext& run) {
    std::vector<std::size_t> first;
    for (std::size_t i = 0; i < cells_.cells.size(); ++i) {
      const LevelCell& cell = cells_.cells[i];
      const std::int32_t x = cell.x, y = cell.y, s = cell.side;
      first.push_back(rims_.size());
      cell_ = static_cast<std::int32_t>(i);
      Side({.x = x, .y = y, .length = s, .horizontal = true}, false);
      Side({.x = x + s, .y = y, .length = s, .horizontal = false}, false);
      Side({.x = x, .y = y + s, .length = s, .horizontal = true}, true);
      Side({.x = x, .y = y, .length = s, .horizontal = false}, true);
    }
    first.push_back(rims_.size());
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (i % 64 == 0 && run.Cancelled()) break;
      Solve(edges_[i]);
    }
    for (std::size_t i = 0; i + 1 < first.size(); ++i) {
      out_.first_on_rim.push_back(static_cast<std::int32_t>(out_.rims.size()));
      for (std::size_t k = first[i]; k < first[i + 1]; ++k) AddToRim(rims_[k]);
    }
    out_.first_on_rim.push_back(static_cast<std::int32_t>(out_.rims.size()));
    return std::move(out_);
  }

 private:
  // Adds one side of the cell, cut at the vertices of finer neighbours. The rim is counter-clockwise: the
  // cell lies to its left.
  void Side(const Edge& side, bool backward) {
    const std::int32_t h = side.length / 2;
    Edge low = side, high = side;
    low.length = high.length = h;
    (side.horizontal ? high.x : high.y) += h;
    if (h > 0 && cells_.vertices.Contains(GridKey(high.x, high.y))) {
      Side(backward ? high : low, backward);
      Side(backward ? low : high, backward);
      return;
    }
    std::int32_t& slot = (side.horizontal ? horizontal_ : vertical_)[GridKey(side.x, side.y)];
    if (slot < 0) {
      slot = static_cast<std::int32_t>(edges_.size());
      edges_.push_back(side);
    }
    // The cell lies below a top side (backward) and to the left of a right side (forward).
    edges_[static_cast<std::size_t>(slot)].cell[side.horizontal == backward ? 0 : 1] = cell_;
    rims_.push_back({slot, backward});
  }

  void AddToRim(const EdgeOfRim& part) {
    const Edge& edge = edges_[static_cast<std::size_t>(part.edge)];
    for (std::int32_t i = edge.first; i < edge.last; ++i) {
      const std::int32_t c = part.backward ? edge.last - 1 - (i - edge.first) : i;
      out_.rims.push_back({c, (leaves_[static_cast<std::size_t>(c)] != 0) != part.backward});
    }
  }

  Vertex Probe(const Vec2& q) {
    if (const SurfacePoint* known = recent_.Holding(q, Vec2::Zero(), kClearlyInside)) return {true, *known};
    const std::optional<SurfacePoint> obstacle = oracle_.Obstacle(q, hint_ ? &*hint_ : nullptr);
    if (!obstacle) return {};
    Remember(*obstacle);
    return {true, *obstacle};
  }

  void Remember(const SurfacePoint& contact) {
    hint_ = contact;
    recent_.Add(contact, oracle_.ForbiddenRadius(contact.p));
  }

  Vertex At(std::int32_t x, std::int32_t y) {
    const std::uint64_t key = GridKey(x, y);
    const std::int32_t found = vertex_of_[key];
    if (found >= 0) return vertices_[static_cast<std::size_t>(found)];
    const Vertex v = Probe(cells_.grid.At(x, y));
    vertex_of_[key] = static_cast<std::int32_t>(vertices_.size());
    vertices_.push_back(v);
    return v;
  }

  void Solve(Edge& edge) {
    edge.first = static_cast<std::int32_t>(out_.crossings.size());
    floor_ = 0.25 * cells_.grid.unit;
    looked_at_ = 0;
    Candidates& mine = pool_[0];
    for (std::size_t k = 0; k < 2; ++k) {
      mine[k].clear();
      if (edge.cell[k] < 0) continue;
      const LevelCell& cell = cells_.cells[static_cast<std::size_t>(edge.cell[k])];
      mine[k].assign(cells_.items.begin() + cell.first_candidate, cells_.items.begin() + cell.last_candidate);
      if (!cell.ambiguous) floor_ = kFinestEdge;
    }
    edge_ = &edge;
    const std::int32_t ex = edge.horizontal ? edge.x + edge.length : edge.x;
    const std::int32_t ey = edge.horizontal ? edge.y : edge.y + edge.length;
    const Vertex a = At(edge.x, edge.y), b = At(ex, ey);
    Roots(cells_.grid.At(edge.x, edge.y), a, cells_.grid.At(ex, ey), b, 0);
    edge.last = static_cast<std::int32_t>(out_.crossings.size());
  }

  // Finds the crossings between two points of the edge, in order.
  void Roots(const Vec2& a, const Vertex& va, const Vec2& b, const Vertex& vb, std::size_t depth) {
    const double length = (b - a).norm();
    const Vec2 along = (b - a) / length;
    if (va.forbidden && vb.forbidden &&
        oracle_.ExitLength(a, va.contact.p, along) + oracle_.ExitLength(b, vb.contact.p, -along) > length) {
      return;  // the two discs cover the stretch
    }
    if (!SignsDecide(a, b, along, depth) && length > floor_ && depth + 2 < pool_.size()) {
      const Vec2 m = 0.5 * (a + b);
      const Vertex vm = Probe(m);
      Roots(a, va, m, vm, depth + 1);
      Roots(m, vm, b, vb, depth + 1);
      return;
    }
    if (va.forbidden == vb.forbidden) return;
    const LevelPoint point = va.forbidden ? oracle_.Exit(a, va.contact, along, length)
                                          : oracle_.Exit(b, vb.contact, -along, length);
    Remember(point.contact);
    out_.crossings.push_back(point);
    leaves_.push_back(va.forbidden);
  }

  // Do the signs at the ends decide the stretch? Tries the known candidates first, then finer ones, which
  // stay for the halves.
  bool SignsDecide(const Vec2& a, const Vec2& b, const Vec2& along, std::size_t depth) {
    const double length = (b - a).norm();
    const Candidates& known = pool_[depth];
    Candidates& finer = pool_[depth + 1];
    if (OneWay(a, b, along, known) || Narrow(a, b, known)) return true;
    for (std::size_t k = 0; k < 2; ++k) {
      finer[k].clear();
      if (edge_->cell[k] >= 0) items_.Collect(known[k], Beside(a, b, k), length, finer[k]);
    }
    looked_at_ += known[0].size() + known[1].size() + finer[0].size() + finer[1].size();
    if (looked_at_ > kMostItems) floor_ = 0.25 * cells_.grid.unit;
    return OneWay(a, b, along, finer) || Narrow(a, b, finer);
  }

  using Candidates = std::array<std::vector<std::int32_t>, 2>;  // of the cells on both sides

  // Returns the rectangle of the places within half the length of a stretch, on one of its sides.
  XyRect Beside(const Vec2& a, const Vec2& b, std::size_t side) const {
    const double quarter = 0.25 * (b - a).norm(), to = side == 0 ? -quarter : quarter;
    XyRect box{0.5 * (a + b), 0.5 * (b - a)};
    const int across = edge_->horizontal ? 1 : 0;
    box.mid[across] += to;
    box.half[across] = quarter;
    return box;
  }

  // Do all directions go one way along the stretch? The cells of both sides know every zero on it alike, so
  // the shorter list serves.
  bool OneWay(const Vec2& a, const Vec2& b, const Vec2& along, const Candidates& candidates) const {
    const std::size_t k =
        edge_->cell[0] < 0 || (edge_->cell[1] >= 0 && candidates[1].size() < candidates[0].size());
    for (const bool closely : {false, true}) {
      const DirectionCone cone = items_.Directions(candidates[k], {0.5 * (a + b), 0.5 * (b - a)}, closely);
      if (!cone.valid) continue;
      if (cone.empty) return true;
      const double r = cone.right.dot(along), l = cone.left.dot(along);
      if ((r > 0.0 && l > 0.0) || (r < 0.0 && l < 0.0)) return true;
    }
    return false;
  }

  bool Narrow(const Vec2& a, const Vec2& b, const Candidates& candidates) const {
    for (const bool closely : {false, true}) {
      DirectionCone cone;
      cone.valid = true;
      for (std::size_t k = 0; k < 2; ++k) {
        if (edge_->cell[k] >= 0) cone.Add(items_.Directions(candidates[k], Beside(a, b, k), closely));
      }
      if (cone.valid && (cone.empty || cone.Angle() < kPi / 2.0)) return true;
    }
    return false;
  }

  LevelCells& cells_;
  ContactCandidates& items_;
  const LevelOracle& oracle_;
  GridMap vertex_of_, horizontal_, vertical_;
  std::vector<Vertex> vertices_;
  std::vector<Edge> edges_;
  std::vector<EdgeOfRim> rims_;
  std::vector<char> leaves_;  // by crossing: forbidden before it along the edge, free after
  std::int32_t cell_ = 0;     // the cell whose sides are walked
  const Edge* edge_ = nullptr;
  std::array<Candidates, 40> pool_;  // by depth of halving
  double floor_ = kFinestEdge;
  std::size_t looked_at_ = 0;
  std::optional<SurfacePoint> hint_;
  RecentDiscs recent_;
  LevelEdges out_;
};

}  // namespace

LevelEdges FindCrossings(LevelCells& cells, ContactCandidates& items, const LevelOracle& oracle,
                         const RunContext& run) {
  return Search(cells, items, oracle).Run(run);
}

}  // namespace patchmill
