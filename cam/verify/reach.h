// Whether the tool can stand at a surface point, and if not, why: [regions, section 6].
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "cam/limits/containment.h"
#include "cam/limits/wide_shank.h"
#include "cam/verify/verify.h"
#include "core/diffgeo/forms.h"
#include "core/surface/surface.h"

namespace patchmill {

// In the order in which they are easier to cure.
enum class ReachClass { kReachable, kUndercut, kConcave, kFloor, kAvoided, kShank, kOutside };

// Where operation and shank allow a ball's centre. Both pointers may be null.
struct CenterLimits {
  const Containment* containment = nullptr;
  double ball = 0.0, tool = 0.0;     // mm: radius of the ball, of the wider one of ball and shank
  const Surface* avoided = nullptr;  // the avoided patches, when a margin is kept
  double avoid_distance = 0.0;       // mm: ball and margin
  std::optional<WideShank> shank = std::nullopt;
  double shank_keep = 0.0;  // mm off the surface: the stock to leave; off the avoided patches: the margin
  double within = 0.0;      // mm: how far inside of all these, the shank's limit too, a centre must be
};

struct ReachParams {
  double radius = 0.0;  // mm: ball and stock to leave
  double reach_tolerance =
      0.0;  // mm: how deep the surface may lie inside the ball, and the centre below the floor
  double floor_z = -kInfinity;  // mm: lowest centre height
  CenterLimits limits = {};
};

// Room of boundary, obstacles and top (cam/limits/containment.h): >= 0 where the centre is allowed.
double RoomAt(const CenterLimits& limits, const Vec3& center);
// Room of what is forbidden beside the part.
double BesideRoomAt(const CenterLimits& limits, const Vec3& center);

// Of the top alone, for any centre at this height.
double TopRoomAt(const CenterLimits& limits, double center_z);

// Points of a surface that were in the way of ball or shank lately: mostly they are in the way of neighbours
// too, which then need no search, or a short one. Answers depend on it no more than their tolerances allow.
class Obstacles {
 public:
  struct Near {
    Vec3 at;
    double distance;
  };
  // The one nearest to the upward ray at c, if nearer than `limit`.
  std::optional<Near> NearestToRay(const Vec3& c, double limit) const;
  // The same of those above c.
  std::optional<Near> NearestAbove(const Vec3& c, double limit) const;
  // Of the one nearest to c, or `limit` where that is less.
  double DistanceTo(const Vec3& c, double limit) const;
  void Add(const Vec3& p);

 private:
  template <typename Counts>
  std::optional<Near> Nearest(const Vec3& c, double limit, const Counts& counts) const;

  static constexpr std::size_t kKept = 8;
  std::array<Vec3, kKept> kept_;
  std::size_t count_ = 0;  // of all that were added; the last kKept are kept
};

// The ball centred at p + R e is free of the surface, the shank above it too, not below the floor, allowed,
// and a wider shank is clear. `obstacles`: of this surface, with each thread its own.
ReachClass ReachAt(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params,
                   Obstacles& obstacles);
ReachClass ReachAt(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params);

// The same of a place of a piece. Ground that stands upright there (Facing::both) by no more than a line
// counts as what lies beside it, 0.02 R away (a quarter of the piece at most) in both parameters: where a
// sheet ends upright and is undercut behind its rim there is nothing to cut, though the ball touches the rim.
// What a piece shares with another counts by either.
ReachClass ReachOn(const Surface& surface, const SurfacePoint& at, const Facing& facing,
                   const ReachParams& params, Obstacles& obstacles);

// The place is to be finished: it is reachable, and not within params.give of a limit of its centre that runs
// across the ground: into a sharp corner of two no pass gets to the last. Where a limit runs along the
// ground, a wall with the boundary a radius beside it, all of it is asked for.
bool IsAskedOn(const Surface& surface, const SurfacePoint& at, const Facing& facing,
               const ReachParams& params, Obstacles& obstacles);

// How far above the ball's centre the shank would have to begin (WideShank::rise) for a point that only it
// keeps from being reached, mm; `known` where that is no more, or something else is in the way too. To
// 0.02 of params.give.
double RiseNeeded(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params,
                  double known);

// Wherever the ball is centred within `beside` (mm) of `center` in plan and no higher, the surface stands in
// the shank. Known to `proof`.
bool ShankHitsAll(const Surface& surface, const CenterLimits& limits, const Vec3& center, double beside,
                  double proof);

// How far the centre may move and the point still cannot be reached, the shank left out: > 0 only for an
// unreachable point; a lower bound (mm).
double BlockedDepth(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params,
                    Obstacles& obstacles);

}  // namespace patchmill
