// Queries about a move: the highest centre over the rectangle between its ends, and the gouge of the swept
// ball. Both are maxima over the surface, found by best-first branch and bound over tree nodes, leaves and
// halves of leaves. If only a limit of the gouge matters, the models of the leaves prove most of it first.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cam/location/locator_impl.h"
#include "cam/location/swept_ball.h"
#include "cam/location/swept_leaves.h"
#include "core/base/polled_run.h"

namespace patchmill {
namespace {

using internal::Rect;
using internal::SweptBall;

constexpr int kBudget = 200000;  // parts visited; then the bound reached so far is returned
// After so many parts the search asks whether its result is still wanted. If not, its budget is used up.
constexpr int kPartsBetweenPolls = 64;

// A node of the tree, or a part of a leaf with its own net.
struct Part {
  double bound;
  std::int32_t node = -1;
  std::int32_t piece = -1;
  Rect rect;
  std::size_t net = 0;  // index of its first point in the arena
};

struct Halves {
  Rect low_rect, high_rect;
  std::array<Vec4, kMaxNetPoints> low, high;
};

// Halves across the longer side.
void Halve(NetShape shape, const Vec4* points, const Rect& r, Halves& out) {
  const int last_u = shape.degree_u * (shape.degree_v + 1), last_v = shape.degree_v;
  const auto side = [&](int from, int to) {  // corners without weight are left out
    const Vec4 &p = points[from], &q = points[to];
    if (!(p.w() > 0.0 && q.w() > 0.0)) return 0.0;
    return Vec3(q.head<3>() / q.w() - p.head<3>() / p.w()).norm();
  };
  const double side_u = side(0, last_u) + side(last_v, last_u + last_v);
  const double side_v = side(0, last_v) + side(last_u, last_u + last_v);
  const bool along_u = side_u >= side_v;
  const double mu = 0.5 * (r.u0 + r.u1), mv = 0.5 * (r.v0 + r.v1);
  HalveNet(shape, points, along_u, out.low.data(), out.high.data());
  out.low_rect = out.high_rect = r;
  (along_u ? out.low_rect.u1 : out.low_rect.v1) = along_u ? mu : mv;
  (along_u ? out.high_rect.u0 : out.high_rect.v0) = along_u ? mu : mv;
}

struct LeafSet {
  const internal::SearchTree& tree;
  const std::vector<std::int32_t>& leaves;
};

// Accuracy of a search for a largest value. Values below `lower` do not matter, the result may miss the
// largest value by `gap`, and the search ends at the first value above `enough`.
struct Sought {
  double lower, gap, enough;
};

// Finds the largest value of a quantity over the surface. It lies between `lower` (attained, or all that
// matters) and the returned upper bound, which is at most lower + gap unless the budget is used up. Stops as
// soon as more than `enough` is attained.
//   quantity.Over(box): upper bound of the quantity over a box; quantity.Over(center, axis, half): the same
//   over an oriented box as in RectBounds; quantity.At(p): its value at a surface point.
// If `among` is not null, its leaves of a search tree are searched in place of the whole surface.
template <class Quantity>
double Maximize(const Surface& surface, const LeafSet* among, const Sought& sought,
                const Quantity& quantity) {
  double lower = sought.lower;
  const double gap = sought.gap, enough = sought.enough;
  thread_local std::vector<Part> heap;
  thread_local std::vector<Vec4> arena;
  thread_local Halves halves;
  heap.clear();
  arena.clear();
  const auto worse = [](const Part& a, const Part& b) { return a.bound < b.bound; };
  const auto push = [&](const Part& part) {
    if (!(part.bound > lower)) return;
    heap.push_back(part);
    std::push_heap(heap.begin(), heap.end(), worse);
  };
  const auto push_node = [&](std::int32_t index) {
    const SurfaceNode& node = surface.nodes[static_cast<std::size_t>(index)];
    Part part{quantity.Over(node.box), index, -1, {}, 0};
    if (node.leaf >= 0 && part.bound > lower) {
      const SurfaceLeaf& leaf = surface.leaves[static_cast<std::size_t>(node.leaf)];
      part.bound = std::min(part.bound, quantity.Over(leaf.center(), leaf.axis(), leaf.half()));
    }
    push(part);
  };
  const auto push_rect = [&](const Piece& piece, const Part& parent, const Rect& rect, const Vec4* points) {
    const NetShape shape{piece.net.degree_u, piece.net.degree_v};
    std::array<Vec3, kMaxNetPoints> hull;
    const RectBounds b = BoundPoints(shape, points, hull.data(), HullPoints(shape, points, hull.data()));
    const double bound =
        std::min({parent.bound, quantity.Over(b.box), quantity.Over(b.center, b.axis, b.half)});
    if (!(bound > lower)) return;
    lower =
        std::max(lower, quantity.At(Position(piece, 0.5 * (rect.u0 + rect.u1), 0.5 * (rect.v0 + rect.v1))));
    const Part part{bound, -1, parent.piece, rect, arena.size()};
    arena.insert(arena.end(), points, points + shape.count());
    push(part);
  };

  if (among == nullptr) {
    push_node(0);
  } else {
    for (const std::int32_t index : among->leaves) {
      const internal::SearchLeaf& leaf = among->tree.leaves[index];
      const Piece& piece = surface.pieces[static_cast<std::size_t>(leaf.piece())];
      const Rect r = leaf.rect();
      std::array<Vec4, kMaxNetPoints> points;
      std::copy(piece.net.points.begin(), piece.net.points.end(), points.begin());
      const NetShape shape{piece.net.degree_u, piece.net.degree_v};
      RestrictNet(shape, points.data(), r);
      push_rect(piece, {.bound = kInfinity, .piece = leaf.piece(), .rect = r}, r, points.data());
    }
  }
  for (int budget = kBudget; !heap.empty(); --budget) {
    if (budget % kPartsBetweenPolls == 0 && ThisThreadCancelled()) budget = 0;
    std::pop_heap(heap.begin(), heap.end(), worse);
    Part top = heap.back();
    heap.pop_back();
    if (top.bound <= lower + gap || budget <= 0 || lower > enough) return std::max(top.bound, lower);
    std::array<Vec4, kMaxNetPoints> points;
    if (top.node >= 0) {
      const SurfaceNode& node = surface.nodes[static_cast<std::size_t>(top.node)];
      if (node.leaf < 0) {
        push_node(top.node + 1);
        push_node(node.right);
        continue;
      }
      const SurfaceLeaf& leaf = surface.leaves[static_cast<std::size_t>(node.leaf)];
      const Piece& piece = surface.piece(leaf.piece);
      top.piece = leaf.piece.value;
      top.rect = {leaf.u0, leaf.u1, leaf.v0, leaf.v1};
      const Rect& r = top.rect;
      lower = std::max(lower, quantity.At(Position(piece, 0.5 * (r.u0 + r.u1), 0.5 * (r.v0 + r.v1))));
      if (top.bound <= lower + gap) return top.bound;
      std::copy(piece.net.points.begin(), piece.net.points.end(), points.begin());
      RestrictNet({piece.net.degree_u, piece.net.degree_v}, points.data(), r);
    } else {
      const auto& net = surface.pieces[static_cast<std::size_t>(top.piece)].net;
      std::copy_n(arena.begin() + static_cast<std::ptrdiff_t>(top.net), net.points.size(), points.begin());
    }
    const Piece& piece = surface.pieces[static_cast<std::size_t>(top.piece)];
    Halve({piece.net.degree_u, piece.net.degree_v}, points.data(), top.rect, halves);
    push_rect(piece, top, halves.low_rect, halves.low.data());
    push_rect(piece, top, halves.high_rect, halves.high.data());
  }
  return lower;
}

// The height of the centre of a ball over a rectangle in plan, widened by `half_width`, that touches a point.
struct HeightOverRect {
  Vec2 min, max;
  double half_width, radius2;

  // Distance in plan from another rectangle.
  double Off(const Vec2& low, const Vec2& high) const {
    return (low - max).cwiseMax(min - high).cwiseMax(0.0).norm();
  }
  double Height(double z, double distance) const {
    const double d = std::max(0.0, distance - half_width);
    return d * d <= radius2 ? z + std::sqrt(radius2 - d * d) : -kInfinity;
  }
  double Over(const Box3& x) const { return Height(x.max.z(), Off(Xy(x.min), Xy(x.max))); }
  double Over(const Vec3&, const Eigen::Matrix3d&, const Vec3&) const { return kInfinity; }
  double At(const Vec3& p) const { return Height(p.z(), Off(Xy(p), Xy(p))); }
};

// Quantity for Maximize: the depth (mm) of a surface point in a swept ball.
struct SweptDepth {
  double radius;
  SweptBall swept;

  double Over(const Box3& x) const {
    return radius - swept.DistanceBelow(x.Center(), Eigen::Matrix3d::Identity(), 0.5 * (x.max - x.min));
  }
  double Over(const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half) const {
    return radius - swept.DistanceBelow(center, axis, half);
  }
  double At(const Vec3& p) const { return radius - swept.Distance(p); }
};

}  // namespace

double Locator::MaxHeight(const Vec2& a, const Vec2& b, double half_width, double slack) const {
  const HeightOverRect height{a.cwiseMin(b), a.cwiseMax(b), half_width, impl_->radius * impl_->radius};
  const Sought sought{-kInfinity, std::max(slack, 1e-9), kInfinity};
  return Maximize(impl_->surface, nullptr, sought, height) + impl_->slack;
}

double Locator::SweptGouge(const Vec3& a, const Vec3& b, double eps) const {
  const SweptDepth depth{impl_->radius, SweptBall(a, b)};
  return Maximize(impl_->surface, nullptr, {0.0, std::max(eps, 1e-9), kInfinity}, depth);
}

bool Locator::GougeWithin(const Vec3& a, const Vec3& b, double limit, double eps) const {
  const double radius = impl_->radius;
  if (limit >= radius) return true;  // no distance is below zero
  thread_local std::vector<std::int32_t> open;
  open.clear();
  // A chord of two free centres is at most as deep as [location T2] says. So a margin of a 64th of the limit
  // loses little.
  const double spare = std::max({limit, eps, 1e-4 * radius}) / 64.0;
  if (!internal::CollectSweptLeaves(*impl_, {a, b, radius - limit + impl_->slack, spare}, open)) return false;
  if (open.empty()) return true;
  const double gap = std::max(eps, 1e-9);
  const LeafSet among{impl_->tree, open};
  const SweptDepth depth{radius, SweptBall(a, b)};
  return Maximize(impl_->surface, &among, {limit - gap, gap, limit}, depth) <= limit;
}

}  // namespace patchmill
