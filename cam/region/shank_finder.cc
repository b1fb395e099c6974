#include "cam/region/shank_finder.h"

#include <algorithm>

#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kNearer = 0.02;  // of the radius: what blocks above is nearer by this (docs/reach.md)
constexpr double kProof = 0.001;  // of the radius: how exactly distances are known here

}  // namespace

ShankFinder::ShankFinder(const Surface& surface, const ObstacleCloud& cloud, double free_radius,
                         double radius)
    : surface_(surface),
      cloud_(cloud),
      free_radius_(free_radius),
      radius_(radius),
      clear_(0.5 * (free_radius + radius)),
      proof_(kProof * radius),
      nearer_(kNearer * radius) {
  last_.fill(Vec3::Constant(kInfinity));
}

double ShankFinder::KnownAbove(const Vec3& center) const {
  double least = kInfinity;
  for (const Vec3& p : last_) {
    if (p.z() > center.z()) least = std::min(least, (Plan(p) - Plan(center)).squaredNorm());
  }
  return std::sqrt(least);
}

bool ShankFinder::Blocked(const Vec3& center) {
  const bool known = KnownAbove(center) < free_radius_;
  if (!known && !MayRiseAbove(surface_, center, radius_)) return false;
  return ShankIsNearer(center, known) || BallClears(center);
}

bool ShankFinder::StandsAbove(const Vec3& center) {
  const bool known = KnownAbove(center) < free_radius_;
  return (known || MayRiseAbove(surface_, center, free_radius_)) && ShankIsNearer(center, known);
}

bool ShankFinder::BallClears(const Vec3& center) {
  const double proof = 0.1 * (radius_ - free_radius_);
  if (NearAtMost(center) < clear_ - proof) return false;  // a search is sure to see it
  const auto near = ClosestToPoint(surface_, center, clear_, proof);
  if (near) near_ = near->at.p;
  return !near;
}

// Anything known bounds how near the nearest is.
double ShankFinder::NearAtMost(const Vec3& center) {
  const double near = std::min(radius_, (near_ - center).norm());
  if (const auto point = cloud_.Nearest(center, near)) near_ = *point;
  return std::min(near, (near_ - center).norm());
}

// With T the distance from the upward ray and B that from the centre: T < B - nearer. Any point above gives
// an upper bound of T, any point one of B.
bool ShankFinder::ShankIsNearer(const Vec3& center, bool known) {
  double limit = free_radius_ + proof_;
  if (known) {
    const auto near = ClosestToPoint(surface_, center, KnownAbove(center) + nearer_, proof_);
    if (!near) return true;
    limit = std::min(limit, near->distance - nearer_ + proof_);
    near_ = near->at.p;
  } else {
    limit = std::min(limit, NearAtMost(center) - nearer_);
  }
  if (limit <= 0.0) return false;
  const auto shank = ClosestAbove(surface_, center, limit, proof_);
  if (!shank || !(shank->at.p.z() > center.z())) return false;
  if (ClosestToPoint(surface_, center, shank->distance + nearer_, proof_)) return false;
  last_[next_++ % last_.size()] = shank->at.p;
  return true;
}

}  // namespace patchmill
