#include "cam/region/watershed/height_tops.h"

#include <algorithm>
#include <limits>

#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/base/union_find.h"

namespace patchmill {
namespace {

constexpr std::size_t kPoll = 1 << 15;  // vertices between two checks for a cancel

// Calls push(from, to) for every edge from a vertex of the piece, in the order of the sides. Edges are the
// sides themselves. Along a seam there are edges both ways between the ends of a side and all corners of the
// triangle beyond it. first[piece] is the number of vertices of the pieces before it.
template <class Push>
void VisitEdges(const std::vector<SplitMesh>& meshes, const AdjacencyList& adjacency,
                const std::vector<std::size_t>& first, std::size_t piece, const Push& push) {
  const auto number = [&](int of, int vertex) {
    return first[static_cast<std::size_t>(of)] + static_cast<std::size_t>(vertex);
  };
  const auto end = [&](const TriangleSide& side, int which) {
    return number(side.piece, VertexOf(meshes[static_cast<std::size_t>(side.piece)], side, which));
  };
  const auto corner = [&](const Adjacency& a, int k) { return end({a.other_piece, a.other_triangle, 0}, k); };
  const auto from_beyond = [&](const Adjacency& a) {
    for (int k = 0; k < 3; ++k) {
      push(corner(a, k), end(a.side, 0));
      push(corner(a, k), end(a.side, 1));
    }
  };
  const std::vector<std::size_t>& beyond = adjacency.into[piece];
  std::size_t next = 0;
  for (; next < beyond.size() && beyond[next] < 3 * adjacency.first[piece]; ++next)
    from_beyond(adjacency[beyond[next]]);
  adjacency.VisitPiece(piece, [&](std::size_t, const Adjacency& a) {
    const std::size_t from = end(a.side, 0), to = end(a.side, 1);
    push(from, to);
    if (a.other_piece >= 0 && !a.across_seam) return;  // the other triangle's side adds the way back
    push(to, from);
    for (int k = 0; k < 3 && a.other_piece >= 0; ++k) {
      const std::size_t facing = corner(a, k);
      for (const std::size_t own : {from, to}) {
        push(own, facing);
        if (a.other_piece == a.side.piece) push(facing, own);
      }
    }
  });
  for (; next < beyond.size(); ++next) {
    if (beyond[next] >= 3 * adjacency.first[piece + 1]) from_beyond(adjacency[beyond[next]]);
  }
}

}  // namespace

absl::StatusOr<HeightGraph> HeightGraph::Make(const SplitSurface& split, const RunContext& run) {
  const std::vector<SplitMesh>& meshes = split.meshes;
  const AdjacencyList& adjacency = split.adjacency;
  HeightGraph graph;
  for (const SplitMesh& mesh : meshes) graph.first_.push_back(graph.first_.back() + mesh.vertices.size());
  const std::size_t count = graph.first_.back();
  graph.points_.resize(count);
  // Counts the neighbours of each vertex, two places further on. Their sums then say where the lists begin.
  std::vector<std::size_t>& first = graph.first_neighbour_;
  first.assign(count + 2, 0);
  PM_RETURN_IF_ERROR(ParallelFor(run, "regions: heights", meshes.size(), [&](std::size_t piece) {
    for (std::size_t k = 0; k < meshes[piece].vertices.size(); ++k)
      graph.points_[graph.first_[piece] + k] = meshes[piece].vertices[k].p;
    VisitEdges(meshes, adjacency, graph.first_, piece,
               [&](std::size_t from, std::size_t) { ++first[from + 2]; });
  }));
  for (std::size_t k = 2; k < first.size(); ++k) first[k] += first[k - 1];
  graph.neighbours_.resize(first.back());
  // The end of a vertex's list so far is kept at the place of the next vertex. No other vertex writes there.
  PM_RETURN_IF_ERROR(ParallelFor(run, "regions: heights", meshes.size(), [&](std::size_t piece) {
    VisitEdges(meshes, adjacency, graph.first_, piece, [&](std::size_t from, std::size_t to) {
      graph.neighbours_[first[from + 1]++] = static_cast<Index>(to);
    });
  }));
  first.pop_back();
  for (std::vector<Index>& steepest : graph.steepest_) steepest.resize(count);
  PM_RETURN_IF_ERROR(ParallelFor(run, "regions: heights", meshes.size(), [&](std::size_t piece) {
    for (std::size_t i = graph.first_[piece]; i < graph.first_[piece + 1]; ++i) {
      graph.steepest_[0][i] = graph.Steepest(static_cast<Index>(i), 1.0);
      graph.steepest_[1][i] = graph.Steepest(static_cast<Index>(i), -1.0);
    }
  }));
  return graph;
}

HeightGraph::Index HeightGraph::Steepest(Index i, double sign) const {
  if (first_neighbour_[i] == first_neighbour_[i + 1]) return kNone;
  Index best = i;
  double steepest = -1.0;
  Neighbours(i, [&](Index n) {
    if (!Above(n, i, sign)) return;
    const double rise = points_[n].z() - points_[i].z(), length2 = (points_[n] - points_[i]).squaredNorm();
    const double slope2 = length2 > 0.0 ? rise * rise / length2 : kInfinity;
    if (slope2 > steepest) {
      steepest = slope2;
      best = n;
    }
  });
  return best;
}

MeshVertex HeightGraph::At(Index i) const {
  const auto piece = std::upper_bound(first_.begin(), first_.end(), i) - first_.begin() - 1;
  return {static_cast<int>(piece), static_cast<int>(i - first_[static_cast<std::size_t>(piece)])};
}

absl::StatusOr<HeightExtrema> HeightGraph::Find(double sign, double persistence, std::size_t most,
                                                const RunContext& run) const {
  const std::vector<Index>& steepest = steepest_[sign > 0.0 ? 0 : 1];
  const auto above = [&](Index a, Index b) { return Above(a, b, sign); };
  const auto height = [&](Index i) { return sign * points_[i].z(); };

  // Finds the summits, and for each vertex the index of the summit that it climbs to.
  std::vector<Index> summits, summit(points_.size(), kNone), way;
  for (Index i = 0; i < points_.size(); ++i) {
    if (i % kPoll == 0) PM_RETURN_IF_ERROR(run.Check());
    if (steepest[i] == kNone) continue;
    Index at = i;
    for (; summit[at] == kNone && steepest[at] != at; at = steepest[at]) way.push_back(at);
    if (summit[at] == kNone) {
      summit[at] = static_cast<Index>(summits.size());
      summits.push_back(at);
    }
    for (const Index passed : way) summit[passed] = summit[at];
    way.clear();
  }
  std::vector<Index> meetings;  // vertices with a higher neighbour that climbs to another summit
  for (Index i = 0; i < points_.size(); ++i) {
    if (i % kPoll == 0) PM_RETURN_IF_ERROR(run.Check());
    bool meets = false;
    Neighbours(i, [&](Index n) { meets = meets || (summit[n] != summit[i] && above(n, i)); });
    if (meets) meetings.push_back(i);
  }
  std::sort(meetings.begin(), meetings.end(), above);
  PM_RETURN_IF_ERROR(run.Check());

  UnionFind sets(summits.size());
  std::vector<Index> top_of(summits.size());  // highest summit of each set, at the index of its smallest
  for (Index k = 0; k < summits.size(); ++k) top_of[k] = k;
  std::vector<Index> swallowed(summits.size(), kNone);  // if the summit does not persist: what it belongs to
  struct Younger {
    double persistence;
    Index top, by;
  };
  std::vector<Younger> younger;
  std::vector<std::size_t> roots;
  for (const Index i : meetings) {
    roots.clear();
    Neighbours(i, [&](Index n) {
      if (above(n, i)) roots.push_back(sets.Find(summit[n]));
    });
    std::sort(roots.begin(), roots.end(),
              [&](std::size_t a, std::size_t b) { return above(summits[top_of[a]], summits[top_of[b]]); });
    roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
    if (roots.size() == 1) continue;
    const Index elder = top_of[roots.front()];
    Index into = elder;  // the summit of the elder's set to which a neighbour climbs
    Neighbours(i, [&](Index n) {
      if (into == elder && above(n, i) && sets.Find(summit[n]) == roots.front()) into = summit[n];
    });
    for (const std::size_t root : roots) {
      const Index top = top_of[root];
      if (top != elder) younger.push_back({height(summits[top]) - height(i), top, into});
      sets.Join(root, roots.front());
    }
    top_of[sets.Find(elder)] = elder;
  }
  std::stable_sort(younger.begin(), younger.end(),
                   [](const Younger& a, const Younger& b) { return a.persistence > b.persistence; });
  for (std::size_t k = 0; k < younger.size(); ++k) {
    if (k >= most || younger[k].persistence < persistence) swallowed[younger[k].top] = younger[k].by;
  }

  HeightExtrema found;
  std::vector<Index> persisting(summits.size()), tops;  // the one each summit belongs to; all of these
  std::vector<int> many(summits.size(), 0);             // number of persisting summits of each sheet
  for (Index k = 0; k < summits.size(); ++k) {
    persisting[k] = k;
    while (swallowed[persisting[k]] != kNone) persisting[k] = swallowed[persisting[k]];
    if (persisting[k] == k) ++many[sets.Find(k)];
  }
  for (Index k = 0; k < summits.size(); ++k) {
    if (persisting[k] == k && many[sets.Find(k)] > 1) tops.push_back(summits[k]);
  }
  std::sort(tops.begin(), tops.end(), above);
  for (const Index top : tops) found.tops.push_back(At(top));
  std::vector<bool> beside(points_.size(), false);  // at or beside a vertex where two tops meet
  for (const Index i : meetings) {
    bool meets = false, known = beside[i];
    Neighbours(i, [&](Index n) {
      known = known || beside[n];
      meets = meets || (persisting[summit[n]] != persisting[summit[i]] && above(n, i));
    });
    if (!meets) continue;
    if (!known) found.passes.push_back(At(i));
    beside[i] = true;
    Neighbours(i, [&](Index n) { beside[n] = true; });
  }
  return found;
}

}  // namespace patchmill
