// Nearest segment of many passes: what measures leftover while planning.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cam/toolpath/cutter_path.h"

namespace patchmill {

// A tree of boxes over the straight moves of passes; immutable, thread-safe. Build O(n log n) in groups of
// eight consecutive moves, which lie together already.
class PathTree {
 public:
  struct Segment {
    Vec3 a, b;
  };
  struct Nearest {
    double distance;
    std::int32_t segment;
  };

  explicit PathTree(const std::vector<CutterPath>& paths);

  // The nearest segment closer than `limit` to p (mm), if any. `hint`: a segment likely to be near, only for
  // speed.
  std::optional<Nearest> Find(const Vec3& p, double limit, std::int32_t hint = -1) const;
  const Segment& segment(std::int32_t i) const { return segments_[static_cast<std::size_t>(i)]; }

 private:
  struct Node {
    Eigen::Vector3f min, max;
    std::int32_t right;         // inner: right child, the left one is next; leaf: -1
    std::int32_t begin, count;  // leaf: segments
  };
  struct Group {
    Eigen::Vector3f min, max;
    std::int32_t begin, count;
  };
  std::int32_t Build(std::vector<Group>& groups, std::size_t first, std::size_t last);

  std::vector<Segment> segments_;
  std::vector<Node> nodes_;
};

}  // namespace patchmill
