#include "cam/location/locator.h"

#include <algorithm>
#include <array>
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
  const Vec2 d = Plan(hint.p) - ball.q;
  if (!(d.squaredNorm() < 4.0 * radius * radius)) return;  // too far to help
  internal::RaiseOnPiece(surface.pieces[piece], hint.piece.value, Rect{}, hint.u, hint.v, ball, {}, best);
}

// A box is out of the ball's way iff plan distance^2 + max(0, z - max_z)^2 >= R^2, for the current centre
// height z. In floats, with a margin for their rounding.
void Locator::Impl::Search(const Ball& ball, double enough, Aim aim, Contact& best, OpenLeaves& open) const {
  const auto limit = static_cast<float>(radius * radius + 1e-6 * radius * radius + 1e-6 * radius * reach);
  const auto x = static_cast<float>(ball.q.x()), y = static_cast<float>(ball.q.y());
  internal::WalkTree(
      tree, {x, x, y, y}, limit, [&] { return static_cast<float>(best.z); },
      [&](std::int32_t leaf) {
        VisitLeaf(leaf, ball, aim, best, open);
        return best.z <= enough;
      });
}

void Locator::Impl::SearchAll(const Ball& ball, Contact& best, OpenLeaves& open) const {
  open.Clear();
  Search(ball, kInfinity, Aim::kHighest, best, open);
  if (open.all.empty() || !(Grazes(best) || IsTie(open.tie, best))) return;
  const double found = best.z;
  Certify(ball, open.all, Grazes(best) ? 1e-6 : 1e-8, best);
  if (Raised(found, best)) equator_raises.fetch_add(1, std::memory_order_relaxed);
}

Contact Locator::Impl::AnyContact(const Ball& ball, double z, OpenLeaves& open) const {
  open.Clear();
  Contact best;
  best.z = std::max(z, Lowest());  // below nothing changes
  Search(ball, best.z, Aim::kAny, best, open);
  if (best.piece >= 0 || !open.doubtful) return best;
  const double found = best.z;
  Certify(ball, open.all, 1e-6, best);
  if (best.piece >= 0 && Raised(found, best)) equator_raises.fetch_add(1, std::memory_order_relaxed);
  return best;
}

bool Locator::Impl::Raised(double before, const Contact& c) const {
  const double below = std::max(c.z - c.p.z(), 0.0);
  return c.z > before + 1e-9 + std::sqrt(below * below + 8.0 * radius * rounding) - below;
}

double Locator::Impl::RunnerUp(const SearchResult& ended, const Ball& ball, const Contact& best) const {
  const double rim2 = radius * radius - (Plan(ended.p) - ball.q).squaredNorm();
  if (!(rim2 > 0.0) || (ended.p - best.p).norm() <= kNearly * radius) return -kInfinity;
  return ended.p.z() + std::sqrt(rim2);
}

bool Locator::Impl::IsOnlyContact(const Contact& best, std::int32_t piece, const Rect& rect,
                                  const internal::LeafModel& model, const LowerModel& low,
                                  const Ball& ball) const {
  if (best.piece != piece || !Holds(rect, best.u, best.v)) return false;
  if (low.convex && IsKkt(best, rect)) return true;
  const Vec3 c = Lift(ball.q, best.z), d = internal::ToRay(best.p, c);
  return internal::LeastFrom(model, low, c, internal::LocalJetAt(rect, best.u, best.v, d, best.slope)) >=
         ball.FreeF();
}

void Locator::Impl::NoteMissed(std::span<const SearchResult> ended, const Ball& ball, double z,
                               OpenLeaves& open) const {
  for (const SearchResult& e : ended) {
    open.doubtful = open.doubtful || NearEquator(z, e.p);
    const double rim2 = radius * radius - (Plan(e.p) - ball.q).squaredNorm();
    if (!(rim2 > 0.0) || e.p.z() + std::sqrt(rim2) < z - kNearly * radius) continue;
    if (!open.nearly) open.nearly = e.p;
    open.doubtful = open.doubtful || (e.p - *open.nearly).norm() > kNearly * radius;
  }
}

void Locator::Impl::VisitLeaf(std::int32_t index, const Ball& ball, Aim aim, Contact& best,
                              OpenLeaves& open) const {
  const internal::SearchLeaf& leaf = tree.leaves[index];
  const double free_f = ball.FreeF();
  const Vec3 c = Lift(ball.q, best.z);
  if (leaf.Outside(tree.grid, c, 2.0 * free_f)) return;

  const internal::LeafModel model = leaf.Model(tree.grid);
  const LowerModel lower = internal::BoundBelow(model, c);
  const Rect rect = leaf.rect();
  if (IsOnlyContact(best, leaf.piece(), rect, model, lower, ball)) return;
  if (internal::LeastOn(model, lower, c) >= free_f) return;

  const Piece& piece = surface.pieces[static_cast<std::size_t>(leaf.piece())];
  const auto at = [&](double x, double y) {
    return Vec2(rect.u0 + (0.5 + x) * (rect.u1 - rect.u0), rect.v0 + (0.5 + y) * (rect.v1 - rect.v0));
  };
  const BoxMinimum guess = internal::GuessMinimum(model, c);
  SearchOptions options;
  options.model = &model;
  options.lower = &lower;
  const Vec2 start = at(guess.x, guess.y);
  const SearchResult found =
      internal::RaiseOnPiece(piece, leaf.piece(), rect, start.x(), start.y(), ball, options, best);
  if (found.out || (aim == Aim::kAny && found.improved)) return;
  // One maximum, proven? Then the search has found it.
  const LowerModel raised = found.improved ? internal::BoundBelow(model, Lift(ball.q, best.z)) : lower;
  if (raised.convex) {
    if (found.convex_minimum < ProofF()) open.all.push_back(index);
    return;
  }
  if (found.improved && IsOnlyContact(best, leaf.piece(), rect, model, raised, ball)) return;
  options = {};
  std::array<SearchResult, 5> ended = {found};
  std::size_t count = 1;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      const Vec2 corner = at(x, y);
      ended[count++] =
          internal::RaiseOnPiece(piece, leaf.piece(), rect, corner.x(), corner.y(), ball, options, best);
    }
  }
  open.all.push_back(index);
  if (aim == Aim::kAny) {
    if (best.piece < 0) NoteMissed(ended, ball, best.z, open);
    return;
  }
  double highest = -kInfinity;
  for (const SearchResult& e : ended) highest = std::max(highest, RunnerUp(e, ball, best));
  if (IsTie(highest, best)) open.tie = std::max(open.tie, highest);
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
std::uint64_t Locator::equator_raise_count() const { return impl_->equator_raises.load(); }

std::optional<CenterPoint> Locator::Height(const Vec2& q, const SurfacePoint* hint) const {
  thread_local Impl::OpenLeaves open;
  const Ball ball = impl_->BallAt(q);
  Contact best;
  best.z = impl_->Lowest();
  if (hint != nullptr) impl_->StartFromHint(ball, *hint, best);
  impl_->SearchAll(ball, best, open);
  if (best.piece < 0) return std::nullopt;
  return CenterPoint{best.z, impl_->PointOf(best)};
}

bool Locator::Free(const Vec3& c, double slack) const {
  thread_local Impl::OpenLeaves open;
  return impl_->AnyContact(impl_->BallAt(Plan(c)), c.z() + slack, open).piece < 0;
}

std::optional<double> Locator::CertifiedFree(const Vec3& c, double eps) const {
  thread_local Impl::OpenLeaves open;
  const Ball ball = impl_->BallAt(Plan(c));
  Contact best = impl_->AnyContact(ball, c.z(), open);
  if (best.piece >= 0) return std::nullopt;
  const double found = best.z;
  const double gap = impl_->Certify(ball, open.all, std::max(eps, 1e-7), best);
  // What lies within rounding of the ball's surface is as much outside as inside.
  if (best.piece >= 0 && impl_->Raised(found, best)) {
    impl_->defects.fetch_add(1, std::memory_order_relaxed);
    return std::nullopt;
  }
  return best.z + gap - found;
}

std::optional<CertifiedCenter> Locator::CertifiedHeight(const Vec2& q, double eps,
                                                        const SurfacePoint* hint) const {
  thread_local Impl::OpenLeaves open;
  const Ball ball = impl_->BallAt(q);
  Contact best;
  best.z = impl_->Lowest();
  if (hint != nullptr) impl_->StartFromHint(ball, *hint, best);
  impl_->SearchAll(ball, best, open);
  const double found = best.z;
  const bool had = best.piece >= 0;
  const double gap = impl_->Certify(ball, open.all, std::max(eps, 1e-7), best);
  if (best.piece >= 0 && (!had || impl_->Raised(found, best))) {
    impl_->defects.fetch_add(1, std::memory_order_relaxed);
  }
  if (best.piece < 0) return std::nullopt;
  return CertifiedCenter{best.z, gap, impl_->PointOf(best)};
}

}  // namespace patchmill
