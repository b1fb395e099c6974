#include "cam/region/reach/overhang_finder.h"

#include <algorithm>

#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kOverhangMargin = 0.02;  // in R: T must be below B by this much [regions U1]
constexpr double kProof = 0.001;          // in R: error of T and B
constexpr int kSlideSteps = 4;  // Newton steps of each remembered point before the surface is searched

}  // namespace

OverhangFinder::OverhangFinder(const Surface& surface, const ObstacleCloud& cloud, double free_radius,
                               double radius)
    : surface_(surface),
      cloud_(cloud),
      free_radius_(free_radius),
      radius_(radius),
      alone_radius_(0.5 * (free_radius + radius)),
      proof_(kProof * radius),
      margin_(kOverhangMargin * radius) {
  overhangs_.fill(Vec3::Constant(kInfinity));
}

double OverhangFinder::DistanceToKnownOverhang(const Vec3& center) const {
  double least = kInfinity;
  for (const Vec3& p : overhangs_) {
    if (p.z() > center.z()) least = std::min(least, (Xy(p) - Xy(center)).squaredNorm());
  }
  return std::sqrt(least);
}

bool OverhangFinder::IsUndercut(const Vec3& center) {
  const bool known = DistanceToKnownOverhang(center) < free_radius_;
  if (!known && !MayRiseAbove(surface_, center, radius_)) return false;
  const double most_b = known ? radius_ : NearestAtMost(center, radius_);  // the ball touches: B <= R
  return OverhangIsNearer(center, known, most_b) ||
         BallAloneIsFree(center, known ? NearestAtMost(center, radius_) : most_b);
}

bool OverhangFinder::HasOverhang(const Vec3& center) {
  const bool known = DistanceToKnownOverhang(center) < free_radius_;
  if (!known && !MayRiseAbove(surface_, center, free_radius_)) return false;
  const double most = free_radius_ + proof_ + margin_;
  return OverhangIsNearer(center, known, known ? most : NearestAtMost(center, most));
}

bool OverhangFinder::BallAloneIsFree(const Vec3& center, double most_b) {
  const double proof = 0.1 * (radius_ - free_radius_);
  const double seen = alone_radius_ - proof;  // a search certainly finds a point that is nearer than this
  if (most_b < seen || SlidesNear(center, seen)) return false;
  const auto found = FirstNearPoint(surface_, center, alone_radius_, proof);
  if (!found) return true;
  near_ = found->at.p;
  slides_[next_slide_++ % slides_.size()].emplace(surface_, found->at);
  return false;
}

bool OverhangFinder::SlidesNear(const Vec3& center, double limit) {
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

// The distance to any surface point is an upper bound for B.
double OverhangFinder::NearestAtMost(const Vec3& center, double most) {
  const double near = std::min(most, (near_ - center).norm());
  if (const auto point = cloud_.Nearest(center, near)) near_ = *point;
  return std::min(near, (near_ - center).norm());
}

// The condition is T < B - margin_. Any overhang gives an upper bound for T, any surface point one for B.
bool OverhangFinder::OverhangIsNearer(const Vec3& center, bool known, double most_b) {
  double limit = free_radius_ + proof_;
  if (known) {
    const auto nearest = ClosestToPoint(surface_, center, DistanceToKnownOverhang(center) + margin_, proof_);
    if (!nearest) return true;
    most_b = std::min(most_b, nearest->distance + proof_);
    near_ = nearest->at.p;
  }
  limit = std::min(limit, most_b - margin_);
  if (limit <= 0.0) return false;
  const auto overhang = ClosestAbove(surface_, center, limit, proof_);
  if (!overhang || !(overhang->at.p.z() > center.z())) return false;
  if (FirstNearPoint(surface_, center, overhang->distance + margin_, proof_)) return false;
  overhangs_[next_overhang_++ % overhangs_.size()] = overhang->at.p;
  return true;
}

}  // namespace patchmill
