#include "core/surface/extent.h"

#include <algorithm>
#include <queue>

#include "core/base/polled_run.h"

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

}  // namespace patchmill
