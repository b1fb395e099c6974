// The proof behind every search. Parts that local searches alone cannot exclude are subdivided until hulls,
// oriented boxes or convexity ([location T6]) exclude them.
#include <algorithm>
#include <array>
#include <cmath>

#include "cam/location/locator_impl.h"
#include "cam/location/upright_sheet.h"
#include "core/base/polled_run.h"
#include "core/surface/form_sign.h"

namespace patchmill {
namespace {

using internal::Ball;
using internal::Contact;
using internal::LeafModel;
using internal::LowerModel;
using internal::Rect;

constexpr int kBudget = 20000;  // parts per query
// After so many parts a proof asks whether its result is still wanted. If not, its budget is used up.
constexpr int kPartsBetweenPolls = 64;
// Halvings of one leaf. Beside a singular corner no model helps. There a part is divided until it is smaller
// than the gap, which takes 2 log2(leaf / gap) halvings. 100 halvings take a leaf of 100 m below 1e-7 mm.
constexpr int kMaxLevel = 100;

// After so many parts distance forms are tried, too, with at most kFormParts parts each.
constexpr int kPartsBeforeForms = 200;
constexpr int kFormParts = 100;

struct Prover {
  const Locator::Impl& impl;
  const bool any;      // the first contact that is more than rounding ends it: `done`
  const double start;  // first height of the ball
  const Ball& ball;
  double free_f;  // f from which a part counts as outside
  double eps;
  Contact& best;
  int budget = kBudget;
  bool done = false;
  double top = -kInfinity;  // all parts handled so far are proven to lie below this centre height
  std::vector<Vec4>& buffer;
  DistanceForm& form;  // scratch

  // Excludes a part for a centre at height z, and records z as proven.
  bool Excluded(const RectBounds& bounds, double z) {
    const Vec3 c = Lift(ball.q, z);
    const double limit2 = 2.0 * free_f;
    if (!internal::BoxOutside(bounds.box, c, limit2) &&
        !internal::OrientedBoxOutside(bounds.center, bounds.axis, bounds.half, c, limit2)) {
      return false;
    }
    top = std::max(top, z);
    return true;
  }
  bool Excluded(const LeafModel& model, const LowerModel& low, double z) {
    if (!(internal::LeastOn(model, low, Lift(ball.q, z)) >= free_f)) return false;
    top = std::max(top, z);
    return true;
  }

  // Excludes a part of a vertical wall if the ball stands beside it at any height.
  bool Beside(NetShape shape, const Vec4* points) {
    const auto curve = internal::XyCurveOf(shape, points, 4.0 * impl.rounding);
    if (!curve) return false;
    if (!internal::OutsideInXy(*curve, ball.q, std::sqrt(2.0 * free_f) + curve->spread)) return false;
    top = std::max(top, best.z);
    return true;
  }

  // Excludes any part by its distance form. This serves balls that touch the part along a line or all over,
  // as in a hole or a fillet of their own radius. Above the centre the distance in plan counts.
  bool ClearsForm(NetShape shape, const Vec4* points, bool rational, double highest, double z) {
    const Vec3 c = Lift(ball.q, z);
    std::array<Vec4, kMaxNetPoints> local;
    for (int k = 0; k < shape.count(); ++k) {
      local[static_cast<std::size_t>(k)] = points[k];
      local[static_cast<std::size_t>(k)].head<3>() -= points[k].w() * c;
    }
    MakeDistanceForm(shape, local.data(), rational, highest > z, std::sqrt(2.0 * free_f), form);
    if (!NowhereNegative(form, kFormParts)) return false;
    top = std::max(top, z);
    return true;
  }

  // True if the ball that touches p stands higher than the best one by more than the gap.
  bool Touches(const Vec3& p) const {
    const double rim2 = ball.radius * ball.radius - (Xy(p) - ball.q).squaredNorm();
    return rim2 > 0.0 && p.z() + std::sqrt(rim2) > best.z + eps;
  }

  void Prove(const Piece& piece, int piece_index, const Rect& rect, const Vec4* points, int level) {
    if (done) return;
    const NetShape shape{piece.net.degree_u, piece.net.degree_v};
    std::array<Vec3, kMaxNetPoints> hull;
    const int hull_count = HullPoints(shape, points, hull.data());
    const RectBounds bounds = BoundPoints(shape, points, hull.data(), hull_count);
    if (Excluded(bounds, best.z) || Excluded(bounds, best.z + eps) || Beside(shape, points)) return;
    if (--budget % kPartsBetweenPolls == 0 && ThisThreadCancelled()) budget = -1;
    if (budget < 0 || level >= kMaxLevel) {
      const double rim2 = ball.radius * ball.radius - internal::XyDistance2(bounds.box, ball.q);
      if (rim2 > 0.0) top = std::max(top, bounds.box.max.z() + std::sqrt(rim2));
      return;
    }

    const double mu = 0.5 * (rect.u0 + rect.u1), mv = 0.5 * (rect.v0 + rect.v1);
    const LeafModel model =
        internal::MakeLeafModel(piece, points, {hull.data(), static_cast<std::size_t>(hull_count)}, rect);
    LowerModel low = internal::BoundBelow(model, Lift(ball.q, best.z));
    if (Excluded(model, low, best.z)) return;
    // A concave part well inside the ball is not searched. It would be searched at each of its many divisions
    // without a result.
    if (low.convex || level <= 2 || Touches(model.s)) {
      const Vec3 c = Lift(ball.q, best.z);
      const BoxMinimum guess = internal::GuessMinimum(model, c);
      const internal::SearchResult found =
          internal::RaiseOnPiece({piece, piece_index, rect},
                                 {mu + guess.x * (rect.u1 - rect.u0), mv + guess.y * (rect.v1 - rect.v0)},
                                 ball, {.model = &model, .lower = &low}, best);
      done = any && found.improved && impl.Raised(start, best);
      if (done) return;
      if (found.improved) low = internal::BoundBelow(model, Lift(ball.q, best.z));
      if (found.out || (low.convex && found.convex_minimum >= free_f)) {
        top = std::max(top, best.z);
        return;
      }
    }
    const double above = best.z + eps;
    if (Excluded(model, internal::BoundBelow(model, Lift(ball.q, above)), above)) return;

    const double highest = bounds.box.max.z();
    if (kBudget - budget > kPartsBeforeForms && level % 3 == 0 &&
        (ClearsForm(shape, points, piece.net.rational, highest, best.z) ||
         ClearsForm(shape, points, piece.net.rational, highest, above))) {
      return;
    }

    const bool along_u = internal::IsLongerAlongU(model);
    Vec4* low_half = buffer.data() + 2 * level * kMaxNetPoints;
    Vec4* high_half = low_half + kMaxNetPoints;
    HalveNet(shape, points, along_u, low_half, high_half);
    Rect first = rect, second = rect;
    (along_u ? first.u1 : first.v1) = along_u ? mu : mv;
    (along_u ? second.u0 : second.v0) = along_u ? mu : mv;
    Prove(piece, piece_index, first, low_half, level + 1);
    Prove(piece, piece_index, second, high_half, level + 1);
  }
};

}  // namespace

double Locator::Impl::Certify(const Ball& ball, std::span<const std::int32_t> open, double eps, Aim aim,
                              Contact& best) const {
  if (open.empty()) return slack;
  thread_local std::vector<Vec4> buffer(2 * kMaxLevel * kMaxNetPoints);
  thread_local DistanceForm form;
  // The slack of a proof counts as gap, and so do roundings of heights.
  Prover prover{.impl = *this,
                .any = aim == Aim::kAny,
                .start = best.z,
                .ball = ball,
                .free_f = ProofF(),
                .eps = std::max(eps - 2.0 * slack, 0.5 * eps),
                .best = best,
                .top = best.z,
                .buffer = buffer,
                .form = form};
  std::array<Vec4, kMaxNetPoints> points;
  for (const std::int32_t index : open) {
    if (prover.done) break;
    const internal::SearchLeaf& leaf = tree.leaves[index];
    const Rect rect = leaf.rect();
    // The ball may have been raised since the search.
    const LeafModel model = leaf.Model(tree.grid);
    const LowerModel low = internal::BoundBelow(model, Lift(ball.q, best.z));
    if (prover.Excluded(model, low, best.z)) continue;
    const Piece& piece = surface.pieces[static_cast<std::size_t>(leaf.piece())];
    if (IsOnlyContact(best, {piece, leaf.piece(), rect}, model, low, ball)) {
      prover.top = std::max(prover.top, best.z);
      continue;
    }
    const double above = best.z + prover.eps;
    if (prover.Excluded(model, internal::BoundBelow(model, Lift(ball.q, above)), above)) continue;
    const NetShape shape{piece.net.degree_u, piece.net.degree_v};
    std::copy(piece.net.points.begin(), piece.net.points.end(), points.begin());
    RestrictNet(shape, points.data(), rect);
    prover.Prove(piece, leaf.piece(), rect, points.data(), 0);
  }
  // The contact was found on a part of a leaf whose neighbours the gap excluded. So the maximum may lie
  // beyond its border.
  if (!prover.any && best.z > prover.start) {
    const Piece& piece = surface.pieces[static_cast<std::size_t>(best.piece)];
    internal::RaiseOnPiece({piece, best.piece, Rect{}}, {best.u, best.v}, ball, {}, best);
  }
  return std::max(0.0, prover.top - best.z) + slack;
}

}  // namespace patchmill
