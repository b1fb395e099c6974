#include "cam/path/path_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cam/path/chord_bounds.h"

namespace patchmill {
namespace {

constexpr int kGroup = 8;

Eigen::Vector3f RoundedDown(const Vec3& p) {
  return p.unaryExpr([](double x) { return std::nextafterf(static_cast<float>(x), -HUGE_VALF); })
      .cast<float>();
}
Eigen::Vector3f RoundedUp(const Vec3& p) {
  return p.unaryExpr([](double x) { return std::nextafterf(static_cast<float>(x), HUGE_VALF); })
      .cast<float>();
}

}  // namespace

PathTree::PathTree(const std::vector<CutterPath>& paths) {
  std::vector<Group> groups;
  for (const CutterPath& path : paths) {
    const std::size_t n = path.points.size();
    if (n == 0) continue;
    const std::size_t moves = n == 1 ? 1 : n - 1 + (path.closed ? 1 : 0);
    for (std::size_t i = 0; i < moves; ++i) {
      if (i % kGroup == 0) groups.push_back({{}, {}, static_cast<std::int32_t>(segments_.size()), 0});
      segments_.push_back({path.points[i].center, path.points[(i + 1) % n].center});
      ++groups.back().count;
    }
  }
  for (Group& g : groups) {
    Box3 box;
    for (std::int32_t i = g.begin; i < g.begin + g.count; ++i) {
      box.Add(segment(i).a);
      box.Add(segment(i).b);
    }
    g.min = RoundedDown(box.min);
    g.max = RoundedUp(box.max);
  }
  nodes_.reserve(2 * groups.size());
  if (!groups.empty()) Build(groups, 0, groups.size());
}

std::int32_t PathTree::Build(std::vector<Group>& groups, std::size_t first, std::size_t last) {
  const auto self = static_cast<std::int32_t>(nodes_.size());
  nodes_.push_back({groups[first].min, groups[first].max, -1, groups[first].begin, groups[first].count});
  Eigen::Vector3f min = groups[first].min, max = groups[first].max;
  for (std::size_t i = first + 1; i < last; ++i) {
    min = min.cwiseMin(groups[i].min);
    max = max.cwiseMax(groups[i].max);
  }
  nodes_[static_cast<std::size_t>(self)].min = min;
  nodes_[static_cast<std::size_t>(self)].max = max;
  if (last - first == 1) return self;
  int axis = 0;
  (max - min).maxCoeff(&axis);
  const std::size_t mid = (first + last) / 2;
  const auto at = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
  std::nth_element(groups.begin() + at(first), groups.begin() + at(mid), groups.begin() + at(last),
                   [axis](const Group& a, const Group& b) {
                     const float ka = a.min[axis] + a.max[axis], kb = b.min[axis] + b.max[axis];
                     return ka != kb ? ka < kb : a.begin < b.begin;
                   });
  Build(groups, first, mid);
  const std::int32_t right = Build(groups, mid, last);
  nodes_[static_cast<std::size_t>(self)].right = right;
  return self;
}

std::optional<PathTree::Nearest> PathTree::Find(const Vec3& p, double limit, std::int32_t hint) const {
  if (nodes_.empty()) return std::nullopt;
  Nearest best{limit, -1};
  const auto consider = [&](std::int32_t i) {
    const double d = SegmentDistance(p, segment(i).a, segment(i).b);
    if (d < best.distance) best = {d, i};
  };
  if (hint >= 0) consider(hint);
  const auto bound = [&](const Node& n) {
    const Vec3 lo = n.min.cast<double>() - p, hi = p - n.max.cast<double>();
    return lo.cwiseMax(hi).cwiseMax(0.0).squaredNorm();
  };
  struct Pending {
    std::int32_t node;
    double bound;
  };
  std::array<Pending, 128> stack;
  std::size_t top = 0;
  stack[top++] = {0, bound(nodes_[0])};
  while (top > 0) {
    const Pending next = stack[--top];
    if (next.bound >= best.distance * best.distance) continue;
    const Node& n = nodes_[static_cast<std::size_t>(next.node)];
    if (n.right < 0) {
      for (std::int32_t i = n.begin; i < n.begin + n.count; ++i) consider(i);
      continue;
    }
    const Pending left{next.node + 1, bound(nodes_[static_cast<std::size_t>(next.node) + 1])};
    const Pending right{n.right, bound(nodes_[static_cast<std::size_t>(n.right)])};
    stack[top++] = left.bound < right.bound ? right : left;
    stack[top++] = left.bound < right.bound ? left : right;
  }
  if (best.segment < 0) return std::nullopt;
  return best;
}

}  // namespace patchmill
