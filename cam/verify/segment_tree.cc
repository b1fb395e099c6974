#include "cam/verify/segment_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/base/status.h"

namespace patchmill {

namespace {

constexpr std::size_t kLeafSize = 4;
constexpr int kBins = 16;
constexpr int kDeepestBinned = 40;         // below, the list is halved: depth stays under 40 + log2(count)
constexpr double kMostPieces = 2'000'000;  // of cut segments
constexpr float kFar = 1e30F;

float Down(double x) {
  return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}
float Up(double x) { return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity()); }

std::vector<PathSegment> CutLong(std::vector<PathSegment> segments, double longest) {
  double total = 0.0;
  for (const PathSegment& s : segments) total += (s.b - s.a).norm();
  longest = std::max(longest, total / kMostPieces);
  if (std::none_of(segments.begin(), segments.end(),
                   [&](const PathSegment& s) { return (s.b - s.a).norm() > longest; })) {
    return segments;
  }
  std::vector<PathSegment> cut;
  cut.reserve(segments.size());
  for (const PathSegment& s : segments) {
    const auto parts = static_cast<int>(std::ceil((s.b - s.a).norm() / longest));
    if (parts <= 1) {
      cut.push_back(s);
      continue;
    }
    Vec3 from = s.a;
    for (int i = 1; i <= parts; ++i) {
      const Vec3 to = i == parts ? s.b : Vec3(s.a + (s.b - s.a) * (static_cast<double>(i) / parts));
      cut.push_back({from, to, s.move});
      from = to;
    }
  }
  return cut;
}

}  // namespace

SegmentTree::SegmentTree(std::vector<PathSegment> segments, Metric metric, double longest,
                         const RunContext& run, double shank_radius)
    : metric_(metric), shank_radius_(shank_radius), segments_(CutLong(std::move(segments), longest)) {
  if (segments_.empty()) return;
  std::vector<std::int32_t> order(segments_.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(segments_.size() / 2 + 2);
  nodes_.emplace_back();  // the root holds the whole tree as its first child
  const Range all = Build(order, 0, order.size(), 0, run);
  SetChild(0, 0, all);
  SetChild(0, 1, {-1, 0, {{kFar, kFar, kFar}, {kFar, kFar, kFar}}});  // empty, never near
  std::vector<PathSegment> sorted;
  sorted.reserve(segments_.size());
  for (const std::int32_t i : order) sorted.push_back(segments_[static_cast<std::size_t>(i)]);
  segments_ = std::move(sorted);
}

SegmentTree::Box SegmentTree::BoxOf(const std::vector<std::int32_t>& order, std::size_t begin,
                                    std::size_t end) const {
  Box3 box;
  for (std::size_t i = begin; i < end; ++i) {
    const PathSegment& s = segments_[static_cast<std::size_t>(order[i])];
    box.Add(s.a);
    box.Add(s.b);
  }
  return {{Down(box.min.x()), Down(box.min.y()), Down(box.min.z())},
          {Up(box.max.x()), Up(box.max.y()), Up(box.max.z())}};
}

SegmentTree::Range SegmentTree::Build(std::vector<std::int32_t>& order, std::size_t begin, std::size_t end,
                                      int depth, const RunContext& run) {
  const Box box = BoxOf(order, begin, end);
  if (end - begin <= kLeafSize || run.Cancelled()) {
    return {-static_cast<std::int32_t>(begin) - 1, static_cast<std::int32_t>(end - begin), box};
  }
  const auto middle = [&](std::int32_t i, int axis) {
    const PathSegment& s = segments_[static_cast<std::size_t>(i)];
    return 0.5 * (s.a[axis] + s.b[axis]);
  };
  Box3 centres;
  for (std::size_t i = begin; i < end; ++i) {
    centres.Add(Vec3(middle(order[i], 0), middle(order[i], 1), middle(order[i], 2)));
  }
  int axis = 0;
  const double width = (centres.max - centres.min).maxCoeff(&axis);
  const double low = centres.min[axis];
  std::size_t cut = begin;
  if (depth < kDeepestBinned && width > 0.0) {
    // Binned surface area heuristic along the widest axis.
    const auto bin_of = [&](std::int32_t i) {
      return std::min(kBins - 1, static_cast<int>((middle(i, axis) - low) / width * kBins));
    };
    std::array<Box3, kBins> bins;
    std::array<double, kBins> counts{};
    for (std::size_t i = begin; i < end; ++i) {
      const PathSegment& s = segments_[static_cast<std::size_t>(order[i])];
      const auto b = static_cast<std::size_t>(bin_of(order[i]));
      bins[b].Add(s.a);
      bins[b].Add(s.b);
      counts[b] += 1.0;
    }
    const auto area = [](const Box3& b) {
      if (b.Empty()) return 0.0;
      const Vec3 d = b.max - b.min;
      return d.x() * d.y() + d.y() * d.z() + d.z() * d.x();
    };
    std::array<double, kBins> right_cost{};
    Box3 right;
    double right_count = 0.0;
    for (int b = kBins - 1; b > 0; --b) {
      right.Add(bins[static_cast<std::size_t>(b)]);
      right_count += counts[static_cast<std::size_t>(b)];
      right_cost[static_cast<std::size_t>(b)] = area(right) * right_count;
    }
    Box3 left;
    double left_count = 0.0, best = kInfinity;
    int best_bin = 0;
    for (int b = 1; b < kBins; ++b) {
      left.Add(bins[static_cast<std::size_t>(b - 1)]);
      left_count += counts[static_cast<std::size_t>(b - 1)];
      const double cost = area(left) * left_count + right_cost[static_cast<std::size_t>(b)];
      if (left_count > 0.0 && left_count < static_cast<double>(end - begin) && cost < best) {
        best = cost;
        best_bin = b;
      }
    }
    if (best_bin > 0) {
      const auto split = std::stable_partition(order.begin() + static_cast<std::ptrdiff_t>(begin),
                                               order.begin() + static_cast<std::ptrdiff_t>(end),
                                               [&](std::int32_t i) { return bin_of(i) < best_bin; });
      cut = static_cast<std::size_t>(split - order.begin());
    }
  }
  if (cut == begin || cut == end) cut = begin + (end - begin) / 2;

  const auto at = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  const Range left = Build(order, begin, cut, depth + 1, run);
  const Range right = Build(order, cut, end, depth + 1, run);
  SetChild(at, 0, left);
  SetChild(at, 1, right);
  return {at, 0, box};
}

void SegmentTree::SetChild(std::int32_t node, int side, const Range& range) {
  Node& n = nodes_[static_cast<std::size_t>(node)];
  for (int k = 0; k < 3; ++k) {
    n.low[k][side] = range.box.low[k];
    n.high[k][side] = range.box.high[k];
  }
  n.child[side] = range.child;
  n.count[side] = range.count;
}

// Both children at once, a lane each.
SegmentTree::Pair SegmentTree::ChildDistances2(const Node& node, const Vec3& p) const {
  const auto load = [](const float(&x)[2]) { return Pair{x[0], x[1]}; };
  const auto above_zero = [](Pair x) { return x > 0.0 ? x : Pair{}; };
  const auto outside = [&](int axis) {
    const Pair below = load(node.low[axis]) - p[axis], above = p[axis] - load(node.high[axis]);
    return above_zero(below > above ? below : above);
  };
  const Pair dx = outside(0), dy = outside(1), plan = dx * dx + dy * dy;
  if (metric_ == Metric::kPath) {
    const Pair dz = outside(2);
    return plan + dz * dz;
  }
  // No upper end in z: the swept sets go up for ever.
  const Pair rise = load(node.low[2]) - p.z();
  if (metric_ == Metric::kSwept) {
    const Pair dz = above_zero(rise);
    return plan + dz * dz;
  }
  const Pair deep = above_zero(rise + shank_radius_), deep2 = deep * deep;
  return plan > deep2 ? plan : deep2;
}

double SegmentTree::Distance(int i, const Vec3& p) const {
  switch (metric_) {
    case Metric::kPath:
      return PathDistance(segment(i), p);
    case Metric::kSwept:
      return SweptDistance(segment(i), p);
    case Metric::kShank:
      return ShankDistance(segment(i), p, shank_radius_);
  }
  return 0.0;
}

MetricValue SegmentTree::DistanceAndGradient(int i, const Vec3& p) const {
  switch (metric_) {
    case Metric::kPath:
      return PathDistanceAndGradient(segment(i), p);
    case Metric::kSwept:
      return SweptDistanceAndGradient(segment(i), p);
    case Metric::kShank:
      return ShankDistanceAndGradient(segment(i), p, shank_radius_);
  }
  return {};
}

SegmentTree::Nearest SegmentTree::FindNearest(const Vec3& p, double limit, int hint, double slack) const {
  Nearest best{limit, -1};
  if (segments_.empty()) return best;
  if (hint >= 0) {
    const double d = Distance(hint, p);
    if (d < best.distance) best = {d, hint};
  }
  struct Open {
    double distance2;
    std::int32_t node;
  };
  std::array<Open, 128> stack;
  std::size_t size = 0;
  stack[size++] = {0.0, 0};
  const double keep = 1.0 - slack;
  const auto is_near = [&](double distance2) {
    const double limit_here = best.distance * keep;
    return limit_here > 0.0 && distance2 < limit_here * limit_here;
  };
  while (size > 0) {
    const Open open = stack[--size];
    if (!is_near(open.distance2)) continue;
    const Node& node = nodes_[static_cast<std::size_t>(open.node)];
    const Pair distance2 = ChildDistances2(node, p);
    const std::size_t near = distance2[1] < distance2[0] ? 1 : 0;
    for (const std::size_t k : {1 - near, near}) {  // inner nodes: the nearer one on top of the stack
      if (node.child[k] >= 0 && is_near(distance2[k])) {
        PM_CHECK(size < stack.size());
        stack[size++] = {distance2[k], node.child[k]};
      }
    }
    for (const std::size_t k : {near, 1 - near}) {
      if (node.child[k] >= 0 || !is_near(distance2[k])) continue;
      const int first = -node.child[k] - 1;
      for (int i = first; i < first + node.count[k]; ++i) {
        const double d = Distance(i, p);
        if (d < best.distance) best = {d, i};
      }
    }
  }
  return best;
}

void SegmentTree::FindWithin(const Vec3& p, double limit, std::vector<int>& found) const {
  found.clear();
  if (segments_.empty() || !(limit > 0.0)) return;
  std::array<std::int32_t, 128> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[static_cast<std::size_t>(stack[--size])];
    const Pair distance2 = ChildDistances2(node, p);
    for (std::size_t k = 0; k < 2; ++k) {
      if (!(distance2[k] < limit * limit)) continue;
      if (node.child[k] >= 0) {
        PM_CHECK(size < stack.size());
        stack[size++] = node.child[k];
        continue;
      }
      const int first = -node.child[k] - 1;
      for (int i = first; i < first + node.count[k]; ++i) {
        if (Distance(i, p) < limit) found.push_back(i);
      }
    }
  }
}

}  // namespace patchmill
