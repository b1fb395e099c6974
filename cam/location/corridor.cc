// Questions about a straight move: the highest centre over a stadium, and the gouge of the swept ball. Both
// are maxima over the surface, found by best-first branch and bound: tree nodes, leaves, then halves of
// leaves.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cam/location/locator_impl.h"
#include "cam/location/swept_ball.h"

namespace patchmill {
namespace {

using internal::Rect;
using internal::SweptBall;

constexpr int kBudget = 200000;  // parts looked at; then the bound reached so far is returned

// A node of the tree, or a part of a leaf with its own net.
struct Part {
  double bound;
  std::int32_t node = -1;
  std::int32_t piece = -1;
  Rect rect;
  std::size_t net = 0;  // first point in the arena
};

// The largest of a quantity over the surface, between `lower` (attained) and the returned upper bound, which
// is at most lower + gap unless the budget runs out.
//   box(b), oriented(b): upper bounds of the quantity over a box; at(p): its value at a surface point.
template <class BoxBound, class OrientedBound, class Value>
double Maximize(const Surface& surface, double lower, double gap, const BoxBound& box,
                const OrientedBound& oriented, const Value& at) {
  thread_local std::vector<Part> heap;
  thread_local std::vector<Vec4> arena;
  heap.clear();
  arena.clear();
  const auto worse = [](const Part& a, const Part& b) { return a.bound < b.bound; };
  const auto push = [&](const Part& part) {
    if (!(part.bound > lower)) return;
    heap.push_back(part);
    std::push_heap(heap.begin(), heap.end(), worse);
  };
  const auto push_rect = [&](const Piece& piece, std::int32_t piece_index, const Rect& rect,
                             const Vec4* points, double parent_bound) {
    const NetShape shape{piece.net.degree_u, piece.net.degree_v};
    std::array<Vec3, kMaxNetPoints> hull;
    const RectBounds bounds = BoundPoints(shape, points, hull.data(), HullPoints(shape, points, hull.data()));
    lower = std::max(lower, at(Position(piece, 0.5 * (rect.u0 + rect.u1), 0.5 * (rect.v0 + rect.v1))));
    Part part{std::min({parent_bound, box(bounds.box), oriented(bounds)}), -1, piece_index, rect,
              arena.size()};
    if (!(part.bound > lower)) return;
    arena.insert(arena.end(), points, points + shape.count());
    push(part);
  };

  push({box(surface.nodes[0].box), 0, -1, {}, 0});
  for (int budget = kBudget; !heap.empty(); --budget) {
    std::pop_heap(heap.begin(), heap.end(), worse);
    const Part top = heap.back();
    heap.pop_back();
    if (top.bound <= lower + gap || budget <= 0) return std::max(top.bound, lower);
    if (top.node >= 0) {
      const SurfaceNode& node = surface.nodes[static_cast<std::size_t>(top.node)];
      if (node.leaf < 0) {
        for (const std::int32_t child : {top.node + 1, node.right}) {
          push({box(surface.nodes[static_cast<std::size_t>(child)].box), child, -1, {}, 0});
        }
        continue;
      }
      const SurfaceLeaf& leaf = surface.leaves[static_cast<std::size_t>(node.leaf)];
      const Piece& piece = surface.piece(leaf.piece);
      std::array<Vec4, kMaxNetPoints> points;
      std::copy(piece.net.points.begin(), piece.net.points.end(), points.begin());
      const Rect rect{leaf.u0, leaf.u1, leaf.v0, leaf.v1};
      RestrictNet({piece.net.degree_u, piece.net.degree_v}, points.data(), rect.u0, rect.u1, rect.v0,
                  rect.v1);
      push_rect(piece, leaf.piece.value, rect, points.data(), top.bound);
      continue;
    }
    const Piece& piece = surface.pieces[static_cast<std::size_t>(top.piece)];
    const NetShape shape{piece.net.degree_u, piece.net.degree_v};
    std::array<Vec4, kMaxNetPoints> points, low, high;
    std::copy_n(arena.begin() + static_cast<std::ptrdiff_t>(top.net), shape.count(), points.begin());
    // Across the longer side.
    const int last_u = shape.degree_u * (shape.degree_v + 1), last_v = shape.degree_v;
    const auto point = [&](int k) {
      const Vec4& x = points[static_cast<std::size_t>(k)];
      return Vec3(x.w() > 0.0 ? Vec3(x.head<3>() / x.w()) : Vec3::Zero());
    };
    const Rect& r = top.rect;
    const double mu = 0.5 * (r.u0 + r.u1), mv = 0.5 * (r.v0 + r.v1);
    const double side_u = (point(last_u) - point(0)).norm() + (point(last_u + last_v) - point(last_v)).norm();
    const double side_v = (point(last_v) - point(0)).norm() + (point(last_u + last_v) - point(last_u)).norm();
    const bool along_u = side_u >= side_v;
    HalveNet(shape, points.data(), along_u, low.data(), high.data());
    Rect first = r, second = r;
    (along_u ? first.u1 : first.v1) = along_u ? mu : mv;
    (along_u ? second.u0 : second.v0) = along_u ? mu : mv;
    push_rect(piece, top.piece, first, low.data(), top.bound);
    push_rect(piece, top.piece, second, high.data(), top.bound);
  }
  return lower;
}

}  // namespace

double Locator::MaxHeight(const Vec2& a, const Vec2& b, double half_width, double slack) const {
  const double r2 = impl_->radius * impl_->radius;
  const auto height = [&](double z, double distance) {
    const double d = std::max(0.0, distance - half_width);
    return d * d <= r2 ? z + std::sqrt(r2 - d * d) : -kInfinity;
  };
  const auto box = [&](const Box3& x) { return height(x.max.z(), internal::PlanDistance(x, a, b)); };
  const auto oriented = [](const RectBounds&) { return kInfinity; };
  const auto at = [&](const Vec3& p) { return height(p.z(), internal::PlanDistance(Plan(p), a, b)); };
  return Maximize(impl_->surface, -kInfinity, std::max(slack, 1e-9), box, oriented, at) + impl_->slack;
}

double Locator::SweptGouge(const Vec3& a, const Vec3& b, double eps) const {
  const SweptBall swept(a, b);
  const double radius = impl_->radius;
  const auto box = [&](const Box3& x) {
    return radius - swept.DistanceBelow(x.Center(), Eigen::Matrix3d::Identity(), 0.5 * (x.max - x.min));
  };
  const auto oriented = [&](const RectBounds& x) {
    return radius - swept.DistanceBelow(x.center, x.axis, x.half);
  };
  const auto at = [&](const Vec3& p) { return radius - swept.Distance(p); };
  return Maximize(impl_->surface, 0.0, std::max(eps, 1e-9), box, oriented, at);
}

}  // namespace patchmill
