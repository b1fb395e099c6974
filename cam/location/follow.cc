// Follow: the local maximum of g that is reached from a given contact without leaving its hill, across the
// borders of pieces. Neighbours are found by position, not by topology: also across seams, poles, T-junctions
// and gaps within the join tolerance.
#include <algorithm>
#include <vector>

#include "cam/location/locator_impl.h"

namespace patchmill {
namespace {

using internal::Ball;
using internal::Contact;
using internal::LeafModel;
using internal::Rect;
using internal::SearchOptions;
using internal::SearchResult;

constexpr int kMaxCrossings = 64;
constexpr double kMinRise = 1e-12;  // mm

struct Spot {
  int piece = -1;
  double u = 0.0, v = 0.0;
  Vec3 p = Vec3::Zero();
  bool OnBorder() const { return u <= 0.0 || u >= 1.0 || v <= 0.0 || v >= 1.0; }
};

// The parameters on `rect` nearest to p from the parameters of a start near by: Gauss-Newton with the
// exact box step. Steps that do not help are halved.
Spot Nearest(const Piece& piece, const Rect& rect, const Spot& start, const Vec3& p) {
  Spot at = start;
  SurfaceJet jet = Evaluate(piece, at.u, at.v);
  at.p = jet.p;
  for (int k = 0; k < 20; ++k) {
    const Vec3 d = jet.p - p;
    const double e = jet.du.squaredNorm(), g = jet.dv.squaredNorm(), tiny = 1e-14 * (e + g) + 1e-300;
    const Quadratic2 q{e + tiny, jet.du.dot(jet.dv), g + tiny, d.dot(jet.du), d.dot(jet.dv)};
    const BoxMinimum step =
        MinimizeOnBox(q, {rect.u0 - at.u, rect.u1 - at.u, rect.v0 - at.v, rect.v1 - at.v});
    if (!(-step.value > 1e-26)) break;
    bool closer = false;
    for (double t = 1.0; t > 1e-3 && !closer; t *= 0.5) {
      const double nu = std::clamp(at.u + t * step.x, rect.u0, rect.u1);
      const double nv = std::clamp(at.v + t * step.y, rect.v0, rect.v1);
      const SurfaceJet next = Evaluate(piece, nu, nv);
      if ((next.p - p).squaredNorm() < d.squaredNorm()) {
        at = {start.piece, nu, nv, next.p};
        jet = next;
        closer = true;
      }
    }
    if (!closer) break;
  }
  return at;
}

}  // namespace

std::optional<CenterPoint> Locator::Follow(const SurfacePoint& from, const Vec2& q) const {
  const Surface& surface = impl_->surface;
  if (from.piece.value < 0 || from.piece.index() >= surface.pieces.size()) return std::nullopt;
  const Ball ball = impl_->BallAt(q);
  const double tolerance = std::max(surface.network.join_tolerance, 1e-9 * surface.scale);
  SearchOptions options;
  options.max_step = 0.2 * impl_->radius;  // so that it stays on its hill

  struct Walk {
    Contact best;
    Spot at;
    double f = kInfinity;  // half the squared distance in plan, while nothing is under the ball
    bool Feasible() const { return best.piece >= 0; }
  };
  const auto walk = [&](const Spot& start, const Contact& floor) {
    Walk w;
    w.best = floor;
    const SearchResult found =
        internal::RaiseOnPiece({surface.pieces[static_cast<std::size_t>(start.piece)], start.piece, Rect{}},
                               {start.u, start.v}, ball, options, w.best);
    w.at = {start.piece, found.u, found.v, found.p};
    w.f = found.f;
    return w;
  };
  Contact none;
  none.z = impl_->Lowest();
  Walk now = walk({from.piece.value, from.u, from.v, from.p}, none);

  thread_local std::vector<std::int32_t> stack;
  for (int crossing = 0; crossing < kMaxCrossings && now.at.OnBorder(); ++crossing) {
    Walk next = now;
    bool moved = false;
    stack.assign(1, 0);
    while (!stack.empty()) {
      const std::int32_t id = stack.back();
      stack.pop_back();
      if (id >= 0) {
        const internal::SearchNode& node = impl_->tree.nodes[static_cast<std::size_t>(id)];
        const Vec3& p = now.at.p;
        for (int k = 0; k < 4; ++k) {
          if (p.x() >= node.min_x[k] - tolerance && p.x() <= node.max_x[k] + tolerance &&
              p.y() >= node.min_y[k] - tolerance && p.y() <= node.max_y[k] + tolerance &&
              p.z() >= node.min_z[k] - tolerance && p.z() <= node.max_z[k] + tolerance) {
            stack.push_back(node.child[k]);
          }
        }
        continue;
      }
      const internal::SearchLeaf& leaf = impl_->tree.leaves[~id];
      const Rect r = leaf.rect();
      const BoxMinimum guess = internal::GuessMinimum(leaf.Model(impl_->tree.grid), now.at.p);
      const Spot guessed{leaf.piece(), r.u0 + (0.5 + guess.x) * (r.u1 - r.u0),
                         r.v0 + (0.5 + guess.y) * (r.v1 - r.v0), Vec3::Zero()};
      const Spot start =
          Nearest(surface.pieces[static_cast<std::size_t>(leaf.piece())], r, guessed, now.at.p);
      if (!((start.p - now.at.p).norm() <= tolerance)) continue;
      if (start.piece == now.at.piece && start.u == now.at.u && start.v == now.at.v) continue;
      const Walk trial = walk(start, now.best);
      const bool rises = now.Feasible()     ? trial.best.z > std::max(now.best.z + kMinRise, next.best.z)
                         : trial.Feasible() ? !next.Feasible() || trial.best.z > next.best.z
                                            : !next.Feasible() && trial.f < next.f - kMinRise * impl_->radius;
      if (rises) {
        next = trial;
        moved = true;
      }
    }
    if (!moved) break;
    now = next;
  }
  if (!now.Feasible()) return std::nullopt;
  return CenterPoint{now.best.z, impl_->PointOf(now.best)};
}

}  // namespace patchmill
