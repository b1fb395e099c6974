#include "cam/toolpath/segment_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/base/round_outward.h"
#include "core/base/status.h"

namespace patchmill {

namespace {

// For these metrics a move is not the sum of its parts.
bool OverBox(Metric metric) { return metric == Metric::kSweptBox || metric == Metric::kShankBox; }
bool OfShank(Metric metric) { return metric == Metric::kShank || metric == Metric::kShankBox; }

constexpr double kMostPieces = 2'000'000;  // number of segments after cutting
constexpr float kFar = 1e30F;              // its square is infinite, so it is never near

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

struct SegmentTree::Order {
  struct Item {
    Vec3 middle;  // twice the midpoint
    std::int32_t segment;
  };
  const std::vector<PathSegment>& segments;
  const RunContext& run;
  std::vector<Item> items;

  // Returns where the second half begins; the first half has whole leaves. Halves along the longest side of
  // the midpoints' box.
  std::size_t Halve(std::size_t begin, std::size_t end) {
    const std::size_t half = begin + ((end - begin + 1) / 2 + kLanes - 1) / kLanes * kLanes;
    if (run.Cancelled()) return half;
    Box3 box;
    for (std::size_t i = begin; i < end; ++i) box.Add(items[i].middle);
    int axis = 0;
    (box.max - box.min).maxCoeff(&axis);
    const auto at = [&](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(half), at(end), [axis](const Item& a, const Item& b) {
      return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis] : a.segment < b.segment;
    });
    return half;
  }
  const PathSegment& at(std::size_t i) const { return segments[static_cast<std::size_t>(items[i].segment)]; }
};

SegmentTree::SegmentTree(std::vector<PathSegment> segments, Metric metric, double longest,
                         const RunContext& run, double shank_radius)
    : metric_(metric), shank_radius_(shank_radius) {
  if (segments.empty()) return;
  if (!OverBox(metric)) segments = CutLong(std::move(segments), longest);
  Order order{segments, run, {}};
  order.items.reserve(segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i)
    order.items.push_back({segments[i].a + segments[i].b, static_cast<std::int32_t>(i)});
  leaves_.reserve(segments.size() / kLanes + 1);
  nodes_.reserve(leaves_.capacity() / 2 + 1);
  Build(order, 0, segments.size());
}

// Makes the node of all items in [begin, end).
std::int32_t SegmentTree::Build(Order& order, std::size_t begin, std::size_t end) {
  const auto self = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  // Two rounds of halving give up to four parts.
  std::array<std::size_t, kLanes + 1> cuts{begin, end};
  std::size_t parts = 1;
  for (int round = 0; round < 2; ++round) {
    std::array<std::size_t, kLanes + 1> finer{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < parts; ++k) {
      finer[count++] = cuts[k];
      if (cuts[k + 1] - cuts[k] > kLanes) finer[count++] = order.Halve(cuts[k], cuts[k + 1]);
    }
    finer[count] = end;
    cuts = finer;
    parts = count;
  }
  for (std::size_t k = 0; k < kLanes; ++k) {
    Box3 box;
    std::int32_t child = 0;
    if (k < parts) {
      const std::size_t first = cuts[k], last = cuts[k + 1];
      for (std::size_t i = first; i < last; ++i) {
        box.Add(order.at(i).a);
        box.Add(order.at(i).b);
      }
      if (last - first > kLanes) {
        child = Build(order, first, last);
      } else {
        Leaf leaf;
        leaf.count = static_cast<std::int32_t>(last - first);
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
          const PathSegment& s = order.at(lane < last - first ? first + lane : first);
          for (int axis = 0; axis < 3; ++axis) {
            leaf.a[axis][lane] = s.a[axis];
            leaf.b[axis][lane] = s.b[axis];
          }
          leaf.move[lane] = s.move;
        }
        leaves_.push_back(leaf);
        child = -static_cast<std::int32_t>(leaves_.size());
      }
    }
    Node& node = nodes_[static_cast<std::size_t>(self)];
    node.child[k] = child;
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis][k] = k < parts ? RoundDown(box.min[axis]) : kFar;
      node.high[axis][k] = k < parts ? RoundUp(box.max[axis]) : kFar;
    }
  }
  return self;
}

// A query in single precision. The possible rounding of the point and of the sums is added to the distance
// that counts as near.
struct SegmentTree::Query {
  Query(const Vec3& p, double shank_radius)
      : at{static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())},
        shank(static_cast<float>(shank_radius)),
        hidden(kUlps * (p.cwiseAbs().sum() + std::abs(shank_radius))) {}

  // A box may hold something nearer than `distance` if its squared distance is less than this.
  float Near2(double distance) const {
    const double wide = distance * (1.0 + kUlps) + hidden;
    return RoundUp(wide * wide * (1.0 + kUlps));
  }

  static constexpr double kUlps = 8.0 / (1 << 23);
  float at[3];
  float shank;
  double hidden;  // mm
};

// The squared distances of all children, one lane each.
SegmentTree::Floats SegmentTree::ChildDistances2(const Node& node, const Query& q) const {
  const auto above_zero = [](Floats x) { return x > 0.0F ? x : Floats{}; };
  const auto outside = [&](int axis) {
    const Floats below = node.low[axis] - q.at[axis], above = q.at[axis] - node.high[axis];
    return above_zero(below > above ? below : above);
  };
  const Floats dx = outside(0), dy = outside(1), plan = dx * dx + dy * dy;
  if (metric_ == Metric::kPath) {
    const Floats dz = outside(2);
    return plan + dz * dz;
  }
  // The swept sets have no upper end in z.
  const Floats rise = node.low[2] - q.at[2];
  if (metric_ == Metric::kSwept || metric_ == Metric::kSweptBox) {
    const Floats dz = above_zero(rise);
    return plan + dz * dz;
  }
  const Floats deep = above_zero(rise + q.shank), deep2 = deep * deep;
  return plan > deep2 ? plan : deep2;
}

double SegmentTree::Distance(int i, const Vec3& p) const {
  switch (metric_) {
    case Metric::kPath:
      return PathDistance(segment(i), p);
    case Metric::kSwept:
      return SweptDistance(segment(i), p);
    case Metric::kSweptBox:
      return SweptBoxDistance(segment(i), p);
    case Metric::kShank:
      return ShankDistance(segment(i), p, shank_radius_);
    case Metric::kShankBox:
      return ShankBoxDistance(segment(i), p, shank_radius_);
  }
  return 0.0;
}

MetricValue SegmentTree::DistanceAndGradient(int i, const Vec3& p) const {
  switch (metric_) {
    case Metric::kPath:
      return PathDistanceAndGradient(segment(i), p);
    case Metric::kSwept:
      return SweptDistanceAndGradient(segment(i), p);
    case Metric::kSweptBox:
      return SweptBoxDistanceAndGradient(segment(i), p);
    case Metric::kShank:
      return ShankDistanceAndGradient(segment(i), p, shank_radius_);
    case Metric::kShankBox:
      return ShankBoxDistanceAndGradient(segment(i), p, shank_radius_);
  }
  return {};
}

// Squared distances to the moves of a leaf, up to rounding.
void SegmentTree::Distances2(const Leaf& leaf, const Vec3& p, double (&distance2)[kLanes]) {
  const Doubles dx = leaf.b[0] - leaf.a[0], dy = leaf.b[1] - leaf.a[1], dz = leaf.b[2] - leaf.a[2];
  const Doubles x = p.x() - leaf.a[0], y = p.y() - leaf.a[1], z = p.z() - leaf.a[2];
  const Doubles along = x * dx + y * dy + z * dz, length2 = dx * dx + dy * dy + dz * dz;
  const Doubles one = Doubles{} + 1.0;
  Doubles t = along / (length2 > 0.0 ? length2 : one);
  t = t > 0.0 ? t : Doubles{};
  t = t < 1.0 ? t : one;
  const Doubles ox = x - t * dx, oy = y - t * dy, oz = z - t * dz;
  const Doubles sum = ox * ox + oy * oy + oz * oz;
  for (int k = 0; k < kLanes; ++k) distance2[k] = sum[k];
}

SegmentTree::Nearest SegmentTree::FindNearest(const Vec3& p, double limit, int hint, double slack) const {
  Nearest best{limit, -1};
  if (leaves_.empty()) return best;
  const Query q(p, OfShank(metric_) ? shank_radius_ : 0.0);
  const double keep = 1.0 - slack;
  float near2 = q.Near2(best.distance * keep);
  const auto consider = [&](int i) {
    const double d = Distance(i, p);
    if (!(d < best.distance)) return;
    best = {d, i};
    near2 = q.Near2(d * keep);
  };
  if (hint >= 0) consider(hint);
  const auto look = [&](std::int32_t index) {
    const Leaf& leaf = leaves_[static_cast<std::size_t>(index)];
    if (metric_ != Metric::kPath) {
      for (int k = 0; k < leaf.count; ++k) consider(kLanes * index + k);
      return;
    }
    // Only moves about as near as the nearest one are measured one by one.
    constexpr double kRounded = 1.0 + 1e-9;
    double of_move[kLanes];
    Distances2(leaf, p, of_move);
    const double enough = best.distance * best.distance * kRounded;
    if (!(of_move[0] <= enough || of_move[1] <= enough || of_move[2] <= enough || of_move[3] <= enough)) {
      return;
    }
    for (int k = 0; k < leaf.count; ++k) {
      if (of_move[k] <= best.distance * best.distance * kRounded) consider(kLanes * index + k);
    }
  };
  // The boxes to be opened and their distances are separate arrays: data written as two values and read as
  // one stalls the processor.
  constexpr std::size_t kStack = 128;
  float distance2[kStack];
  std::int32_t open[kStack];
  std::size_t size = 1;
  distance2[0] = 0.0F;
  open[0] = 0;
  while (size > 0) {
    --size;
    if (!(distance2[size] < near2)) continue;
    if (open[size] < 0) {
      look(-open[size] - 1);
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(open[size])];
    const Floats of_child = ChildDistances2(node, q);
    PM_CHECK(size + kLanes <= kStack);
    // No branch for each child, because no processor could predict it. The nearest child comes on top.
    const std::size_t first = size;
    std::size_t nearest = size;
    for (std::size_t k = 0; k < kLanes; ++k) {
      distance2[size] = of_child[k];
      open[size] = node.child[k];
      nearest = of_child[k] < distance2[nearest] ? size : nearest;
      size += of_child[k] < near2 ? 1 : 0;
    }
    if (size > first) {
      std::swap(distance2[nearest], distance2[size - 1]);
      std::swap(open[nearest], open[size - 1]);
    }
  }
  return best;
}

void SegmentTree::FindWithin(const Vec3& p, double limit, std::vector<int>& found) const {
  found.clear();
  if (leaves_.empty() || !(limit > 0.0)) return;
  const Query q(p, OfShank(metric_) ? shank_radius_ : 0.0);
  const float near2 = q.Near2(limit);
  std::array<std::int32_t, 128> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[static_cast<std::size_t>(stack[--size])];
    const Floats distance2 = ChildDistances2(node, q);
    for (std::size_t k = 0; k < kLanes; ++k) {
      if (!(distance2[k] < near2)) continue;
      if (node.child[k] >= 0) {
        PM_CHECK(size < stack.size());
        stack[size++] = node.child[k];
        continue;
      }
      const std::int32_t index = -node.child[k] - 1;
      for (int lane = 0; lane < leaves_[static_cast<std::size_t>(index)].count; ++lane) {
        const int i = kLanes * index + lane;
        if (Distance(i, p) < limit) found.push_back(i);
      }
    }
  }
}

}  // namespace patchmill
