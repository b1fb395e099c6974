#include "cam/path/leftover_spots.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cam/path/chord_bounds.h"
#include "cam/path/sheet_border.h"
#include "cam/path/spacing.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/surface/net_kernel.h"

namespace patchmill {
namespace {

struct NearestMove {
  double distance = kInfinity;
  PathTree::Segment segment;
};

class SpotFinder {
 public:
  SpotFinder(const Locator& locator, const Locator& reach, const std::vector<const PathTree*>& trees,
             const CoverageParams& params)
      : surface_(locator.surface()),
        reach_(reach),
        trees_(trees),
        params_(params),
        radius_(locator.radius()),
        flat_(CenterStep(locator.radius(), params.scallop, 0.0)) {}

  void Search(const SurfaceRect& rect, std::vector<LeftoverSpot>& out) const;

 private:
  void Visit(const SurfaceRect& rect, NetShape shape, const Vec4* net, int depth,
             std::vector<LeftoverSpot>& out) const;
  NearestMove NearestTo(const Vec3& p, double limit) const;
  bool Covered(const Vec3* hull, int count, const Vec3& p) const;
  std::optional<Vec3> ReachableSide(const Vec3& p, const Vec3& e) const;
  bool OutOfReach(const SurfaceRect& rect, const Vec3& p, const Vec3& e, double size) const;

  const Surface& surface_;
  const Locator& reach_;
  const std::vector<const PathTree*>& trees_;
  const CoverageParams& params_;
  const double radius_;
  const double flat_;
};

NearestMove SpotFinder::NearestTo(const Vec3& p, double limit) const {
  NearestMove best;
  for (const PathTree* tree : trees_) {
    if (const auto n = tree->Find(p, std::min(limit, best.distance))) {
      best = {n->distance, tree->segment(n->segment)};
    }
  }
  return best;
}

bool SpotFinder::Covered(const Vec3* hull, int count, const Vec3& p) const {
  const double limit = radius_ + params_.limit;
  const NearestMove n = NearestTo(p, limit);
  if (n.distance >= limit) return false;
  for (int i = 0; i < count; ++i) {
    if (SegmentDistance(hull[i], n.segment.a, n.segment.b) > limit) return false;
  }
  return true;
}

// The normal of the side from which the point can be finished. Both sides of an upright face count.
std::optional<Vec3> SpotFinder::ReachableSide(const Vec3& p, const Vec3& e) const {
  constexpr double kUpright = 1e-6;
  for (const Vec3& n : {e, Vec3(-e)}) {
    if (n.z() < -kUpright) continue;
    const Vec3 c = p + radius_ * n;
    if (c.z() < params_.floor_z + radius_) continue;
    if (reach_.Free(c)) return n;
  }
  return std::nullopt;
}

bool SpotFinder::OutOfReach(const SurfaceRect& rect, const Vec3& p, const Vec3& e, double size) const {
  if (e.z() < 0.02) return false;  // the other side may turn up
  double turn = 0.0;
  for (double u : {rect.u0, rect.u1}) {
    for (double v : {rect.v0, rect.v1}) {
      const Vec3 n = UpwardNormalNear(surface_, {rect.piece, u, v, p});
      if (n.dot(e) < 0.3) return false;
      turn = std::max(turn, (n - e).norm());
    }
  }
  const double shift = size + 2.0 * turn * radius_;
  const Vec3 c = p + radius_ * e;
  if (c.z() + shift < params_.floor_z + radius_) return true;
  const auto h = reach_.Height(Plan(c));
  if (!h || h->z <= c.z()) return false;
  const Vec3& q = h->contact.p;
  const double distance = q.z() >= c.z() ? (Plan(q) - Plan(c)).norm() : (q - c).norm();
  return reach_.radius() - distance > shift;
}

void SpotFinder::Visit(const SurfaceRect& rect, NetShape shape, const Vec4* net, int depth,
                       std::vector<LeftoverSpot>& out) const {
  std::array<Vec3, kMaxNetPoints> hull;
  const int count = HullPoints(shape, net, hull.data());
  const double u = 0.5 * (rect.u0 + rect.u1), v = 0.5 * (rect.v0 + rect.v1);
  const Piece& piece = surface_.piece(rect.piece);
  const Vec3 p = Position(piece, u, v);
  if (Covered(hull.data(), count, p)) return;

  double size = 0.0;  // half of it: everything lies this close to p
  for (int i = 0; i < count; ++i) size = std::max(size, (hull[static_cast<std::size_t>(i)] - p).norm());
  const SurfacePoint at{rect.piece, u, v, p};
  if (size < 0.25 * flat_) {
    const Vec3 e = UpwardNormalNear(surface_, at);
    const double leftover = std::min(NearestTo(p, 2.0 * radius_).distance - radius_, radius_);
    if (leftover > params_.limit) {
      const double slope = std::acos(std::clamp(e.z(), -1.0, 1.0));
      if (slope >= params_.window.min && slope <= params_.window.max) {
        if (const auto side = ReachableSide(p, e)) {
          out.push_back({at, *side, p + radius_ * *side, leftover, rect});
          return;
        }
      }
    }
  }
  constexpr int kDeepest = 40;
  if (size < 0.05 * flat_ || depth >= kDeepest) return;
  if (size < 8.0 * flat_ && OutOfReach(rect, p, UpwardNormalNear(surface_, at), size)) return;

  const SurfaceJet jet = Evaluate(piece, u, v);
  const bool along_u = jet.du.norm() * (rect.u1 - rect.u0) >= jet.dv.norm() * (rect.v1 - rect.v0);
  std::array<Vec4, kMaxNetPoints> low, high;
  HalveNet(shape, net, along_u, low.data(), high.data());
  SurfaceRect a = rect, b = rect;
  if (along_u) {
    a.u1 = b.u0 = u;
  } else {
    a.v1 = b.v0 = v;
  }
  Visit(a, shape, low.data(), depth + 1, out);
  Visit(b, shape, high.data(), depth + 1, out);
}

void SpotFinder::Search(const SurfaceRect& rect, std::vector<LeftoverSpot>& out) const {
  const BernsteinNet& given = surface_.piece(rect.piece).net;
  const NetShape shape{given.degree_u, given.degree_v};
  std::array<Vec4, kMaxNetPoints> net;
  std::copy(given.points.begin(), given.points.end(), net.begin());
  RestrictNet(shape, net.data(), rect.u0, rect.u1, rect.v0, rect.v1);
  Visit(rect, shape, net.data(), 0, out);
}

}  // namespace

absl::StatusOr<std::vector<LeftoverSpot>> FindSpots(const Locator& locator, const Locator& reach,
                                                    const std::vector<const PathTree*>& trees,
                                                    const std::vector<SurfaceRect>& rects,
                                                    const CoverageParams& params, const RunContext& run) {
  const SpotFinder finder(locator, reach, trees, params);
  constexpr std::size_t kChunk = 32;
  const std::size_t chunks = (rects.size() + kChunk - 1) / kChunk;
  std::vector<std::vector<LeftoverSpot>> found(chunks);
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, chunks, [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min(rects.size(), (chunk + 1) * kChunk); ++i) {
      if (run.Cancelled()) return;
      finder.Search(rects[i], found[chunk]);
    }
  }));
  PM_RETURN_IF_ERROR(run.Check());
  std::vector<LeftoverSpot> spots;
  for (auto& part : found) spots.insert(spots.end(), part.begin(), part.end());
  return spots;
}

}  // namespace patchmill
