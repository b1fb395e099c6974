#include "cam/region/reach/shank_finder.h"

#include <algorithm>

#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kShankMargin = 0.02;  // in R: T < B - kShankMargin R of [regions, section 6]
constexpr double kProof = 0.001;       // in R: error of distances here
constexpr int kSlideSteps = 4;         // Newton steps of each point that is tried before a search

}  // namespace

ShankFinder::ShankFinder(const Surface& surface, const ObstacleCloud& cloud, double free_radius,
                         double radius)
    : surface_(surface),
      cloud_(cloud),
      free_radius_(free_radius),
      radius_(radius),
      clear_(0.5 * (free_radius + radius)),
      proof_(kProof * radius),
      nearer_(kShankMargin * radius) {
  last_.fill(Vec3::Constant(kInfinity));
}

double ShankFinder::KnownAbove(const Vec3& center) const {
  double least = kInfinity;
  for (const Vec3& p : last_) {
    if (p.z() > center.z()) least = std::min(least, (Xy(p) - Xy(center)).squaredNorm());
  }
  return std::sqrt(least);
}

bool ShankFinder::Blocked(const Vec3& center) {
  const bool known = KnownAbove(center) < free_radius_;
  if (!known && !MayRiseAbove(surface_, center, radius_)) return false;
  const double near = known ? radius_ : NearAtMost(center, radius_);
  return ShankIsNearer(center, known, near) || BallClears(center, known ? NearAtMost(center, radius_) : near);
}

bool ShankFinder::StandsAbove(const Vec3& center) {
  const bool known = KnownAbove(center) < free_radius_;
  if (!known && !MayRiseAbove(surface_, center, free_radius_)) return false;
  const double most = free_radius_ + proof_ + nearer_;
  return ShankIsNearer(center, known, known ? most : NearAtMost(center, most));
}

bool ShankFinder::BallClears(const Vec3& center, double near) {
  const double proof = 0.1 * (radius_ - free_radius_);
  const double seen = clear_ - proof;  // a search certainly finds something that is nearer than this
  if (near < seen || SlidesNear(center, seen)) return false;
  const auto found = FirstNearPoint(surface_, center, clear_, proof);
  if (!found) return true;
  near_ = found->at.p;
  slides_[next_slide_++ % slides_.size()].emplace(surface_, found->at);
  return false;
}

bool ShankFinder::SlidesNear(const Vec3& center, double limit) {
  for (std::optional<RaySlide>& slide : slides_) {
    for (int k = 0; slide && k < kSlideSteps; ++k) {
      if ((slide->at().p - center).norm() < limit) {
        near_ = slide->at().p;
        return true;
      }
      if (slide->Step(center) < proof_) break;
    }
  }
  return false;
}

// Any known point is an upper bound for the distance of the nearest one.
double ShankFinder::NearAtMost(const Vec3& center, double most) {
  const double near = std::min(most, (near_ - center).norm());
  if (const auto point = cloud_.Nearest(center, near)) near_ = *point;
  return std::min(near, (near_ - center).norm());
}

// The condition is T < B - nearer_, with T the distance from the surface to the upward ray and B that to the
// centre. Any point above the centre is an upper bound for T, any point one for B.
bool ShankFinder::ShankIsNearer(const Vec3& center, bool known, double near) {
  double limit = free_radius_ + proof_;
  if (known) {
    const auto nearest = ClosestToPoint(surface_, center, KnownAbove(center) + nearer_, proof_);
    if (!nearest) return true;
    near = std::min(near, nearest->distance + proof_);
    near_ = nearest->at.p;
  }
  limit = std::min(limit, near - nearer_);
  if (limit <= 0.0) return false;
  const auto shank = ClosestAbove(surface_, center, limit, proof_);
  if (!shank || !(shank->at.p.z() > center.z())) return false;
  if (FirstNearPoint(surface_, center, shank->distance + nearer_, proof_)) return false;
  last_[next_++ % last_.size()] = shank->at.p;
  return true;
}

}  // namespace patchmill
