// A tree over straight moves: which one is nearest to a point, which ones are near. What measures leftover
// and gouges, in the planner and in the verifier.
#pragma once

#include <cstdint>
#include <vector>

#include "cam/toolpath/segment_metric.h"
#include "core/base/run_context.h"

namespace patchmill {

// Four moves a leaf, side by side in vector lanes, and up to four children a node. Immutable, thread-safe.
class SegmentTree {
 public:
  // Long segments are cut, so that their boxes are slim: no longer than `longest` mm, or more when that would
  // make more than about two million of them; those of Metric::kSweptBox and kShankBox, which are boxes, are
  // not. `shank_radius` only for Metric::kShank and kShankBox. A cancelled run leaves a tree that is right
  // but slow. About 0.2 us and 90 bytes a segment.
  SegmentTree(std::vector<PathSegment> segments, Metric metric, double longest, const RunContext& run,
              double shank_radius = 0.0);

  struct Nearest {
    double distance = kInfinity;  // of the metric
    int segment = -1;             // -1: nothing nearer than the limit
  };
  // The smallest metric value at p, if below `limit`. `hint`: a segment that is probably near, or -1.
  // `slack` in [0,1): the answer may be too large by that fraction.
  Nearest FindNearest(const Vec3& p, double limit, int hint = -1, double slack = 0.0) const;
  // Indices of all segments with metric value < `limit` at p, in tree order. Replaces `found`.
  void FindWithin(const Vec3& p, double limit, std::vector<int>& found) const;

  bool empty() const { return leaves_.empty(); }
  PathSegment segment(int i) const {
    const Leaf& leaf = leaves_[static_cast<std::size_t>(i / kLanes)];
    const int k = i % kLanes;
    return {
        {leaf.a[0][k], leaf.a[1][k], leaf.a[2][k]}, {leaf.b[0][k], leaf.b[1][k], leaf.b[2][k]}, leaf.move[k]};
  }
  double Distance(int i, const Vec3& p) const;
  MetricValue DistanceAndGradient(int i, const Vec3& p) const;

 private:
  static constexpr int kLanes = 4;
  using Doubles = double __attribute__((vector_size(8 * kLanes)));
  using Floats = float __attribute__((vector_size(4 * kLanes)));
  struct Leaf {
    Doubles a[3], b[3];  // by axis; lanes past `count` repeat the first
    std::int32_t move[kLanes];
    std::int32_t count;
  };
  static void Distances2(const Leaf& leaf, const Vec3& p, double (&distance2)[kLanes]);
  struct Node {
    Floats low[3], high[3];  // by axis, of the children, rounded outward; children that are not there are far
    // >= 0: inner node. < 0: the leaf -child - 1.
    std::int32_t child[kLanes];
  };
  struct Order;  // of the segments while the tree is built
  std::int32_t Build(Order& order, std::size_t begin, std::size_t end);
  struct Query;  // a point as the boxes see it
  Floats ChildDistances2(const Node& node, const Query& q) const;

  Metric metric_;
  double shank_radius_ = 0.0;
  std::vector<Leaf> leaves_;
  std::vector<Node> nodes_;  // the first is the root
};

}  // namespace patchmill
