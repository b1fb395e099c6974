#include "cam/location/swept_leaves.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "cam/location/ray_distance.h"
#include "cam/location/swept_ball.h"
#include "cam/location/tree_walk.h"

namespace patchmill::internal {
namespace {

Float4 Abs(Float4 a) { return Max(a, -a); }

constexpr int kNewtonSteps = 4;

// One leaf against one move.
class LeafProof {
 public:
  LeafProof(const SearchLeaf& leaf, const LeafGrid& grid, const LeafBox& box, const Piece& piece,
            const SweptMove& move)
      : leaf_(leaf),
        box_(box),
        grid_(grid),
        piece_(piece),
        a_(move.a),
        b_(move.b),
        length_((move.b - move.a).norm()),
        distance2_(move.distance * move.distance),
        spare2_(2.0 * move.distance * move.spare) {}

  // The costly bounds are used only if [location T2a] cannot decide with the cheaper bounds of both ends.
  bool Out() {
    double d0 = BoxDistance2(a_), d1 = BoxDistance2(b_);
    if (ChordDistance2(d0, d1, length_) >= distance2_) return true;
    model_ = leaf_.Model(grid_);
    const LowerModel low0 = BoundBelow(*model_, a_), low1 = BoundBelow(*model_, b_);
    d0 = std::max(d0, 2.0 * LeastOn(*model_, low0, a_));
    d1 = std::max(d1, 2.0 * LeastOn(*model_, low1, b_));
    if (ChordDistance2(d0, d1, length_) >= distance2_) return true;
    const double enough = Enough(length_);
    d0 = NearDistance2(a_, low0, enough, d0);
    return d0 >= distance2_ && Out(0.0, d0, 1.0, NearDistance2(b_, low1, enough, d1));
  }
  bool met() const { return met_; }  // true if a point of the leaf is nearer than `distance`

 private:
  // With this squared distance from both ends, [location T2a] proves an interval.
  double Enough(double length) const { return distance2_ + 0.25 * length * length; }

  bool Out(double t0, double d0, double t1, double d1) {
    if (d0 < distance2_ || d1 < distance2_) return false;
    const double length = (t1 - t0) * length_;
    if (ChordDistance2(d0, d1, length) >= distance2_) return true;
    if (0.25 * length * length < spare2_) return false;
    const double t = 0.5 * (t0 + t1), d = Distance2(a_ + t * (b_ - a_), Enough(0.5 * length));
    return Out(t0, d0, t, d) && Out(t, d, t1, d1);
  }

  // A lower bound of the squared distance from the leaf to the centre c with everything above it.
  double BoxDistance2(const Vec3& c) const {
    return OrientedBoxDistance2(box_.center, box_.axis, box_.half, c);
  }
  double Distance2(const Vec3& c, double enough) {
    const double box2 = BoxDistance2(c);
    if (box2 >= enough) return box2;
    const LowerModel low = BoundBelow(*model_, c);
    return NearDistance2(c, low, enough, std::max(box2, 2.0 * LeastOn(*model_, low, c)));
  }

  // Bounds from places near the minimum. If f is convex on the leaf, its tangent plane is a lower bound, too,
  // and Newton's steps find better places.
  double NearDistance2(const Vec3& c, const LowerModel& low, double enough, double bound) {
    if (bound >= enough) return bound;
    const Rect r = leaf_.rect();
    const BoxMinimum guess = GuessMinimum(*model_, c);
    double u = r.u0 + (0.5 + guess.x) * (r.u1 - r.u0), v = r.v0 + (0.5 + guess.y) * (r.v1 - r.v0);
    for (int k = 0; k < kNewtonSteps; ++k) {
      const SurfaceJet j = Evaluate(piece_, u, v);
      const Vec3 d = ToRay(j.p, c);
      const double f = 0.5 * d.squaredNorm();
      if (2.0 * f < distance2_) {
        met_ = true;
        return bound;
      }
      const Vec2 slope(d.dot(j.du), d.dot(j.dv));
      bound = std::max(bound, 2.0 * LeastFrom(*model_, low, c, LocalJetAt(r, u, v, d, slope)));
      if (low.convex) bound = std::max(bound, 2.0 * LinearMinimum(f, slope, r, u, v));
      if (!low.convex || bound >= std::min(enough, 2.0 * f - 0.1 * spare2_)) break;
      const int n = d.z() > 0.0 ? 3 : 2;  // above the centre f measures horizontally
      const Quadratic2 model{j.du.head(n).squaredNorm() - d.dot(j.duu),
                             j.du.head(n).dot(j.dv.head(n)) - d.dot(j.duv),
                             j.dv.head(n).squaredNorm() - d.dot(j.dvv), -slope.x(), -slope.y()};
      const BoxMinimum to = MinimizeOnBox(model, {r.u0 - u, r.u1 - u, r.v0 - v, r.v1 - v});
      u = std::clamp(u + to.x, r.u0, r.u1);
      v = std::clamp(v + to.y, r.v0, r.v1);
    }
    return bound;
  }

  const SearchLeaf& leaf_;
  const LeafBox& box_;
  const LeafGrid& grid_;
  std::optional<LeafModel> model_;  // set if the box does not suffice
  const Piece& piece_;
  const Vec3 &a_, &b_;
  const double length_, distance2_, spare2_;
  bool met_ = false;
};

}  // namespace

// A node is out of the way if one of three holds: its boxes are (in plan, from the move's box or across the
// move, and below it); [location T2a] proves it from both ends; or its half-space lies below both ends.
bool CollectSweptLeaves(const Locator::Impl& impl, const SweptMove& move, std::vector<std::int32_t>& open) {
  const Vec3 &a = move.a, &b = move.b;
  const double radius = impl.radius, distance = move.distance;
  const auto limit =
      static_cast<float>(distance * distance + 1e-6 * radius * radius + 4e-6 * radius * impl.reach);
  const Vec2 plan = Xy(b) - Xy(a);
  const double plan_length = plan.norm();
  const Vec2 across =
      plan_length > 0.0 ? Vec2(-plan.y() / plan_length, plan.x() / plan_length) : Vec2(Vec2::Zero());
  const Float4 qx0 = Splat(static_cast<float>(std::min(a.x(), b.x())));
  const Float4 qx1 = Splat(static_cast<float>(std::max(a.x(), b.x())));
  const Float4 qy0 = Splat(static_cast<float>(std::min(a.y(), b.y())));
  const Float4 qy1 = Splat(static_cast<float>(std::max(a.y(), b.y())));
  const Float4 lowest = Splat(static_cast<float>(std::min(a.z(), b.z())));
  const Float4 nx = Splat(static_cast<float>(across.x())), ny = Splat(static_cast<float>(across.y()));
  const Float4 offset = Splat(static_cast<float>(across.dot(Xy(a))));
  const Float4 zero = Splat(0.0F), half = Splat(0.5F);
  const bool is_long = plan_length > radius;
  // Includes the rounding of squares as large as that of the chord.
  const Float4 both =
      Splat(static_cast<float>(static_cast<double>(limit) + (0.25 + 1e-6) * (b - a).squaredNorm()));
  const auto from_end = [&](const SearchNode& node, const Vec3& end) {
    const Float4 x = Splat(static_cast<float>(end.x())), y = Splat(static_cast<float>(end.y()));
    const Float4 dx = Max(Max(node.min_x - x, x - node.max_x), zero);
    const Float4 dy = Max(Max(node.min_y - y, y - node.max_y), zero);
    const Float4 dz = Max(Splat(static_cast<float>(end.z())) - node.max_z, zero);
    return dx * dx + dy * dy + dz * dz;
  };
  // Both ends are tested, and so all centres between them.
  const double coordinate = std::max({impl.reach, a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff()});
  const Float4 away = Splat(static_cast<float>(distance + 4e-6 * (radius + coordinate)));
  const auto over_half_space = [&](const SearchNode& node, const Vec3& end) {
    return node.up_x * Splat(static_cast<float>(end.x())) + node.up_y * Splat(static_cast<float>(end.y())) +
           node.up_z * Splat(static_cast<float>(end.z())) - away;
  };
  const SweptBall swept(a, b);

  thread_local std::vector<std::int32_t> stack;
  stack.assign(1, 0);
  while (!stack.empty()) {
    const std::int32_t id = stack.back();
    stack.pop_back();
    if (id < 0) {
      const SearchLeaf& leaf = impl.tree.leaves[~id];
      const LeafBox box = leaf.Box(impl.tree.grid);
      if (is_long && swept.DistanceBelow(box.center, box.axis, box.half) >= distance) continue;
      LeafProof proof(leaf, impl.tree.grid, box, impl.surface.pieces[static_cast<std::size_t>(leaf.piece())],
                      move);
      if (!proof.Out()) {
        if (proof.met()) return false;
        open.push_back(~id);
      }
      continue;
    }
    const SearchNode& node = impl.tree.nodes[static_cast<std::size_t>(id)];
    const Float4 dx = Max(Max(node.min_x - qx1, qx0 - node.max_x), zero);
    const Float4 dy = Max(Max(node.min_y - qy1, qy0 - node.max_y), zero);
    const Float4 below = Max(lowest - node.max_z, zero);
    const Float4 beside =
        Max(Abs(nx * (half * (node.min_x + node.max_x)) + ny * (half * (node.min_y + node.max_y)) - offset) -
                half * (Abs(nx) * (node.max_x - node.min_x) + Abs(ny) * (node.max_y - node.min_y)),
            zero);
    const Float4 all = Max(dx * dx + dy * dy, beside * beside) + below * below;
    unsigned in = BelowBits(all, Splat(limit));
    if (in == 0) continue;
    in &= BelowBits(from_end(node, a), both) | BelowBits(from_end(node, b), both);
    in &= ~BelowBits(node.top, Min(over_half_space(node, a), over_half_space(node, b)));
    for (; in != 0; in &= in - 1) {
      const std::int32_t child = node.child[std::countr_zero(in)];
      impl.tree.Prefetch(child);
      stack.push_back(child);
    }
  }
  return true;
}

}  // namespace patchmill::internal
