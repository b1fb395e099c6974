#include "core/surface/extent.h"

#include <algorithm>
#include <queue>

#include "core/base/parallel.h"
#include "core/base/polled_run.h"
#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

// Share of the coordinates by which rounding may put a place beyond the bound of its piece.
constexpr double kPlaceRounding = 1e-13;

// A sub-rectangle of a piece with a lower bound of sign * coordinate.
struct Candidate {
  double bound;
  PieceId piece;
  double u0, u1, v0, v1;
  BernsteinNet net;
};
struct Later {
  bool operator()(const Candidate& a, const Candidate& b) const { return a.bound > b.bound; }
};

double LowerBound(const BernsteinNet& net, int axis, double sign) {
  double low = kInfinity;
  for (const Vec4& p : net.points) {
    if (p.w() > 0.0) low = std::min(low, sign * p[axis] / p.w());
  }
  return low;
}

constexpr std::size_t kPolled = 256;  // pieces between two looks at the run of the thread

// The surface point where sign * (coordinate `axis`) is smallest.
SurfacePoint Extreme(const Surface& surface, int axis, double sign, double tolerance) {
  std::priority_queue<Candidate, std::vector<Candidate>, Later> queue;
  double best = kInfinity;
  SurfacePoint answer;
  const auto consider = [&](PieceId id, double u, double v) {
    const Vec3 p = Position(surface.piece(id), u, v);
    if (sign * p[axis] < best) {
      best = sign * p[axis];
      answer = {id, u, v, p};
    }
  };
  std::vector<double> bounds;
  for (const Piece& piece : surface.pieces) bounds.push_back(LowerBound(piece.net, axis, sign));
  for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
    if (i % kPolled == 0 && ThisThreadCancelled()) return answer;
    if (!(bounds[i] < best + kPlaceRounding * surface.scale)) continue;  // no place of the piece is better
    for (const double u : {0.0, 0.5, 1.0}) {
      for (const double v : {0.0, 0.5, 1.0}) consider(PieceId(i), u, v);
    }
  }
  for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
    if (bounds[i] < best - tolerance) queue.push({bounds[i], PieceId(i), 0, 1, 0, 1, surface.pieces[i].net});
  }
  while (!queue.empty() && queue.top().bound < best - tolerance && !ThisThreadCancelled()) {
    const Candidate c = queue.top();
    queue.pop();
    const bool split_u = c.u1 - c.u0 >= c.v1 - c.v0;
    for (const int half : {0, 1}) {
      Candidate child = c;
      if (split_u) {
        child.net = SubNet(c.net, 0.5 * half, 0.5 * (half + 1), 0, 1);
        (half == 0 ? child.u1 : child.u0) = 0.5 * (c.u0 + c.u1);
      } else {
        child.net = SubNet(c.net, 0, 1, 0.5 * half, 0.5 * (half + 1));
        (half == 0 ? child.v1 : child.v0) = 0.5 * (c.v0 + c.v1);
      }
      if (child.u1 - child.u0 < 1e-12) continue;
      consider(c.piece, 0.5 * (child.u0 + child.u1), 0.5 * (child.v0 + child.v1));
      for (const double u : {child.u0, child.u1}) {
        for (const double v : {child.v0, child.v1}) consider(c.piece, u, v);
      }
      child.bound = LowerBound(child.net, axis, sign);
      if (child.bound < best - tolerance) queue.push(std::move(child));
    }
  }
  return answer;
}

// The largest normal curvature towards the upward normal. It is -infinity where it does not exist or the
// normal is horizontal.
double ConcaveCurvature(const Piece& piece, double u, double v) {
  const SurfaceJet jet = Evaluate(piece, u, v);
  const auto normal = UpwardNormal(jet);
  if (!normal || normal->z() < 1e-6) return -kInfinity;
  const double k = Principal(Forms(jet, *normal)).k_max;
  return std::isfinite(k) ? k : -kInfinity;
}

struct Peak {
  double k = 0.0;
  double u = 0.0, v = 0.0;
};

// Samples the leaf at 3 x 3 places. Then shrinks a search pattern around the best sample within the leaf.
Peak LeafPeak(const Surface& surface, const SurfaceLeaf& leaf) {
  const Piece& piece = surface.piece(leaf.piece);
  Peak peak{-kInfinity, 0, 0};
  const auto consider = [&](double u, double v) {
    const double k = ConcaveCurvature(piece, u, v);
    if (k <= peak.k) return false;
    peak = {k, u, v};
    return true;
  };
  const double wu = leaf.u1 - leaf.u0, wv = leaf.v1 - leaf.v0;
  for (const double a : {0.02, 0.5, 0.98}) {
    for (const double b : {0.02, 0.5, 0.98}) consider(leaf.u0 + a * wu, leaf.v0 + b * wv);
  }
  if (!(peak.k > 0.0)) return peak;
  for (double step = 0.25; step > 0.02; step *= 0.5) {
    const Peak from = peak;
    for (const int du : {-1, 1})
      consider(std::clamp(from.u + du * step * wu, double{leaf.u0}, double{leaf.u1}), from.v);
    for (const int dv : {-1, 1})
      consider(from.u, std::clamp(from.v + dv * step * wv, double{leaf.v0}, double{leaf.v1}));
  }
  return peak;
}

}  // namespace

SurfacePoint LowestPoint(const Surface& surface, double tolerance) {
  return Extreme(surface, 2, 1.0, tolerance);
}
SurfacePoint HighestPoint(const Surface& surface, double tolerance) {
  return Extreme(surface, 2, -1.0, tolerance);
}

Box3 TightBox(const Surface& surface, double tolerance) {
  Box3 box;
  for (const int axis : {0, 1, 2}) {
    box.min[axis] = Extreme(surface, axis, 1.0, tolerance).p[axis];
    box.max[axis] = Extreme(surface, axis, -1.0, tolerance).p[axis];
  }
  return box;
}

ConcaveSpot SmallestConcaveRadius(const Surface& surface, const RunContext& run) {
  constexpr std::size_t kBlock = 256;
  const std::size_t blocks = (surface.leaves.size() + kBlock - 1) / kBlock;
  std::vector<std::pair<Peak, std::size_t>> best(blocks, {Peak{-kInfinity, 0, 0}, 0});
  const auto status = ParallelFor(run, nullptr, blocks, [&](std::size_t b) {
    for (std::size_t i = b * kBlock; i < std::min(surface.leaves.size(), (b + 1) * kBlock); ++i) {
      const Peak peak = LeafPeak(surface, surface.leaves[i]);
      if (peak.k > best[b].first.k) best[b] = {peak, i};
    }
  });
  ConcaveSpot spot;
  if (!status.ok()) return spot;
  for (const auto& [peak, leaf] : best) {
    if (peak.k > 0.0 && 1.0 / peak.k < spot.radius) {
      const PieceId id = surface.leaves[leaf].piece;
      spot = {1.0 / peak.k, {id, peak.u, peak.v, Position(surface.piece(id), peak.u, peak.v)}};
    }
  }
  return spot;
}

}  // namespace patchmill
