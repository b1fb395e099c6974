// A balanced tree of boxes that finds the boxes around a point.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

class BoxTree {
 public:
  // Splits at the median centre; equal centres are ordered by index. So the tree does not depend on how the
  // library selects. Cost O(n log n).
  explicit BoxTree(std::vector<Box3> boxes);

  // Calls visit(i) for every box within `reach` (by coordinates) of `p`, until it returns false.
  template <class Visit>
  void Near(const Vec3& p, double reach, Visit&& visit) const {
    int stack[64];
    int top = 0;
    if (!nodes_.empty()) stack[top++] = 0;
    while (top > 0) {
      const Node& node = nodes_[static_cast<std::size_t>(stack[--top])];
      if (!Holds(node.box, p, reach)) continue;
      if (node.count == 0) {
        stack[top++] = node.right;
        stack[top++] = static_cast<int>(&node - nodes_.data()) + 1;
        continue;
      }
      for (int k = node.first; k < node.first + node.count; ++k) {
        const int i = order_[static_cast<std::size_t>(k)];
        if (Holds(boxes_[static_cast<std::size_t>(i)], p, reach) && !visit(i)) return;
      }
    }
  }

 private:
  struct Node {
    Box3 box;
    int right = 0;  // inner: right child; the left one is the next node
    int first = 0, count = 0;
  };
  static bool Holds(const Box3& box, const Vec3& p, double reach) {
    return ((box.min - p).array() <= reach).all() && ((p - box.max).array() <= reach).all();
  }
  void Build(int first, int count);

  std::vector<Box3> boxes_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace patchmill
