// A tree over straight moves. It finds the move nearest to a point and all moves near it. Planner and
// verifier measure leftover and gouges with it.
#pragma once

#include <cstdint>
#include <vector>

#include "cam/toolpath/segment_metric.h"
#include "core/base/run_context.h"

namespace patchmill {

// Each leaf holds four moves side by side in vector lanes; each node has up to four children. Immutable,
// thread-safe.
class SegmentTree {
 public:
  // Long segments are cut to at most `longest` mm, so that their boxes are slim. The length is larger if more
  // than about two million parts would result. Segments of Metric::kSweptBox and kShankBox are boxes and are
  // not cut. `shank_radius` is used for Metric::kShank and kShankBox only. A cancelled run leaves a tree that
  // is correct but slow. Cost: about 0.2 us and 90 bytes per segment.
  SegmentTree(std::vector<PathSegment> segments, Metric metric, double longest, const RunContext& run,
              double shank_radius = 0.0);

  struct Nearest {
    double distance = kInfinity;  // value of the metric
    int segment = -1;             // -1: nothing is nearer than the limit
  };
  // The smallest value of the metric at p, if it is below `limit`. `hint` is a segment that is probably near,
  // or -1. With `slack` in [0,1) the answer may be too large by that fraction.
  Nearest FindNearest(const Vec3& p, double limit, int hint = -1, double slack = 0.0) const;
  // Finds the indices of all segments with a value < `limit` at p, in tree order. Replaces `found`.
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
    Doubles a[3], b[3];  // by axis; lanes from `count` on repeat the first move
    std::int32_t move[kLanes];
    std::int32_t count;
  };
  static void Distances2(const Leaf& leaf, const Vec3& p, double (&distance2)[kLanes]);
  struct Node {
    Floats low[3], high[3];  // by axis; boxes of the children, rounded outward; missing children are far away
    // >= 0: inner node. < 0: the leaf -child - 1.
    std::int32_t child[kLanes];
  };
  struct Order;  // the segments while the tree is built
  std::int32_t Build(Order& order, std::size_t begin, std::size_t end);
  struct Query;  // a point in single precision
  Floats ChildDistances2(const Node& node, const Query& q) const;

  Metric metric_;
  double shank_radius_ = 0.0;
  std::vector<Leaf> leaves_;
  std::vector<Node> nodes_;  // nodes_[0] is the root
};

}  // namespace patchmill
