#include "cam/link/order_passes.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "core/base/status.h"
#include "core/base/union_find.h"

namespace patchmill {
namespace {

Box3 PlanBox(const CutterPath& path) {
  Box3 box;
  for (const CutterPoint& p : path.points) box.Add(p.center);
  return box;
}

double PlanGap(const Box3& a, const Box3& b) {
  double squared = 0.0;
  for (const int k : {0, 1}) {
    const double gap = std::max({0.0, a.min[k] - b.max[k], b.min[k] - a.max[k]});
    squared += gap * gap;
  }
  return std::sqrt(squared);
}

// Smallest distance in plan between vertices of a and the vertices of b, at most `limit` looked for; coarse
// but enough to tell which passes belong together.
bool Near(const CutterPath& a, const Box3& box_a, const CutterPath& b, const Box3& box_b, double limit) {
  if (PlanGap(box_a, box_b) > limit) return false;
  const std::size_t step_a = std::max<std::size_t>(1, a.points.size() / 48);
  const double limit2 = limit * limit;
  for (std::size_t i = 0; i < a.points.size(); i += step_a) {
    const Vec2 p = Plan(a.points[i].center);
    for (std::size_t j = 0; j < b.points.size(); ++j) {
      const Vec2 q = Plan(b.points[j].center);
      const Vec2 r = Plan(b.points[(j + 1) % b.points.size()].center);
      const bool last = j + 1 == b.points.size() && !b.closed;
      const Vec2 d = last ? Vec2(0, 0) : Vec2(r - q);
      const double t = d.squaredNorm() > 0 ? std::clamp((p - q).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
      if ((q + t * d - p).squaredNorm() <= limit2) return true;
    }
  }
  return false;
}

int KindRank(PassKind kind) {
  switch (kind) {
    case PassKind::kContour:
      return 0;
    case PassKind::kZigzag:
      return 1;
    case PassKind::kCrease:
      return 2;
    case PassKind::kRest:
      return 3;
  }
  return 3;
}

struct End {
  double distance = kInfinity;
  std::size_t start = 0;  // closed: vertex to start at; open: 0 forward, 1 reversed
};

End NearestEnd(const CutterPath& path, const Vec3& from, bool reversible) {
  End end;
  if (path.closed) {
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      const double d = (path.points[i].center - from).norm();
      if (d < end.distance) end = {d, i};
    }
    return end;
  }
  end = {(path.points.front().center - from).norm(), 0};
  if (reversible) {
    const double d = (path.points.back().center - from).norm();
    if (d < end.distance) end = {d, 1};
  }
  return end;
}

void StartAt(CutterPath& path, std::size_t start) {
  if (path.closed) {
    RotateClosed(path, start);
  } else if (start == 1) {
    Reverse(path);
  }
}

// Takes the passes of one cluster nearest first; `layered`: a line is finished before the next one is begun.
// Stops when cancelled.
void TakeCluster(std::vector<CutterPath>& cluster, bool layered, bool reversible, const RunContext& run,
                 Vec3& at, std::vector<CutterPath>& out) {
  std::vector<bool> done(cluster.size(), false);
  for (std::size_t n = 0; n < cluster.size() && !run.Cancelled(); ++n) {
    int layer = std::numeric_limits<int>::max();
    if (layered) {
      for (std::size_t i = 0; i < cluster.size(); ++i) {
        if (!done[i]) layer = std::min(layer, cluster[i].line);
      }
    }
    std::size_t best = cluster.size();
    End best_end;
    for (std::size_t i = 0; i < cluster.size(); ++i) {
      if (done[i] || (layered && cluster[i].line != layer)) continue;
      const End end = NearestEnd(cluster[i], at, reversible && !cluster[i].one_way && !cluster[i].spiral);
      if (best == cluster.size() || end.distance < best_end.distance) {
        best = i;
        best_end = end;
      }
    }
    done[best] = true;
    StartAt(cluster[best], best_end.start);
    at = cluster[best].closed ? cluster[best].points.front().center : cluster[best].points.back().center;
    out.push_back(std::move(cluster[best]));
  }
}

// Passes of one kind and region, split into connected clusters (one mountain, one field of lines), in order
// of their first line.
std::vector<std::vector<CutterPath>> Clusters(std::vector<CutterPath> group, double distance, int line_reach,
                                              const RunContext& run) {
  std::stable_sort(group.begin(), group.end(), [](const auto& a, const auto& b) { return a.line < b.line; });
  std::vector<Box3> boxes;
  for (const CutterPath& path : group) boxes.push_back(PlanBox(path));
  UnionFind sets(group.size());
  for (std::size_t i = 0; i < group.size() && !run.Cancelled(); ++i) {
    for (std::size_t j = i + 1; j < group.size() && group[j].line - group[i].line <= line_reach; ++j) {
      if (sets.Find(i) == sets.Find(j)) continue;
      if (Near(group[i], boxes[i], group[j], boxes[j], distance) ||
          Near(group[j], boxes[j], group[i], boxes[i], distance)) {
        sets.Join(i, j);
      }
    }
  }
  std::map<std::size_t, std::vector<CutterPath>> by_root;
  for (std::size_t i = 0; i < group.size(); ++i) by_root[sets.Find(i)].push_back(std::move(group[i]));
  std::vector<std::vector<CutterPath>> clusters;
  for (auto& [root, cluster] : by_root) clusters.push_back(std::move(cluster));
  return clusters;
}

}  // namespace

void RotateClosed(CutterPath& path, std::size_t start) {
  std::rotate(path.points.begin(), path.points.begin() + static_cast<std::ptrdiff_t>(start),
              path.points.end());
}

void Reverse(CutterPath& path) {
  std::reverse(path.points.begin(), path.points.end());
  for (CutterPoint& p : path.points) {
    if (p.other_contact) std::swap(p.contact, p.other_contact);
  }
}

absl::StatusOr<std::vector<CutterPath>> OrderPasses(const RegionMap& regions, std::vector<CutterPath> paths,
                                                    const OrderParams& params, const RunContext& run) {
  // Key: kind, then the region's top from high to low, then its id.
  using Key = std::tuple<int, double, int>;
  std::map<Key, std::vector<CutterPath>> groups;
  for (CutterPath& path : paths) {
    if (path.points.empty()) continue;
    const bool known = path.region >= 0 && static_cast<std::size_t>(path.region) < regions.regions.size();
    const double top = known ? regions.regions[static_cast<std::size_t>(path.region)].z_max : -kInfinity;
    // Contours of one mountain may change their region on the way down; levels decide, so contours form one
    // group.
    const bool by_region = path.kind == PassKind::kZigzag && known;
    groups[{KindRank(path.kind), by_region ? -top : 0.0, by_region ? path.region : -1}].push_back(
        std::move(path));
  }
  std::vector<CutterPath> out;
  Vec3 at(0, 0, kInfinity);
  bool started = false;
  for (auto& [key, group] : groups) {
    const PassKind kind = group.front().kind;
    const bool contour = kind == PassKind::kContour;
    const int reach = contour || kind == PassKind::kZigzag ? 2 : std::numeric_limits<int>::max();
    for (auto& cluster : Clusters(std::move(group), params.neighbor_distance, reach, run)) {
      if (!started) at = cluster.front().points.front().center;
      started = true;
      TakeCluster(cluster, contour, contour ? params.reversible_contours : true, run, at, out);
    }
    PM_RETURN_IF_ERROR(run.Check());
  }
  return out;
}

}  // namespace patchmill
