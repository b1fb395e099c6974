#include "cam/region/reach/reach.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cam/limits/reach_tolerance.h"
#include "cam/region/reach/obstacle_finder.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"
#include "core/surface/box_distance.h"
#include "core/surface/closest.h"

namespace patchmill {

namespace {

// In radii of the smallest ball: an overhang above it counts if it is nearer to its axis [regions (7)].
constexpr double kAboveSmallestBall = 0.5;

constexpr int kMostSlides = 12;  // Newton steps of an obstacle; fewer if a step is shorter than kSlid
constexpr double kSlid = 1e-4;   // in R: after such a step the error is about the square of it
constexpr double kCloud = 0.15;  // in R: spacing of the points of the cloud

}  // namespace

ReachTest::ReachTest(const Locator& free_ball, const RegionParams& params, const RunContext& run)
    : free_ball_(free_ball), params_(params), cloud_(free_ball.surface(), kCloud * params.radius, run) {}

bool ReachTest::FreeCenter(const Vec3& center) const {
  std::optional<SurfacePoint> obstacle;
  ObstacleFinder(free_ball_, cloud_).Find({&center, 1}, {&obstacle, 1});
  return !obstacle;
}

bool ReachTest::Free(const Vec3& p, const Facing& facing) const {
  return FreeCenter(p + params_.radius * facing.e) ||
         (facing.both && FreeCenter(p - params_.radius * facing.e));
}

void ReachTest::FreeAt(std::span<const SurfaceJet> jets, std::span<double> signs,
                       std::span<std::optional<SurfacePoint>> obstacles) const {
  std::fill(signs.begin(), signs.end(), 0.0);
  std::fill(obstacles.begin(), obstacles.end(), std::nullopt);
  std::vector<std::size_t> asked;
  std::vector<Vec3> centers;
  std::vector<std::optional<SurfacePoint>> found;
  for (const double side : {1.0, -1.0}) {
    asked.clear();
    centers.clear();
    for (std::size_t i = 0; i < jets.size(); ++i) {
      const auto facing = FacingAt(jets[i]);
      if (!facing || (side < 0.0 && !(signs[i] < 0.0 && facing->both))) continue;
      asked.push_back(i);
      centers.push_back(jets[i].p + side * params_.radius * facing->e);
    }
    found.resize(centers.size());
    ObstacleFinder(free_ball_, cloud_).Find(centers, found);
    for (std::size_t k = 0; k < asked.size(); ++k) {
      signs[asked[k]] = found[k] ? -1.0 : 1.0;
      // An obstacle on one side of a wall says nothing about the ball on the other side.
      if (!obstacles.empty()) obstacles[asked[k]] = side > 0.0 ? found[k] : std::nullopt;
    }
  }
}

double ReachTest::Clearance(const Vec3& obstacle, const SurfaceJet& jet) const {
  const auto normal = UpwardNormal(jet);
  if (!normal) return -free_ball_.radius();
  return FromSet<Reach::kUpwardRay>(obstacle - (jet.p + params_.radius * *normal)).norm() -
         free_ball_.radius();
}

double ReachTest::Slide(RaySlide& obstacle, const SurfaceJet& jet) const {
  const auto normal = UpwardNormal(jet);
  if (!normal) return -free_ball_.radius();
  const Vec3 center = jet.p + params_.radius * *normal;
  for (int k = 0; k < kMostSlides && obstacle.Step(center) > kSlid * params_.radius; ++k) {
  }
  return FromSet<Reach::kUpwardRay>(obstacle.at().p - center).norm() - free_ball_.radius();
}

ReachTest::OverhangFinders ReachTest::MakeOverhangFinders() const {
  const double smallest = SmallestBallRadius(ReachTolerance(params_.tolerance));
  return {OverhangFinder(surface(), cloud_, free_ball_.radius(), params_.radius),
          OverhangFinder(surface(), cloud_, kAboveSmallestBall * smallest, smallest)};
}

bool ReachTest::BlockedAbove(const Vec3& p, const Facing& facing, OverhangFinders& finders) const {
  const double smallest = SmallestBallRadius(ReachTolerance(params_.tolerance));
  // On a vertical face the condition must hold on both sides. On one side it may hold although the place is
  // not UNDERCUT: a ball that is too large for a slot reaches through the other wall, and the material around
  // the slot then stands above its centre.
  const auto on_all_sides = [&](const auto& blocked) {
    return blocked(facing.e) && (!facing.upright || blocked(-facing.e));
  };
  return on_all_sides([&](const Vec3& e) { return finders.ball.IsUndercut(p + params_.radius * e); }) ||
         (smallest < params_.radius &&
          on_all_sides([&](const Vec3& e) { return finders.smallest.HasOverhang(p + smallest * e); }));
}

bool ReachTest::BlockedAbove(const Vec3& p, const Facing& facing) const {
  OverhangFinders finders = MakeOverhangFinders();
  return BlockedAbove(p, facing, finders);
}

void ReachTest::BlockedAboveAt(std::span<const SurfaceJet> jets, std::span<double> signs) const {
  OverhangFinders finders = MakeOverhangFinders();
  for (std::size_t i = 0; i < jets.size(); ++i) {
    const auto facing = FacingAt(jets[i]);
    signs[i] = !facing ? 0.0 : BlockedAbove(jets[i].p, *facing, finders) ? -1.0 : 1.0;
  }
}

template <class Allows>
bool ReachTest::AllowedOnASide(const Vec3& p, const Facing& facing, const Allows& allows) const {
  const Vec3 c = p + params_.radius * facing.e;
  const bool allowed = allows(c);
  if (!facing.both) return allowed;
  const Vec3 other = p - params_.radius * facing.e;
  const bool other_allowed = allows(other);
  if (allowed && other_allowed) return true;
  // A free ball on one side does not help if only the centre on the other side is allowed.
  return (allowed && FreeCenter(c)) || (other_allowed && FreeCenter(other));
}

bool ReachTest::Allowed(const Vec3& p, const Facing& facing) const {
  return params_.operation_limits == nullptr ||
         AllowedOnASide(p, facing, [&](const Vec3& c) { return params_.operation_limits->Allows(c); });
}

bool ReachTest::ForbiddenBesidePart(const Vec3& p, const Facing& facing) const {
  return params_.operation_limits != nullptr && params_.operation_limits->HasBeside() &&
         AllowedOnASide(p, facing,
                        [&](const Vec3& c) { return params_.operation_limits->AllowsBesidePart(c); });
}

bool ReachTest::BlockedByShank(const Vec3& p, const Facing& facing) const {
  return params_.operation_limits != nullptr && params_.operation_limits->HasUppers() &&
         AllowedOnASide(p, facing, [&](const Vec3& c) { return params_.operation_limits->AllowsBall(c); });
}

bool ReachTest::BlockedByHolder(const Vec3& p, const Facing& facing) const {
  return params_.operation_limits != nullptr && params_.operation_limits->HasHolder() &&
         AllowedOnASide(p, facing,
                        [&](const Vec3& c) { return params_.operation_limits->AllowsBelowHolder(c); });
}

double ReachTest::OverFloor(const Vec3& p, const Vec3& normal) const {
  return p.z() + params_.radius * (normal.z() - 1.0) - (params_.floor_z - ReachTolerance(params_.tolerance));
}

double LargestFreeRadius(const Surface& surface, const Vec3& p, const Facing& facing, double limit,
                         double reach_tolerance) {
  double largest = 0.0;
  for (const double side : {1.0, -1.0}) {
    if (side < 0.0 && !facing.both) break;
    const auto free = [&](double r) {
      return r <= reach_tolerance || !AnythingNearUpwardRay(surface, p + side * r * facing.e,
                                                            r - reach_tolerance, 0.1 * reach_tolerance);
    };
    if (free(limit)) return limit;
    double low = 0.0, high = limit;  // the sweep of a ball contains that of a smaller one [regions T14]
    for (int i = 0; i < 12; ++i) {
      const double r = 0.5 * (low + high);
      (free(r) ? low : high) = r;
    }
    largest = std::max(largest, low);
  }
  return largest;
}

}  // namespace patchmill
