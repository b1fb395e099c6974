#include "cam/location/locator.h"

#include <algorithm>
#include <cmath>

#include "cam/location/locator_impl.h"
#include "cam/location/tree_walk.h"
#include "core/base/status.h"

namespace patchmill {

using internal::Ball;
using internal::Contact;
using internal::LowerModel;
using internal::Rect;
using internal::SearchOptions;
using internal::SearchResult;

namespace {

bool IsKkt(const Contact& c, const Rect& r) {
  return (c.slope.x() <= 0.0 || c.u == r.u1) && (c.slope.x() >= 0.0 || c.u == r.u0) &&
         (c.slope.y() <= 0.0 || c.v == r.v1) && (c.slope.y() >= 0.0 || c.v == r.v0);
}

bool Holds(const Rect& r, double u, double v) { return u >= r.u0 && u <= r.u1 && v >= r.v0 && v <= r.v1; }

}  // namespace

Locator::Impl::Impl(const Surface& s, double r, internal::SearchTree t)
    : surface(s),
      radius(r),
      rounding(1e-14 * s.scale),
      slack(1e-12 * s.scale),
      reach(s.scale + r),
      tree(std::move(t)) {
  PM_CHECK(radius > 0.0);
}

void Locator::Impl::StartFromHint(const Ball& ball, const SurfacePoint& hint, Contact& best) const {
  const std::size_t piece = hint.piece.index();
  if (hint.piece.value < 0 || piece >= surface.pieces.size()) return;
  const Vec2 d = Xy(hint.p) - ball.q;
  if (!(d.squaredNorm() < 4.0 * radius * radius)) return;  // too far to help
  internal::RaiseOnPiece({surface.pieces[piece], hint.piece.value, Rect{}}, {hint.u, hint.v}, ball, {}, best);
}

// A box is out of the ball's way iff plan distance^2 + max(0, z - max_z)^2 >= R^2, for the current centre
// height z. If it ends below the ball, its half-space is tested, too (SearchNode). Computed in floats, with a
// margin for their rounding.
void Locator::Impl::Search(const Ball& ball, double enough, Aim aim, Contact& best, OpenLeaves& open) const {
  const auto x = static_cast<float>(ball.q.x()), y = static_cast<float>(ball.q.y());
  internal::WalkTree(
      tree, {{x, x, y, y}, Limits()}, [&] { return static_cast<float>(best.z); },
      [&](std::int32_t leaf) {
        VisitLeaf(leaf, ball, aim, best, open);
        return best.z <= enough;
      });
}

double Locator::Impl::SearchAll(const Ball& ball, double eps, Contact& best, OpenLeaves& open) const {
  open.clear();
  Search(ball, kInfinity, Aim::kHighest, best, open);
  return Certify(ball, open, eps, Aim::kHighest, best);
}

Locator::Impl::FreeBall Locator::Impl::TryFree(const Ball& ball, double z, double eps,
                                               OpenLeaves& open) const {
  open.clear();
  Contact best;
  best.z = std::max(z, Lowest());  // nothing changes below
  Search(ball, best.z, Aim::kAny, best, open);
  if (best.piece >= 0) return {.contact = best, .lift = 0.0};
  return ProveFree(ball, z, eps, open);
}

// A point within rounding of the ball's surface counts as outside.
Locator::Impl::FreeBall Locator::Impl::ProveFree(const Ball& ball, double z, double eps,
                                                 std::span<const std::int32_t> open) const {
  Contact best;
  const double start = best.z = std::max(z, Lowest());
  const double gap = Certify(ball, open, eps, Aim::kAny, best);
  if (best.piece >= 0 && Raised(start, best)) return {.contact = best, .lift = 0.0};
  return {.contact = std::nullopt, .lift = best.z + gap - start};
}

bool Locator::Impl::Raised(double before, const Contact& c) const {
  const double below = std::max(c.z - c.p.z(), 0.0);
  return c.z > before + 1e-9 + std::sqrt(below * below + 8.0 * radius * rounding) - below;
}

bool Locator::Impl::IsOnlyContact(const Contact& best, const internal::PiecePart& part,
                                  const internal::LeafModel& model, const LowerModel& low,
                                  const Ball& ball) const {
  const Rect& rect = part.rect;
  if (best.piece != part.index || !Holds(rect, best.u, best.v)) return false;
  if (low.convex && IsKkt(best, rect)) return true;
  const Vec3 c = Lift(ball.q, best.z), d = internal::ToRay(best.p, c);
  return internal::LeastFrom(model, low, c, internal::LocalJetAt(rect, best.u, best.v, d, best.slope)) >=
         ball.FreeF();
}

void Locator::Impl::VisitLeaf(std::int32_t index, const Ball& ball, Aim aim, Contact& best,
                              OpenLeaves& open) const {
  const internal::SearchLeaf& leaf = tree.leaves[index];
  const double free_f = ball.FreeF();
  const Vec3 c = Lift(ball.q, best.z);
  if (leaf.Outside(tree.grid, c, 2.0 * free_f)) return;

  const internal::LeafModel model = leaf.Model(tree.grid);
  const LowerModel lower = internal::BoundBelow(model, c);
  const internal::PiecePart part{surface.pieces[static_cast<std::size_t>(leaf.piece())], leaf.piece(),
                                 leaf.rect()};
  const Rect& rect = part.rect;
  if (IsOnlyContact(best, part, model, lower, ball)) return;
  if (internal::LeastOn(model, lower, c) >= free_f) return;

  const auto at = [&](double x, double y) {
    return Vec2(rect.u0 + (0.5 + x) * (rect.u1 - rect.u0), rect.v0 + (0.5 + y) * (rect.v1 - rect.v0));
  };
  const BoxMinimum guess = internal::GuessMinimum(model, c);
  SearchOptions options;
  options.model = &model;
  options.lower = &lower;
  const SearchResult found = internal::RaiseOnPiece(part, at(guess.x, guess.y), ball, options, best);
  if (found.out || (aim == Aim::kAny && found.improved)) return;
  // If f is proven convex, there is one maximum, and the search has found it.
  const LowerModel raised = found.improved ? internal::BoundBelow(model, Lift(ball.q, best.z)) : lower;
  if (raised.convex) {
    if (found.convex_minimum < ProofF()) open.push_back(index);
    return;
  }
  if (found.improved && IsOnlyContact(best, part, model, raised, ball)) return;
  // Start again from the corners of the quarters that may hold more.
  const Vec3 now = Lift(ball.q, best.z);
  const internal::LocalJet ended =
      internal::LocalJetAt(rect, found.u, found.v, internal::ToRay(found.p, now), found.slope);
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      const Box2 quarter{std::min(x, 0.0), std::max(x, 0.0), std::min(y, 0.0), std::max(y, 0.0)};
      if (internal::LeastFrom(model, raised, now, ended, quarter) >= free_f) continue;
      const bool better = internal::RaiseOnPiece(part, at(x, y), ball, {}, best).improved;
      if (aim == Aim::kAny && better) return;
    }
  }
  open.push_back(index);
}

absl::StatusOr<Locator> Locator::Make(const Surface& surface, double radius, const RunContext& run) {
  PM_CHECK(radius > 0.0);
  PM_ASSIGN_OR_RETURN(internal::SearchTree tree, internal::BuildSearchTree(surface, radius, run));
  return Locator(std::make_unique<Impl>(surface, radius, std::move(tree)));
}

Locator::Locator(const Surface& surface, double radius) : Locator(*Make(surface, radius, RunContext())) {}
Locator::Locator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Locator::~Locator() = default;
Locator::Locator(Locator&&) noexcept = default;

const Surface& Locator::surface() const { return impl_->surface; }
double Locator::radius() const { return impl_->radius; }
std::uint64_t Locator::defect_count() const { return impl_->defects.load(); }

std::optional<CenterPoint> Locator::Height(const Vec2& q, const SurfacePoint* hint, double gap) const {
  thread_local Impl::OpenLeaves open;
  const Ball ball = impl_->BallAt(q);
  Contact best;
  best.z = impl_->Lowest();
  if (hint != nullptr) impl_->StartFromHint(ball, *hint, best);
  impl_->SearchAll(ball, gap, best, open);
  if (best.piece < 0) return std::nullopt;
  return CenterPoint{best.z, impl_->PointOf(best)};
}

bool Locator::Free(const Vec3& c, double slack, double gap) const {
  thread_local Impl::OpenLeaves open;
  return !impl_->TryFree(impl_->BallAt(Xy(c)), c.z() + slack, gap, open).contact;
}

std::optional<double> Locator::CertifiedFree(const Vec3& c, double eps) const {
  thread_local Impl::OpenLeaves open;
  const auto found = impl_->TryFree(impl_->BallAt(Xy(c)), c.z(), std::max(eps, 1e-7), open);
  if (found.contact) return std::nullopt;
  return found.lift;
}

std::optional<CertifiedCenter> Locator::CertifiedHeight(const Vec2& q, double eps,
                                                        const SurfacePoint* hint) const {
  thread_local Impl::OpenLeaves open;
  const Ball ball = impl_->BallAt(q);
  Contact best;
  best.z = impl_->Lowest();
  if (hint != nullptr) impl_->StartFromHint(ball, *hint, best);
  const double gap = impl_->SearchAll(ball, std::max(eps, 1e-7), best, open);
  if (best.piece < 0) return std::nullopt;
  return CertifiedCenter{best.z, gap, impl_->PointOf(best)};
}

std::optional<CertifiedCenter> Locator::Correction(const Vec3& c, double gap,
                                                   const SurfacePoint* hint) const {
  constexpr double kKnown = 1e-9;  // mm
  const auto lift = CertifiedFree(c + Vec3(0, 0, kKnown), gap);
  if (lift && *lift <= gap) return std::nullopt;
  // Beside a wall that is nearly vertical a rounding of the place raises the ball by much more than it
  // gouges.
  if (GougeWithin(c, c, gap, 0.5 * gap)) return std::nullopt;
  const auto h = CertifiedHeight(Xy(c), gap, hint);
  if (!h || h->z + h->gap <= c.z()) return std::nullopt;
  impl_->defects.fetch_add(1, std::memory_order_relaxed);
  return h;
}

}  // namespace patchmill
