#include "cam/location/locator.h"

#include <algorithm>
#include <cmath>

#include "cam/location/locator_impl.h"
#include "core/base/status.h"

namespace patchmill {

using internal::Ball;
using internal::Contact;
using internal::LowerModel;
using internal::Rect;
using internal::SearchOptions;
using internal::SearchResult;

namespace {

// Height up to which a node can lift the ball over q; -infinity when it is not under the ball.
double NodeBound(const internal::SearchNode& n, const Ball& ball) {
  const double dx = std::max({n.min_x - ball.q.x(), ball.q.x() - n.max_x, 0.0});
  const double dy = std::max({n.min_y - ball.q.y(), ball.q.y() - n.max_y, 0.0});
  const double rim = ball.radius * ball.radius - (dx * dx + dy * dy);
  return rim > 0.0 ? n.max_z + std::sqrt(rim) : -kInfinity;
}

struct Pending {
  std::int32_t node;
  double bound;
};

std::vector<Pending>& SearchStack() {
  thread_local std::vector<Pending> stack;
  stack.clear();
  return stack;
}

bool IsKkt(const Contact& c, const Rect& r) {
  return (c.slope.x() <= 0.0 || c.u == r.u1) && (c.slope.x() >= 0.0 || c.u == r.u0) &&
         (c.slope.y() <= 0.0 || c.v == r.v1) && (c.slope.y() >= 0.0 || c.v == r.v0);
}

bool Holds(const Rect& r, double u, double v) { return u >= r.u0 && u <= r.u1 && v >= r.v0 && v <= r.v1; }

}  // namespace

Locator::Impl::Impl(const Surface& s, double r)
    : surface(s),
      radius(r),
      rounding(1e-14 * s.scale),
      slack(1e-12 * s.scale),
      tree(internal::BuildSearchTree(s, r)) {
  PM_CHECK(radius > 0.0);
}

void Locator::Impl::StartFromHint(const Ball& ball, const SurfacePoint& hint, Contact& best) const {
  const std::size_t piece = hint.piece.index();
  if (hint.piece.value < 0 || piece >= surface.pieces.size()) return;
  const Vec2 d = Plan(hint.p) - ball.q;
  if (!(d.squaredNorm() < 4.0 * radius * radius)) return;  // too far to help
  internal::RaiseOnPiece(surface.pieces[piece], hint.piece.value, Rect{}, hint.u, hint.v, ball, {}, best);
}

void Locator::Impl::Search(const Ball& ball, double enough, Contact& best, OpenLeaves* open) const {
  std::vector<Pending>& stack = SearchStack();
  const auto beats = [&](double bound) { return bound > best.z + rounding; };
  const auto push = [&](std::int32_t node, double bound) {
    if (beats(bound)) stack.push_back({node, bound});
  };
  push(0, NodeBound(tree.nodes[0], ball));
  while (!stack.empty() && !(best.z > enough)) {
    const Pending top = stack.back();
    stack.pop_back();
    if (!beats(top.bound)) continue;
    const internal::SearchNode& node = tree.nodes[static_cast<std::size_t>(top.node)];
    if (node.leaf >= 0) {
      VisitLeaf(node.leaf, ball, best, open);
      continue;
    }
    const std::int32_t left = top.node + 1;
    const double bound_left = NodeBound(tree.nodes[static_cast<std::size_t>(left)], ball);
    const double bound_right = NodeBound(tree.nodes[static_cast<std::size_t>(node.right)], ball);
    if (bound_left > bound_right) {
      push(node.right, bound_right);
      push(left, bound_left);
    } else {
      push(left, bound_left);
      push(node.right, bound_right);
    }
  }
}

void Locator::Impl::VisitLeaf(std::int32_t index, const Ball& ball, Contact& best, OpenLeaves* open) const {
  const internal::SearchLeaf& leaf = tree.leaves[static_cast<std::size_t>(index)];
  const double free_f = ball.FreeF();
  const Vec3 c = Lift(ball.q, best.z);
  if (internal::OrientedBoxOutside(leaf.center, leaf.axis, leaf.half, c, 2.0 * free_f)) return;

  const LowerModel lower = internal::BoundBelow(leaf.model, c);
  if (lower.convex && best.piece == leaf.piece && Holds(leaf.rect, best.u, best.v) &&
      IsKkt(best, leaf.rect)) {
    return;
  }
  if (lower.minorant && lower.f0 + MinimizeOnBox(lower.q, {-0.5, 0.5, -0.5, 0.5}).value >= free_f) return;

  const Piece& piece = surface.pieces[static_cast<std::size_t>(leaf.piece)];
  const Rect& rect = leaf.rect;
  const auto at = [&](double x, double y) {
    return Vec2(rect.u0 + (0.5 + x) * (rect.u1 - rect.u0), rect.v0 + (0.5 + y) * (rect.v1 - rect.v0));
  };
  const BoxMinimum guess = internal::GuessMinimum(leaf.model, c);
  SearchOptions options;
  options.lower = &lower;
  const Vec2 start = at(guess.x, guess.y);
  const SearchResult found =
      internal::RaiseOnPiece(piece, leaf.piece, rect, start.x(), start.y(), ball, options, best);
  // One maximum, proven? Then the search has found it.
  const bool convex =
      found.improved ? internal::BoundBelow(leaf.model, Lift(ball.q, best.z)).convex : lower.convex;
  if (convex) {
    if (found.convex_minimum < ProofF() && open != nullptr) open->push_back(index);
    return;
  }
  options.lower = nullptr;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      const Vec2 corner = at(x, y);
      internal::RaiseOnPiece(piece, leaf.piece, rect, corner.x(), corner.y(), ball, options, best);
    }
  }
  if (open != nullptr) open->push_back(index);
}

Locator::Locator(const Surface& surface, double radius) : impl_(std::make_unique<Impl>(surface, radius)) {}
Locator::~Locator() = default;
Locator::Locator(Locator&&) noexcept = default;

const Surface& Locator::surface() const { return impl_->surface; }
double Locator::radius() const { return impl_->radius; }
std::uint64_t Locator::defect_count() const { return impl_->defects.load(); }

std::optional<CenterPoint> Locator::Height(const Vec2& q, const SurfacePoint* hint) const {
  const Ball ball = impl_->BallAt(q);
  Contact best;
  best.z = impl_->Lowest();
  if (hint != nullptr) impl_->StartFromHint(ball, *hint, best);
  impl_->Search(ball, kInfinity, best, nullptr);
  if (best.piece < 0) return std::nullopt;
  return CenterPoint{best.z, impl_->PointOf(best)};
}

bool Locator::Free(const Vec3& c, double slack) const {
  Contact best;
  best.z = std::max(c.z() + slack, impl_->Lowest());  // below Lowest() nothing changes
  impl_->Search(impl_->BallAt(Plan(c)), best.z, best, nullptr);
  return best.piece < 0;
}

std::optional<CertifiedCenter> Locator::CertifiedHeight(const Vec2& q, double eps,
                                                        const SurfacePoint* hint) const {
  thread_local Impl::OpenLeaves open;
  open.clear();
  const Ball ball = impl_->BallAt(q);
  Contact best;
  best.z = impl_->Lowest();
  if (hint != nullptr) impl_->StartFromHint(ball, *hint, best);
  impl_->Search(ball, kInfinity, best, &open);
  const double found = best.z;
  // Where the contact is about to leave the disc, h answers a rounding of the surface with a multiple of it.
  const double steepness = impl_->radius / std::max(best.z - best.p.z(), 1e-12);
  const bool had = best.piece >= 0;
  const double gap = impl_->Certify(ball, open, std::max(eps, 1e-7), best);
  if (best.z > found + 1e-9 + 4.0 * impl_->rounding * steepness || (!had && best.piece >= 0)) {
    impl_->defects.fetch_add(1, std::memory_order_relaxed);
  }
  if (best.piece < 0) return std::nullopt;
  return CertifiedCenter{best.z, gap, impl_->PointOf(best)};
}

}  // namespace patchmill
