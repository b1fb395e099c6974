#include "cam/path/level_chains.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace patchmill {
namespace {

// mm: edges are not searched for pairs of crossings closer than this (ALGORITHMS 11).
constexpr double kFinestEdge = 2e-4;

// mm: a point this far inside of a known disc is forbidden without asking h.
constexpr double kClearlyInside = 1e-7;

struct Vertex {
  bool forbidden = false;
  SurfacePoint contact;  // when forbidden
};

struct Crossing {
  LevelPoint point;
  // Walking along the edge in its own sense (growing x or y): forbidden before it, free after it?
  bool leaves = false;
  std::int32_t next = -1, previous = -1;
  ChainCell onward;
};

struct EdgeSlice {
  std::int32_t first = 0, last = 0;  // crossings in order along the edge
};

// A crossing as one cell sees it on its way round its rim, counter-clockwise.
struct RimCrossing {
  std::int32_t crossing = 0;
  bool to_free = false;  // forbidden before, free after
};

class Builder {
 public:
  Builder(LevelCells& cells, const LevelItems& items, const LevelOracle& oracle)
      : cells_(cells), items_(items), oracle_(oracle) {}

  void Cell(const LevelCell& cell) {
    mine_.assign(cells_.items.begin() + cell.first_item, cells_.items.begin() + cell.last_item);
    floor_ = cell.ambiguous ? 0.25 * cells_.grid.unit : kFinestEdge;
    rim_.clear();
    const std::int32_t x = cell.x, y = cell.y, s = cell.side;
    Side(x, y, s, true, false);
    Side(x + s, y, s, false, false);
    Side(x, y + s, s, true, true);
    Side(x, y, s, false, true);
    if (rim_.empty()) return;
    if (cell.ambiguous || !JoinInOrder(cell)) JoinAroundRim(cell);
  }

  std::vector<Chain> Chains(bool open) {
    if (!open) CloseOpenEnds();
    std::vector<Chain> chains;
    seen_.assign(crossings_.size(), 0);
    for (std::size_t i = 0; i < crossings_.size(); ++i) {
      if (crossings_[i].previous < 0 && crossings_[i].next >= 0) chains.push_back(Walk(i, false));
    }
    for (std::size_t i = 0; i < crossings_.size(); ++i) {
      if (!seen_[i] && crossings_[i].next >= 0) chains.push_back(Walk(i, true));
    }
    return chains;
  }

 private:
  Vertex Probe(const Vec2& q) {
    if (hint_ && (q - Plan(hint_->p)).norm() < oracle_.Rho(hint_->p) - kClearlyInside) return {true, *hint_};
    const std::optional<CenterPoint> h = oracle_.Height(q, hint_ ? &*hint_ : nullptr);
    if (!h) return {};
    hint_ = h->contact;
    return {oracle_.Forbidden(h), h->contact};
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

  // One side of the cell, cut at the vertices of finer neighbours; `backward`: the rim runs against it.
  void Side(std::int32_t x, std::int32_t y, std::int32_t length, bool horizontal, bool backward) {
    const std::int32_t h = length / 2;
    const std::int32_t mx = horizontal ? x + h : x, my = horizontal ? y : y + h;
    if (h > 0 && cells_.vertices.Contains(GridKey(mx, my))) {
      if (backward) {
        Side(mx, my, h, horizontal, true);
        Side(x, y, h, horizontal, true);
      } else {
        Side(x, y, h, horizontal, false);
        Side(mx, my, h, horizontal, false);
      }
      return;
    }
    const EdgeSlice slice = Atomic(x, y, length, horizontal);
    for (std::int32_t i = slice.first; i < slice.last; ++i) {
      const std::int32_t c = backward ? slice.last - 1 - (i - slice.first) : i;
      rim_.push_back({c, crossings_[static_cast<std::size_t>(c)].leaves != backward});
    }
  }

  EdgeSlice Atomic(std::int32_t x, std::int32_t y, std::int32_t length, bool horizontal) {
    std::int32_t& slot = (horizontal ? horizontal_ : vertical_)[GridKey(x, y)];
    if (slot >= 0) return edges_[static_cast<std::size_t>(slot)];
    slot = static_cast<std::int32_t>(edges_.size());
    edges_.emplace_back();
    const std::size_t index = edges_.size() - 1;
    EdgeSlice slice;
    slice.first = static_cast<std::int32_t>(crossings_.size());
    const std::int32_t ex = horizontal ? x + length : x, ey = horizontal ? y : y + length;
    const Vertex a = At(x, y), b = At(ex, ey);
    Roots(cells_.grid.At(x, y), a, cells_.grid.At(ex, ey), b);
    slice.last = static_cast<std::int32_t>(crossings_.size());
    edges_[index] = slice;
    return slice;
  }

  // Crossings between two points of an edge, in order.
  void Roots(const Vec2& a, const Vertex& va, const Vec2& b, const Vertex& vb) {
    const double length = (b - a).norm();
    const Vec2 along = (b - a) / length;
    if (va.forbidden && vb.forbidden &&
        oracle_.ExitLength(a, va.contact.p, along) + oracle_.ExitLength(b, vb.contact.p, -along) > length) {
      return;  // the two discs cover it
    }
    if (!SignsDecide(a, b, along) && length > floor_) {
      const Vec2 m = 0.5 * (a + b);
      const Vertex vm = Probe(m);
      Roots(a, va, m, vm);
      Roots(m, vm, b, vb);
      return;
    }
    if (va.forbidden == vb.forbidden) return;
    Crossing c;
    c.leaves = va.forbidden;
    c.point = va.forbidden ? oracle_.Exit(a, va.contact, along, length)
                           : oracle_.Exit(b, vb.contact, -along, length);
    hint_ = c.point.contact;
    crossings_.push_back(c);
  }

  // T8c: the contour's directions on this stretch are strictly one way along the edge (at most one crossing),
  // or span less than a quarter turn (a missed pair encloses a bump that a chord may cut off).
  bool SignsDecide(const Vec2& a, const Vec2& b, const Vec2& along) const {
    const DirectionCone cone = items_.Directions(mine_, {0.5 * (a + b), 0.5 * (b - a)});
    if (cone.empty) return true;
    if (!cone.valid) return false;
    const double r = cone.right.dot(along), l = cone.left.dot(along);
    return (r > 0.0 && l > 0.0) || (r < 0.0 && l < 0.0) || cone.Angle() < kPi / 2.0;
  }

  void Join(const RimCrossing& from, const RimCrossing& to, const LevelCell& cell) {
    Crossing& a = crossings_[static_cast<std::size_t>(from.crossing)];
    Crossing& b = crossings_[static_cast<std::size_t>(to.crossing)];
    a.next = to.crossing;
    a.onward = {PlanOf(cells_.grid, cell), cell.ambiguous ? Vec2(Vec2::Zero()) : cell.free,
                cell.ambiguous && rim_.size() > 2};
    b.previous = from.crossing;
  }

  // With the forbidden side on the right, a stretch starts where the rim (counter-clockwise) goes into
  // forbidden ground and ends where it comes out.
  bool JoinInOrder(const LevelCell& cell) {
    if (rim_.size() % 2 != 0) return false;
    const Vec2 way(cell.free.y(), -cell.free.x());
    std::vector<RimCrossing> sorted = rim_;
    const auto place = [&](const RimCrossing& r) {
      return crossings_[static_cast<std::size_t>(r.crossing)].point.q.dot(way);
    };
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](const RimCrossing& a, const RimCrossing& b) { return place(a) < place(b); });
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      if (sorted[i].to_free != (i % 2 == 1)) return false;
    }
    for (std::size_t i = 0; i + 1 < sorted.size(); i += 2) Join(sorted[i], sorted[i + 1], cell);
    return true;
  }

  void JoinAroundRim(const LevelCell& cell) {
    const std::size_t n = rim_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const RimCrossing &out = rim_[i], &in = rim_[(i + 1) % n];
      if (out.to_free && !in.to_free) Join(in, out, cell);
    }
  }

  Chain Walk(std::size_t start, bool closed) {
    Chain chain;
    chain.closed = closed;
    for (std::size_t k = start; !seen_[k];) {
      seen_[k] = 1;
      const Crossing& c = crossings_[k];
      chain.points.push_back({c.point, c.onward});
      if (c.next >= 0) k = static_cast<std::size_t>(c.next);
    }
    return chain;
  }

  // Rounding may set a sign on the rim of a cell that was decided as a whole: then a stretch ends there. Its
  // end goes on at the nearest beginning.
  void CloseOpenEnds() {
    for (std::size_t i = 0; i < crossings_.size(); ++i) {
      Crossing& end = crossings_[i];
      if (end.next >= 0 || end.previous < 0) continue;
      double nearest = kInfinity;
      std::size_t best = i;
      for (std::size_t k = 0; k < crossings_.size(); ++k) {
        if (crossings_[k].previous >= 0 || crossings_[k].next < 0) continue;
        const double d = (crossings_[k].point.q - end.point.q).squaredNorm();
        if (d < nearest) {
          nearest = d;
          best = k;
        }
      }
      if (best == i) continue;
      end.next = static_cast<std::int32_t>(best);
      crossings_[best].previous = static_cast<std::int32_t>(i);
    }
  }

  LevelCells& cells_;
  const LevelItems& items_;
  const LevelOracle& oracle_;
  GridMap vertex_of_, horizontal_, vertical_;
  std::vector<Vertex> vertices_;
  std::vector<EdgeSlice> edges_;
  std::vector<Crossing> crossings_;
  std::vector<char> seen_;
  std::vector<RimCrossing> rim_;
  std::vector<std::int32_t> mine_;
  std::optional<SurfacePoint> hint_;
  double floor_ = kFinestEdge;
};

}  // namespace

std::vector<Chain> BuildChains(LevelCells& cells, const LevelItems& items, const LevelOracle& oracle,
                               const RunContext& run, bool open) {
  Builder builder(cells, items, oracle);
  for (std::size_t i = 0; i < cells.cells.size(); ++i) {
    if (i % 16 == 0 && run.Cancelled()) return {};
    builder.Cell(cells.cells[i]);
  }
  return builder.Chains(open);
}

}  // namespace patchmill
