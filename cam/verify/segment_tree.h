// A tree over the moves of a program: which one is nearest to a point, which ones are near.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cam/verify/segment_metric.h"
#include "core/base/run_context.h"

namespace patchmill {

class SegmentTree {
 public:
  // Long segments are cut, so that their boxes are slim: no longer than `longest` mm, or more when that would
  // make more than about two million of them. `shank_radius` only for Metric::kShank. A cancelled run leaves
  // a tree that is right but slow. About 1 us and 100 bytes a segment.
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

  bool empty() const { return segments_.empty(); }
  const PathSegment& segment(int i) const { return segments_[static_cast<std::size_t>(i)]; }
  double Distance(int i, const Vec3& p) const;
  MetricValue DistanceAndGradient(int i, const Vec3& p) const;

 private:
  struct Box {
    float low[3], high[3];  // rounded outward
  };
  struct Node {
    float low[3][2], high[3][2];  // by axis, of both children
    // >= 0: inner node. < 0: leaf of the segments [-child - 1, -child - 1 + count).
    std::int32_t child[2] = {0, 0};
    std::int32_t count[2] = {0, 0};
  };
  struct Range {
    std::int32_t child, count;
    Box box;
  };
  Range Build(std::vector<std::int32_t>& order, std::size_t begin, std::size_t end, int depth,
              const RunContext& run);
  Box BoxOf(const std::vector<std::int32_t>& order, std::size_t begin, std::size_t end) const;
  void SetChild(std::int32_t node, int side, const Range& range);
  // Squares of lower bounds of the metric over both children of a node.
  using Pair = double __attribute__((vector_size(16)));
  Pair ChildDistances2(const Node& node, const Vec3& p) const;

  Metric metric_;
  double shank_radius_ = 0.0;
  std::vector<PathSegment> segments_;
  std::vector<Node> nodes_;
};

}  // namespace patchmill
