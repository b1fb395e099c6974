// Whether the tool can stand at a surface point, and if not, why: docs/reach.md.
#pragma once

#include <optional>

#include "cam/tool/containment.h"
#include "cam/verify/verify.h"
#include "core/surface/surface.h"

namespace patchmill {

// In the order in which they are easier to cure.
enum class ReachClass { kReachable, kUndercut, kConcave, kFloor, kAvoided };

// Where the operation allows a ball's centre. Both pointers may be null.
struct CenterLimits {
  const Containment* containment = nullptr;
  double ball = 0.0, tool = 0.0;     // mm: radius of the ball, of the wider one of ball and shank
  const Surface* avoided = nullptr;  // the avoided patches, when a margin is kept
  double avoid_distance = 0.0;       // mm: ball and margin
};

struct ReachParams {
  double radius = 0.0;          // mm: ball and stock to leave
  double tolerance = 0.0;       // mm: how deep the surface may lie inside the ball
  double floor_z = -kInfinity;  // mm: lowest centre height
  CenterLimits limits = {};
};

// Room of boundary, obstacles and top (cam/tool/containment.h): >= 0 where the centre is allowed.
double RoomAt(const CenterLimits& limits, const Vec3& center);

// Unit normal with e_z >= 0. On a vertical face both sides count and `both` is set. nullopt where the
// parametrisation is degenerate.
struct Facing {
  Vec3 e = Vec3::UnitZ();
  bool both = false;
};
std::optional<Facing> FacingAt(const SurfaceJet& jet);

// The ball centred at p + R e is free of the surface, the shank above it too, not below the floor, and
// allowed.
ReachClass ReachAt(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params);

// How far the centre may move and the point still cannot be reached: > 0 only for an unreachable point; a
// lower bound (mm).
double BlockedDepth(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params);

}  // namespace patchmill
