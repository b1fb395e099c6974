#include "core/network/edge_links.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "core/base/index.h"

namespace patchmill {
namespace {

constexpr std::size_t kMaxCurvesPerPair = 64;
constexpr std::size_t kMaxPatchesPerRim = 16;  // different patches with one closed rim that are kept apart

// Whether b runs against a; both are closed edges from one vertex.
bool LoopsBackwards(const EdgeCurves& curves, int a, int b) {
  return ClosestOnEdge(curves, b, curves.Point(a, 0.25)).t > ClosestOnEdge(curves, b, curves.Point(a, 0.5)).t;
}

// Points inside a patch, which a turn or mirror image of its parameters only permutes.
std::vector<Vec3> InsidePoints(const PatchShape& shape) {
  std::vector<Vec3> points;
  if (IsTriangle(shape)) {
    points.push_back(Position(shape, 1.0 / 3.0, 1.0 / 3.0));
    for (const auto& [s, t] : {std::pair(1.0, 1.0), std::pair(4.0, 1.0), std::pair(1.0, 4.0)}) {
      points.push_back(Position(shape, s / 6.0, t / 6.0));
    }
    return points;
  }
  for (const double u : {0.25, 0.5, 0.75}) {
    for (const double v : {0.25, 0.5, 0.75}) points.push_back(Position(shape, u, v));
  }
  return points;
}

bool SameInside(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double tolerance) {
  if (a.size() != b.size()) return false;
  return std::all_of(a.begin(), a.end(), [&](const Vec3& p) {
    return std::any_of(b.begin(), b.end(), [&](const Vec3& q) { return (p - q).norm() <= tolerance; });
  });
}

}  // namespace

std::vector<EdgeEnds> EdgeEndVertices(const EdgeCurves& curves, const CornerVertices& corners) {
  std::vector<EdgeEnds> ends;
  ends.reserve(At(curves.count()));
  for (int e = 0; e < curves.count(); ++e) {
    ends.push_back({corners.vertex_of[At(2 * e)], corners.vertex_of[At(2 * e + 1)]});
  }
  return ends;
}

EdgeClusters ClusterEdges(const EdgeCurves& curves, const std::vector<EdgeEnds>& ends, double tolerance,
                          const RunContext& run) {
  EdgeClusters clusters;
  clusters.cluster_of.assign(ends.size(), -1);
  clusters.reversed.assign(ends.size(), false);
  std::vector<int> order;
  for (int e = 0; e < curves.count(); ++e) {
    if (curves.reach(e) > tolerance) order.push_back(e);
  }
  const auto key = [&](int e) { return std::minmax({ends[At(e)].start, ends[At(e)].end}); };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size();) {
    std::size_t j = i;
    const std::size_t first = clusters.members.size();
    for (; j < order.size() && key(order[j]) == key(order[i]); ++j) {
      if (run.Cancelled()) return clusters;
      const int e = order[j];
      const bool loop = ends[At(e)].start == ends[At(e)].end;
      const std::size_t last = std::min(clusters.members.size(), first + kMaxCurvesPerPair);
      int found = -1;
      for (std::size_t c = first; c < last && found < 0; ++c) {
        const int other = clusters.members[c].front();
        const bool reversed =
            loop ? LoopsBackwards(curves, other, e) : ends[At(e)].start != ends[At(other)].start;
        if (!EdgesAgree(curves, e, other, reversed, tolerance)) continue;
        found = static_cast<int>(c);
        clusters.reversed[At(e)] = reversed;
      }
      if (found < 0) {
        found = static_cast<int>(clusters.members.size());
        clusters.members.emplace_back();
      }
      clusters.members[At(found)].push_back(e);
      clusters.cluster_of[At(e)] = found;
    }
    i = j;
  }
  return clusters;
}

std::vector<std::optional<PatchId>> FindDuplicates(const PatchModel& model, const EdgeCurves& curves,
                                                   const EdgeClusters& clusters, double tolerance) {
  std::vector<std::optional<PatchId>> duplicate_of(model.patches.size());
  std::map<std::vector<int>, std::vector<int>> by_rim;  // sorted clusters of the edges -> different patches
  for (std::size_t k = 0; k < model.patches.size(); ++k) {
    const PatchShape& shape = model.patches[k].shape;
    std::vector<int> rim;
    bool alone = false;
    for (int i = 0; i < EdgeCount(shape); ++i) {
      const int cluster = clusters.cluster_of[At(curves.first_edge()[k] + i)];
      if (cluster < 0) continue;
      rim.push_back(cluster);
      alone = alone || clusters.members[At(cluster)].size() < 2;
    }
    if (rim.empty() || alone) continue;
    std::sort(rim.begin(), rim.end());
    std::vector<int>& seen = by_rim[rim];
    if (seen.empty()) {
      seen.push_back(static_cast<int>(k));
      continue;
    }
    const std::vector<Vec3> inside = InsidePoints(shape);
    const auto same = std::find_if(seen.begin(), seen.end(), [&](int other) {
      return SameInside(inside, InsidePoints(model.patches[At(other)].shape), tolerance);
    });
    if (same != seen.end()) {
      duplicate_of[k] = PatchId(*same);
    } else if (seen.size() < kMaxPatchesPerRim) {
      seen.push_back(static_cast<int>(k));
    }
  }
  return duplicate_of;
}

std::vector<EdgeLink> LinkEdges(const EdgeCurves& curves, const EdgeClusters& clusters,
                                const std::vector<std::optional<PatchId>>& duplicate_of, double tolerance,
                                const RunContext& run) {
  std::vector<EdgeLink> links(At(curves.count()));
  const auto connect = [&](int from, int to) {
    EdgeLink& link = links[At(from)];
    link.neighbor = curves.edge(to);
    link.reversed = clusters.reversed[At(from)] != clusters.reversed[At(to)];
    const EdgeLink& back = links[At(to)];
    const bool known = back.neighbor && *back.neighbor == link.self;
    link.gap = known ? back.gap : EdgeDistance(curves, from, to, link.reversed, tolerance);
  };
  for (int e = 0; e < curves.count(); ++e) {
    links[At(e)].self = curves.edge(e);
    links[At(e)].collapsed = clusters.cluster_of[At(e)] < 0;
  }
  for (const std::vector<int>& members : clusters.members) {
    if (run.Cancelled()) break;
    std::vector<int> own, copies;
    for (const int e : members) (duplicate_of[curves.edge(e).patch.index()] ? copies : own).push_back(e);
    if (own.empty()) continue;  // not possible: the original of a copy lies in the same cluster
    for (std::size_t i = 1; i < own.size(); ++i) {
      if (i == 1) connect(own[0], own[1]);
      connect(own[i], own[0]);
    }
    for (const int e : copies) {
      const PatchId original = *duplicate_of[curves.edge(e).patch.index()];
      const bool other_side = own.size() > 1 && curves.edge(own[0]).patch == original;
      connect(e, own[other_side ? 1 : 0]);
    }
  }
  return links;
}

}  // namespace patchmill
