// The definition of reach [regions (6)] from plain distances, without the floor and the limits of the
// operation.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "cam/limits/reach_tolerance.h"
#include "core/surface/closest.h"
#include "core/surface/surface.h"

namespace patchmill::testing {

enum class Blocked { kNot, kAbove, kByItself };

// T and B of [regions, section 6], exact to 1e-7 mm.
struct BallDistances {
  double ray = 0.0, ball = 0.0;
};
inline BallDistances DistancesOf(const Surface& surface, const Vec3& c) {
  return {ClosestToUpwardRay(surface, c, kInfinity, 1e-7)->distance,
          ClosestToPoint(surface, c, kInfinity, 1e-7)->distance};
}

// Of the ball of one radius that touches p. nullopt within what planner and verifier may be off of a limit:
// 0.04 of the reach tolerance, 0.002 of the radius.
inline std::optional<Blocked> WhatBlocks(const Surface& surface, const Vec3& p, const Vec3& e, double radius,
                                         double reach_tolerance) {
  const auto [ray, ball] = DistancesOf(surface, p + radius * e);
  const double free = ray - (radius - reach_tolerance), clears = ball - (radius - 0.5 * reach_tolerance),
               nearer = ball - 0.02 * radius - ray;
  if (std::abs(free) < 0.04 * reach_tolerance) return std::nullopt;
  if (free > 0.0) return Blocked::kNot;
  if (std::abs(nearer) < 0.002 * radius || std::abs(clears) < 0.06 * reach_tolerance) return std::nullopt;
  return nearer > 0.0 || clears > 0.0 ? Blocked::kAbove : Blocked::kByItself;
}

// Whether something stands above the smallest ball.
inline std::optional<bool> StandsAboveLeast(const Surface& surface, const Vec3& p, const Vec3& e,
                                            double reach_tolerance) {
  const double radius = SmallestBallRadius(reach_tolerance);
  const auto [ray, ball] = DistancesOf(surface, p + radius * e);
  const double least = std::min(0.5 * radius - ray, ball - 0.02 * radius - ray);
  return std::abs(least) < 0.002 * radius ? std::nullopt : std::optional(least > 0.0);
}

// UNDERCUT is kAbove, CONCAVE kByItself.
inline std::optional<Blocked> ReachByDefinition(const Surface& surface, const Vec3& p, const Vec3& e,
                                                double radius, double reach_tolerance) {
  const auto tool = WhatBlocks(surface, p, e, radius, reach_tolerance);
  if (tool != Blocked::kByItself) return tool;
  const auto above = StandsAboveLeast(surface, p, e, reach_tolerance);
  if (!above) return std::nullopt;
  return *above ? Blocked::kAbove : Blocked::kByItself;
}

}  // namespace patchmill::testing
