#include "cam/path/zlevel/level_chains.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

struct Crossing {
  LevelPoint point;
  std::int32_t next = -1, previous = -1;
  ChainCell onward;
};

class Builder {
 public:
  Builder(const LevelCells& cells, const LevelEdges& edges) : cells_(cells) {
    crossings_.resize(edges.crossings.size());
    for (std::size_t i = 0; i < crossings_.size(); ++i) crossings_[i].point = edges.crossings[i];
    for (std::size_t i = 0; i < cells.cells.size(); ++i) {
      rim_.assign(edges.rims.begin() + edges.first_on_rim[i], edges.rims.begin() + edges.first_on_rim[i + 1]);
      if (rim_.empty()) continue;
      if (cells.cells[i].ambiguous || !JoinInOrder(cells.cells[i])) JoinAroundRim(cells.cells[i]);
    }
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
  void Join(const RimCrossing& from, const RimCrossing& to, const LevelCell& cell) {
    Crossing& a = crossings_[static_cast<std::size_t>(from.crossing)];
    Crossing& b = crossings_[static_cast<std::size_t>(to.crossing)];
    a.next = to.crossing;
    a.onward = {XyRectOf(cells_.grid, cell), cell.ambiguous ? Vec2(Vec2::Zero()) : cell.free,
                cell.ambiguous && rim_.size() > 2};
    b.previous = from.crossing;
  }

  // Joins the crossings in their order along the contour. With the forbidden side on the right, a stretch
  // starts where the rim (counter-clockwise) enters forbidden places and ends where it leaves them.
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

  // Rounding may set a sign on the rim of a cell that was decided as a whole. A stretch ends there; it is
  // joined to the nearest beginning.
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

  const LevelCells& cells_;
  std::vector<Crossing> crossings_;
  std::vector<char> seen_;
  std::vector<RimCrossing> rim_;
};

}  // namespace

std::vector<Chain> BuildChains(const LevelCells& cells, const LevelEdges& edges, bool open) {
  return Builder(cells, edges).Chains(open);
}

}  // namespace patchmill
