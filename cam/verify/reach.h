// Tests whether the tool can reach a surface point, and finds the reason if it cannot [regions, section 6].
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

// kReachable, then the reasons in the order in which they become easier to cure.
enum class ReachClass { kReachable, kUndercut, kConcave, kFloor, kAvoided, kShank, kOutside };

// The limits of a ball's centre by operation and shank. Both pointers may be null.
struct CenterLimits {
  const Containment* containment = nullptr;
  double ball = 0.0, tool = 0.0;     // mm, radius of the ball, larger radius of ball and shank
  const Surface* avoided = nullptr;  // the avoided patches if a margin is kept from them
  double avoid_distance = 0.0;       // mm, ball radius + margin
  std::optional<WideShank> shank = std::nullopt;
  double shank_keep = 0.0;  // mm between shank and surface (stock to leave); the margin to avoided patches
                            // follows from avoid_distance
  double within = 0.0;      // mm; how far inside of all these limits, the shank's too, a centre must be
};

struct ReachParams {
  double radius = 0.0;  // mm, ball + stock to leave
  double reach_tolerance =
      0.0;  // mm; how deep the surface may lie inside the ball, and the centre below the floor
  double floor_z = -kInfinity;  // mm, lowest centre height
  CenterLimits limits = {};
};

// Room inside boundary, obstacles and top (cam/limits/containment.h), mm: >= 0 where the centre is allowed.
double RoomAt(const CenterLimits& limits, const Vec3& center);
// Room to the areas that are forbidden beside the part, mm.
double BesideRoomAt(const CenterLimits& limits, const Vec3& center);

// Room below the top alone, for any centre at this height, mm.
double TopRoomAt(const CenterLimits& limits, double center_z);

// The points of a surface that were in the way of ball or shank lately. Mostly they are in the way at
// neighbouring places, too, which then need no search or a short one. Answers depend on them only within
// their tolerances.
class Obstacles {
 public:
  struct Near {
    Vec3 at;
    double distance;
  };
  // The point nearest to the upward ray at c; nullopt if none is nearer than `limit`.
  std::optional<Near> NearestToRay(const Vec3& c, double limit) const;
  // The same for the points above c.
  std::optional<Near> NearestAbove(const Vec3& c, double limit) const;
  // Distance from c to the nearest point; at most `limit`.
  double DistanceTo(const Vec3& c, double limit) const;
  void Add(const Vec3& p);

 private:
  template <typename Counts>
  std::optional<Near> Nearest(const Vec3& c, double limit, const Counts& counts) const;

  static constexpr std::size_t kKept = 8;  // points
  std::array<Vec3, kKept> kept_;
  std::size_t count_ = 0;  // number of points ever added; the last kKept of them are kept
};

// kReachable if the ball at p + R e and its upward sweep are free of the surface, not below the floor and
// allowed, and a wider shank is clear; else the reason. If `facing` has two sides, one reachable side is
// enough. `obstacles` belong to this surface; each thread needs its own.
ReachClass ReachAt(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params,
                   Obstacles& obstacles);
ReachClass ReachAt(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params);

// The same for a place of a piece. A place with two sides (Facing::both) counts as reachable only if a place
// beside it does, 0.02 R away in both parameters (but at most a quarter of the piece). So a place that is
// vertical only along a line gets the reason of the surface beside it. Where a sheet ends vertically and is
// undercut behind its rim, there is nothing to cut, although the ball touches the rim. A point that two
// pieces share may get different answers from them.
ReachClass ReachOn(const Surface& surface, const SurfacePoint& at, const Facing& facing,
                   const ReachParams& params, Obstacles& obstacles);

// True if the place must be finished: it is reachable, and its centre is not within params.reach_tolerance of
// a limit that crosses the surface. No pass gets to the end of a sharp corner between two limits. If a limit
// runs along the surface, such as a boundary one radius beside a wall, the whole surface along it must be
// finished.
bool IsAskedOn(const Surface& surface, const SurfacePoint& at, const Facing& facing,
               const ReachParams& params, Obstacles& obstacles);

// How far above the ball's centre the shank would have to begin (WideShank::rise) to make a point reachable
// that only the shank blocks, mm. `known` if this is not more than `known`, or if something else is in the
// way, too. Exact to 0.02 of params.reach_tolerance.
double RiseNeeded(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params,
                  double known);

// True if the surface stands in the shank for each centre within `beside` (mm) of `center` in plan that is no
// higher than it. Exact to `proof` (mm).
bool ShankHitsAll(const Surface& surface, const CenterLimits& limits, const Vec3& center, double beside,
                  double proof);

// A lower bound for how far the centre may move without the point becoming reachable, mm. The shank does not
// count. It is > 0 only for an unreachable point.
double BlockedDepth(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params,
                    Obstacles& obstacles);

}  // namespace patchmill
