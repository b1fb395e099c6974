#include "cam/region/height_tops.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/status.h"
#include "core/base/union_find.h"

namespace patchmill {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kPoll = 1 << 15;  // vertices or sides between two looks at a cancelled run

}  // namespace

absl::StatusOr<HeightGraph> HeightGraph::Make(const std::vector<SplitMesh>& meshes,
                                              const std::vector<Adjacency>& adjacency,
                                              const RunContext& run) {
  HeightGraph graph(meshes, adjacency, run);
  PM_RETURN_IF_ERROR(run.Check());
  return graph;
}

// Cut short when cancelled.
HeightGraph::HeightGraph(const std::vector<SplitMesh>& meshes, const std::vector<Adjacency>& adjacency,
                         const RunContext& run) {
  first_.push_back(0);
  for (const SplitMesh& mesh : meshes) {
    for (const ZeroVertex& vertex : mesh.vertices) points_.push_back(vertex.p);
    first_.push_back(points_.size());
  }
  const auto number = [&](int piece, int triangle, int corner) {
    const SplitMesh& mesh = meshes[static_cast<std::size_t>(piece)];
    const int vertex =
        mesh.triangles[static_cast<std::size_t>(triangle)].vertex[static_cast<std::size_t>(corner)];
    return first_[static_cast<std::size_t>(piece)] + static_cast<std::size_t>(vertex);
  };
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  for (std::size_t i = 0; i < adjacency.size(); ++i) {
    if (i % kPoll == 0 && run.Cancelled()) return;
    const Adjacency& a = adjacency[i];
    const std::size_t from = number(a.side.piece, a.side.triangle, a.side.side),
                      to = number(a.side.piece, a.side.triangle, (a.side.side + 1) % 3);
    edges.emplace_back(from, to);
    if (a.other_piece >= 0 && !a.across_seam) continue;  // comes again from the other side
    edges.emplace_back(to, from);
    for (int k = 0; k < 3 && a.other_piece >= 0; ++k) {
      const std::size_t facing = number(a.other_piece, a.other_triangle, k);
      for (const std::size_t own : {from, to}) {
        edges.emplace_back(own, facing);
        edges.emplace_back(facing, own);
      }
    }
  }
  first_neighbour_.assign(points_.size() + 2, 0);
  for (const auto& [from, to] : edges) ++first_neighbour_[from + 2];
  std::partial_sum(first_neighbour_.begin(), first_neighbour_.end(), first_neighbour_.begin());
  neighbours_.resize(edges.size());
  for (const auto& [from, to] : edges) neighbours_[first_neighbour_[from + 1]++] = to;
  first_neighbour_.pop_back();
}

MeshVertex HeightGraph::At(std::size_t i) const {
  const auto piece = std::upper_bound(first_.begin(), first_.end(), i) - first_.begin() - 1;
  return {static_cast<int>(piece), static_cast<int>(i - first_[static_cast<std::size_t>(piece)])};
}

absl::StatusOr<HeightTops> HeightGraph::Find(double sign, double persistence, std::size_t most,
                                             const RunContext& run) const {
  const auto height = [&](std::size_t i) { return sign * points_[i].z(); };
  std::vector<std::pair<double, std::size_t>> by_height;  // negative, so that the highest comes first
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (first_neighbour_[i] < first_neighbour_[i + 1]) by_height.emplace_back(-height(i), i);
  }
  std::sort(by_height.begin(), by_height.end());
  std::vector<std::size_t> order;
  for (const auto& [below, i] : by_height) order.push_back(i);
  std::vector<std::size_t> rank(points_.size(), kNone);
  for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = k;

  UnionFind sets(points_.size());
  std::vector<std::size_t> top_of(points_.size(), kNone);  // of each set, by its smallest member
  std::vector<std::size_t> summit(points_.size(), kNone);  // of each vertex: the one it climbs to
  std::vector<std::size_t> swallowed(points_.size(),
                                     kNone);  // of each summit that does not persist: by which
  struct Meeting {
    double persistence;
    std::size_t top, by;
  };
  std::vector<Meeting> younger;
  std::vector<std::size_t> roots;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k % kPoll == 0) PM_RETURN_IF_ERROR(run.Check());
    const std::size_t i = order[k];
    roots.clear();
    double steepest = -1.0;
    Neighbours(i, [&](std::size_t n) {
      if (rank[n] >= k) return;
      const std::size_t root = sets.Find(n);
      if (roots.empty() || roots.back() != root) roots.push_back(root);
      const double rise = height(n) - height(i), length2 = (points_[n] - points_[i]).squaredNorm();
      const double slope2 = length2 > 0.0 ? rise * rise / length2 : kInfinity;
      if (slope2 > steepest) {
        steepest = slope2;
        summit[i] = summit[n];
      }
    });
    if (roots.empty()) {
      summit[i] = top_of[i] = i;
      continue;
    }
    if (roots.size() == 1) {
      const std::size_t top = top_of[roots.front()];
      sets.Join(roots.front(), i);
      top_of[sets.Find(i)] = top;
      continue;
    }
    std::sort(roots.begin(), roots.end(),
              [&](std::size_t a, std::size_t b) { return rank[top_of[a]] < rank[top_of[b]]; });
    roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
    const std::size_t elder = top_of[roots.front()];
    std::size_t into = elder;  // the summit on the elder's side that is climbed to from here
    Neighbours(i, [&](std::size_t n) {
      if (rank[n] < k && into == elder && sets.Find(n) == roots.front()) into = summit[n];
    });
    for (const std::size_t root : roots) {
      const std::size_t top = top_of[root];
      if (top != elder) younger.push_back({height(top) - height(i), top, into});
      sets.Join(root, i);
    }
    top_of[sets.Find(i)] = elder;
  }
  std::stable_sort(younger.begin(), younger.end(),
                   [](const Meeting& a, const Meeting& b) { return a.persistence > b.persistence; });
  for (std::size_t k = 0; k < younger.size(); ++k) {
    if (k >= most || younger[k].persistence < persistence) swallowed[younger[k].top] = younger[k].by;
  }

  const auto persisting = [&](std::size_t top) {
    while (swallowed[top] != kNone) top = swallowed[top];
    return top;
  };
  std::vector<int> many(points_.size(), 0);  // of each sheet: how many summits it has
  for (const std::size_t i : order) many[sets.Find(i)] += summit[i] == i && swallowed[i] == kNone;
  HeightTops found;
  std::vector<bool> beside(points_.size(), false);  // a place where two meet
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t i = order[k];
    if (summit[i] == i && swallowed[i] == kNone && many[sets.Find(i)] > 1) found.tops.push_back(At(i));
    summit[i] = persisting(summit[i]);
    bool meets = false, known = beside[i];
    Neighbours(i, [&](std::size_t n) {
      known = known || beside[n];
      meets = meets || (rank[n] < k && summit[n] != summit[i]);
    });
    if (!meets) continue;
    if (!known) found.passes.push_back(At(i));
    beside[i] = true;
    Neighbours(i, [&](std::size_t n) { beside[n] = true; });
  }
  return found;
}

}  // namespace patchmill
