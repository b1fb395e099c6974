#include "core/spatial/box_tree.h"

#include <algorithm>
#include <numeric>

namespace patchmill {
namespace {
constexpr int kLeafCount = 4;
}

BoxTree::BoxTree(std::vector<Box3> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (!boxes_.empty()) Build(0, static_cast<int>(boxes_.size()));
}

void BoxTree::Build(int first, int count) {
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  Box3 box, centers;
  for (int k = first; k < first + count; ++k) {
    const Box3& b = boxes_[static_cast<std::size_t>(order_[static_cast<std::size_t>(k)])];
    box.Add(b);
    centers.Add(b.Center());
  }
  nodes_[self].box = box;
  if (count <= kLeafCount) {
    nodes_[self].first = first;
    nodes_[self].count = count;
    return;
  }
  int axis = 0;
  (centers.max - centers.min).maxCoeff(&axis);
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count, [&](int a, int b) {
    const double ca = boxes_[static_cast<std::size_t>(a)].Center()[axis];
    const double cb = boxes_[static_cast<std::size_t>(b)].Center()[axis];
    return ca != cb ? ca < cb : a < b;
  });
  Build(first, count / 2);
  nodes_[self].right = static_cast<int>(nodes_.size());
  Build(first + count / 2, count - count / 2);
}

}  // namespace patchmill
