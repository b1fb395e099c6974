// docs/reach.md by its words, without the floor and the limits of the operation: from plain distances.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "cam/tool/reach_give.h"
#include "core/surface/closest.h"
#include "core/surface/surface.h"

namespace patchmill::testing {

enum class Blocked { kNot, kAbove, kByItself };

// Of the ball of one radius that touches p. Distances are known to 1e-7 mm; nullopt where they are within
// what planner and verifier may be off of a limit: 0.04 of the give, 0.005 of the radius.
inline std::optional<Blocked> WhatBlocks(const Surface& surface, const Vec3& p, const Vec3& e, double radius,
                                         double give) {
  const Vec3 c = p + radius * e;
  const auto ray = ClosestToUpwardRay(surface, c, kInfinity, 1e-7),
             ball = ClosestToPoint(surface, c, kInfinity, 1e-7);
  if (!ray || !ball) return std::nullopt;
  const double free = ray->distance - (radius - give), clears = ball->distance - (radius - 0.5 * give),
               nearer = ball->distance - 0.02 * radius - ray->distance;
  if (std::abs(free) < 0.04 * give) return std::nullopt;
  if (free > 0.0) return Blocked::kNot;
  if (std::abs(nearer) < 0.005 * radius || std::abs(clears) < 0.06 * give) return std::nullopt;
  return nearer > 0.0 || clears > 0.0 ? Blocked::kAbove : Blocked::kByItself;
}

// Whether something stands above the least ball.
inline std::optional<bool> StandsAboveLeast(const Surface& surface, const Vec3& p, const Vec3& e,
                                            double give) {
  const double radius = LeastBall(give);
  const Vec3 c = p + radius * e;
  const auto ray = ClosestToUpwardRay(surface, c, kInfinity, 1e-7),
             ball = ClosestToPoint(surface, c, kInfinity, 1e-7);
  if (!ray || !ball) return std::nullopt;
  const double near = 0.5 * radius - ray->distance, nearer = ball->distance - 0.02 * radius - ray->distance;
  const double least = std::min(near, nearer);
  return std::abs(least) < 0.005 * radius ? std::nullopt : std::optional(least > 0.0);
}

// UNDERCUT is kAbove, CONCAVE kByItself.
inline std::optional<Blocked> ReachByDefinition(const Surface& surface, const Vec3& p, const Vec3& e,
                                                double radius, double give) {
  const auto tool = WhatBlocks(surface, p, e, radius, give);
  if (tool != Blocked::kByItself) return tool;
  const auto above = StandsAboveLeast(surface, p, e, give);
  if (!above) return std::nullopt;
  return *above ? Blocked::kAbove : Blocked::kByItself;
}

}  // namespace patchmill::testing
