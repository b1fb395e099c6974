#include "cam/link/order_passes.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "cam/link/order_parts.h"
#include "cam/link/shorten_order.h"
#include "cam/region/map/pass_regions.h"
#include "core/base/status.h"
#include "core/base/union_find.h"

namespace patchmill {
namespace {

constexpr int kLevelReach = 2;  // levels whose order keys differ by more are no neighbours

Box3 XyBox(const CutterPath& path) {
  Box3 box;
  for (const CutterPoint& p : path.points) box.Add(p.center);
  return box;
}

double XyGap(const Box3& a, const Box3& b) {
  double squared = 0.0;
  for (const int k : {0, 1}) {
    const double gap = std::max({0.0, a.min[k] - b.max[k], b.min[k] - a.max[k]});
    squared += gap * gap;
  }
  return std::sqrt(squared);
}

// True if some of the vertices of a (about 48 of them) are within `limit` of b in plan. This is coarse, but
// enough to decide which passes belong together.
bool Near(const CutterPath& a, const Box3& box_a, const CutterPath& b, const Box3& box_b, double limit) {
  if (XyGap(box_a, box_b) > limit) return false;
  const std::size_t step_a = std::max<std::size_t>(1, a.points.size() / 48);
  const double limit2 = limit * limit;
  for (std::size_t i = 0; i < a.points.size(); i += step_a) {
    const Vec2 p = Xy(a.points[i].center);
    for (std::size_t j = 0; j < b.points.size(); ++j) {
      const Vec2 q = Xy(b.points[j].center);
      const Vec2 r = Xy(b.points[(j + 1) % b.points.size()].center);
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
    case PassKind::kBorder:
      return 2;
    case PassKind::kPencil:
      return 3;
    case PassKind::kRest:
      return 4;
  }
  return 4;
}

struct End {
  double distance = kInfinity;
  std::size_t start = 0;  // closed pass: vertex to start at; open pass: 0 forward, 1 reversed
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

// Passes of one kind that belong together: one mountain, or one set of lines. Sorted by order key.
struct Cluster {
  std::vector<CutterPath> passes;
  std::vector<std::vector<std::size_t>> above;  // [pass]: nearby contours of the levels above its own
};

// Adds a pass that is cut from this end.
void Take(CutterPath& pass, const End& end, Vec3& at, std::vector<CutterPath>& out) {
  StartAt(pass, end.start);
  at = pass.closed ? pass.points.front().center : pass.points.back().center;
  out.push_back(std::move(pass));
}

End EndOf(const CutterPath& pass, const Vec3& from, bool reversible) {
  return NearestEnd(pass, from, reversible && pass.traversal == Traversal::kAny);
}

// Adds the passes of a cluster, each time the nearest one. Stops when cancelled.
void TakeNearest(Cluster& cluster, const RunContext& run, Vec3& at, std::vector<CutterPath>& out) {
  std::vector<bool> done(cluster.passes.size(), false);
  for (std::size_t n = 0; n < cluster.passes.size() && !run.Cancelled(); ++n) {
    std::size_t best = cluster.passes.size();
    End best_end;
    for (std::size_t i = 0; i < cluster.passes.size(); ++i) {
      if (done[i]) continue;
      const End end = EndOf(cluster.passes[i], at, true);
      if (best == cluster.passes.size() || end.distance < best_end.distance) {
        best = i;
        best_end = end;
      }
    }
    done[best] = true;
    Take(cluster.passes[best], best_end, at, out);
  }
}

// The pass that is cut next, and where it starts (as in End).
struct Choice {
  std::size_t pass;
  std::size_t start;
};

Vec3 Enter(const CutterPath& pass, std::size_t start) {
  if (pass.closed) return pass.points[start].center;
  return start == 1 ? pass.points.back().center : pass.points.front().center;
}

Vec3 Leave(const CutterPath& pass, std::size_t start) {
  if (pass.closed) return pass.points[start].center;
  return start == 1 ? pass.points.front().center : pass.points.back().center;
}

double HeightOf(const CutterPath& contour) { return contour.points.front().center.z(); }

// Orders contours from the top down, none before those above it. A mountain or basin is cut to its foot, or
// to where it joins another that is not cut yet, before the next one is begun. Stops when cancelled.
std::vector<Choice> Downwards(const Cluster& cluster, const OrderParams& params, const RunContext& run,
                              Vec3 at) {
  const std::size_t count = cluster.passes.size();
  std::vector<std::vector<std::size_t>> below(count);
  std::vector<std::size_t> waiting(count);  // [pass]: number of passes above it that are not cut yet
  for (std::size_t i = 0; i < count; ++i) {
    waiting[i] = cluster.above[i].size();
    for (const std::size_t j : cluster.above[i]) below[j].push_back(i);
  }
  struct Ready {
    std::size_t pass;
    std::ptrdiff_t after;  // step in which the last pass above it was cut
  };
  std::vector<Ready> ready;
  for (std::size_t i = 0; i < count; ++i) {
    if (waiting[i] == 0) ready.push_back({i, -1});
  }
  std::vector<Choice> order;
  for (std::ptrdiff_t n = 0; !ready.empty() && !run.Cancelled(); ++n) {
    // Passes at hand come first, higher ones before lower ones. Then come those below the pass cut last.
    using Rank = std::tuple<int, std::ptrdiff_t, double, double>;
    std::size_t best = 0;
    Rank best_rank;
    End best_end;
    for (std::size_t k = 0; k < ready.size(); ++k) {
      const CutterPath& pass = cluster.passes[ready[k].pass];
      const End end = EndOf(pass, at, params.reversible_contours);
      const double depth = -HeightOf(pass);
      const Rank rank = end.distance <= params.at_hand ? Rank{0, 0, depth, end.distance}
                                                       : Rank{1, -ready[k].after, depth, end.distance};
      if (k > 0 && rank >= best_rank) continue;
      best = k;
      best_rank = rank;
      best_end = end;
    }
    const std::size_t taken = ready[best].pass;
    ready.erase(ready.begin() + static_cast<std::ptrdiff_t>(best));
    order.push_back({taken, best_end.start});
    at = Leave(cluster.passes[taken], best_end.start);
    for (const std::size_t i : below[taken]) {
      if (--waiting[i] == 0) ready.push_back({i, n});
    }
  }
  return order;
}

// The same passes in a quicker order, still none before those above it.
std::vector<Choice> Quicker(const Cluster& cluster, const std::vector<Choice>& order,
                            const OrderParams& params, const RunContext& run, Vec3 at) {
  std::vector<Stop> stops(cluster.passes.size());
  std::vector<std::size_t> sequence;
  for (const Choice& c : order) {
    const CutterPath& pass = cluster.passes[c.pass];
    stops[c.pass] = {Enter(pass, c.start), Leave(pass, c.start), cluster.above[c.pass]};
    sequence.push_back(c.pass);
  }
  std::vector<Choice> quicker;
  for (const std::size_t i : ShortenOrder(stops, std::move(sequence), at, params.travel, run)) {
    const CutterPath& pass = cluster.passes[i];
    quicker.push_back({i, EndOf(pass, at, params.reversible_contours).start});
    at = Leave(pass, quicker.back().start);
  }
  return quicker;
}

void TakeDownwards(Cluster& cluster, const OrderParams& params, const RunContext& run, Vec3& at,
                   std::vector<CutterPath>& out) {
  std::vector<Choice> order = Downwards(cluster, params, run, at);
  if (run.Cancelled()) return;
  if (params.travel) order = Quicker(cluster, order, params, run, at);
  for (const Choice& c : order) {
    at = Leave(cluster.passes[c.pass], c.start);
    StartAt(cluster.passes[c.pass], c.start);
    out.push_back(std::move(cluster.passes[c.pass]));
  }
}

// True if one of two open contours begins where the other ends. Opposite walls of a slot are cut back and
// forth.
bool LeadsOn(const CutterPath& a, const CutterPath& b, double reach) {
  const auto far = [](const CutterPath& from, const CutterPath& to) {
    return (to.points.front().center - from.points.back().center).norm();
  };
  return std::min(far(a, b), far(b, a)) <= reach;
}

// Joins open contours at about the same height that lead on to each other. Their order keys do not matter,
// because each group has levels of its own.
void JoinThoseThatLeadOn(const std::vector<CutterPath>& contours, double reach, double higher,
                         const RunContext& run, UnionFind& sets) {
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < contours.size(); ++i)
    if (!contours[i].closed) open.push_back(i);
  std::stable_sort(open.begin(), open.end(), [&](std::size_t a, std::size_t b) {
    return HeightOf(contours[a]) < HeightOf(contours[b]);
  });
  for (std::size_t i = 0; i < open.size() && !run.Cancelled(); ++i) {
    for (std::size_t j = i + 1; j < open.size(); ++j) {
      const CutterPath &a = contours[open[i]], &b = contours[open[j]];
      if (HeightOf(b) - HeightOf(a) > higher) break;
      if (sets.Find(open[i]) != sets.Find(open[j]) && LeadsOn(a, b, reach)) sets.Join(open[i], open[j]);
    }
  }
}

// Divides passes of one kind into clusters, in the order of their first passes. Stops when cancelled.
std::vector<Cluster> Clusters(std::vector<CutterPath> group, const OrderParams& params, int line_reach,
                              const RunContext& run) {
  const double distance = params.neighbor_distance;
  std::stable_sort(group.begin(), group.end(),
                   [](const auto& a, const auto& b) { return a.order_key < b.order_key; });
  const bool levels = group.front().kind == PassKind::kContour;
  std::vector<Box3> boxes;
  for (const CutterPath& path : group) boxes.push_back(XyBox(path));
  UnionFind sets(group.size());
  std::vector<std::vector<std::size_t>> above(group.size());
  for (std::size_t i = 0; i < group.size() && !run.Cancelled(); ++i) {
    for (std::size_t j = i + 1; j < group.size() && group[j].order_key - group[i].order_key <= line_reach;
         ++j) {
      const bool lower = levels && group[j].order_key > group[i].order_key;
      if (!lower && sets.Find(i) == sets.Find(j)) continue;
      const bool near = Near(group[i], boxes[i], group[j], boxes[j], distance) ||
                        Near(group[j], boxes[j], group[i], boxes[i], distance);
      if (near && lower) above[j].push_back(i);
      if (near) sets.Join(i, j);
    }
  }
  if (levels) JoinThoseThatLeadOn(group, params.at_hand, distance, run, sets);
  std::map<std::size_t, std::vector<std::size_t>> by_root;
  for (std::size_t i = 0; i < group.size(); ++i) by_root[sets.Find(i)].push_back(i);
  std::vector<Cluster> clusters;
  std::vector<std::size_t> place(group.size());
  for (const auto& [root, members] : by_root) {
    Cluster& cluster = clusters.emplace_back();
    for (const std::size_t i : members) {
      place[i] = cluster.passes.size();
      cluster.passes.push_back(std::move(group[i]));
      std::vector<std::size_t>& own = cluster.above.emplace_back();
      for (const std::size_t j : above[i]) own.push_back(place[j]);
    }
  }
  return clusters;
}

// Passes near a border may count for the component beyond it. So a part does not lie in a component that has
// less than this share of the length in its main component.
constexpr double kTouchedOnly = 0.1;

JobPart PartOf(const Cluster& cluster, const RegionMap& regions) {
  std::map<ComponentId, double> lengths;
  double most = 0.0, low = kInfinity, high = -kInfinity;
  for (const CutterPath& pass : cluster.passes) {
    for (const CutterPoint& p : pass.points) {
      low = std::min(low, p.center.z());
      high = std::max(high, p.center.z());
    }
    for (const auto& [component, length] : LengthInComponents(pass, regions)) {
      if (component != kNoComponent) most = std::max(most, lengths[component] += length);
    }
  }
  JobPart part{.components = {}, .height = 0.5 * (low + high)};
  for (const auto& [component, length] : lengths) {
    if (length >= kTouchedOnly * most) part.components.push_back(component);
  }
  return part;
}

}  // namespace

absl::StatusOr<std::vector<CutterPath>> OrderPasses(const RegionMap& regions, std::vector<CutterPath> paths,
                                                    const OrderParams& params, const RunContext& run) {
  // The contours of a mountain may change their region on the way down, and their levels decide. So all
  // contours form one group. The lines of each region form a group. Border, pencil and rest passes come last.
  using Key = std::tuple<int, double, RegionId>;
  std::map<Key, std::vector<CutterPath>> groups;
  for (CutterPath& path : paths) {
    if (path.points.empty()) continue;
    const bool known = path.region != kNoRegion && path.region.index() < regions.regions.size();
    const double top = known ? regions.regions[path.region.index()].z_max : -kInfinity;
    const bool by_region = path.kind == PassKind::kZigzag && known;
    groups[{KindRank(path.kind), by_region ? -top : 0.0, by_region ? path.region : kNoRegion}].push_back(
        std::move(path));
  }
  std::vector<Cluster> clusters;  // of contours and lines
  std::vector<JobPart> parts;
  std::vector<Cluster> last;
  for (auto& [key, group] : groups) {
    const PassKind kind = group.front().kind;
    const bool contour = kind == PassKind::kContour, line = kind == PassKind::kZigzag;
    const int reach = contour ? kLevelReach : line ? kLineReach : std::numeric_limits<int>::max();
    for (Cluster& cluster : Clusters(std::move(group), params, reach, run)) {
      if (contour || line) parts.push_back(PartOf(cluster, regions));
      (contour || line ? clusters : last).push_back(std::move(cluster));
    }
    PM_RETURN_IF_ERROR(run.Check());
  }
  std::vector<CutterPath> out;
  Vec3 at(0, 0, kInfinity);
  const auto take = [&](Cluster& cluster) {
    if (out.empty()) at = cluster.passes.front().points.front().center;
    if (cluster.passes.front().kind == PassKind::kContour) {
      TakeDownwards(cluster, params, run, at, out);
    } else {
      TakeNearest(cluster, run, at, out);
    }
    return run.Check();
  };
  const std::vector<std::size_t> order = OrderParts(regions, parts, run);
  PM_RETURN_IF_ERROR(run.Check());
  for (const std::size_t i : order) PM_RETURN_IF_ERROR(take(clusters[i]));
  for (Cluster& cluster : last) PM_RETURN_IF_ERROR(take(cluster));
  return out;
}

}  // namespace patchmill
