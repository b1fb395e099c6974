// Tests whether the tool can reach a surface point, and finds the reason if it cannot [regions, section 6].
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "cam/limits/containment.h"
#include "cam/limits/upper_cylinders.h"
#include "cam/verify/verify.h"
#include "core/diffgeo/forms.h"
#include "core/surface/surface.h"

namespace patchmill {

// kReachable, then the reasons in the order in which they become easier to cure.
enum class ReachClass { kReachable, kUndercut, kConcave, kFloor, kAvoided, kShank, kHolder, kOutside };

// The limits of a ball's centre by operation, shank and holder. Both pointers may be null.
struct CenterLimits {
  const Containment* containment = nullptr;
  double ball = 0.0, tool = 0.0;               // mm, radius of the ball, larger radius of ball and shank
  const Surface* avoided = nullptr;            // the avoided patches if a margin is kept from them
  double avoid_distance = 0.0;                 // mm, ball radius + margin
  std::span<const UpperCylinder> uppers = {};  // UpperCylindersOf the tool
  // mm between these and the surface (stock to leave). Their margin to avoided patches follows from
  // avoid_distance.
  double upper_keep = 0.0;
  // mm: so far inside of all these limits, the cylinders' too, a centre must be. Negative: so far outside
  // it may be.
  double within = 0.0;
};

struct ReachParams {
  double radius = 0.0;  // mm, ball + stock to leave
  // mm: so deep may the surface lie inside a ball that counts as free, and a centre below the lowest one.
  double reach_tolerance = 0.0;
  double floor_z = -kInfinity;  // mm, lowest centre height
  CenterLimits limits = {};
};

// Returns the room (mm) of the centre inside boundary, obstacles and top: >= 0 where these allow the centre.
// Its slope is at most 1, so within this distance the answer stays the same (cam/limits/containment.h).
// Obstacles limit the holder only if limits.uppers has its cylinders.
double RoomAt(const CenterLimits& limits, const Vec3& center);
// The same for the areas beside the part that are closed to the tool.
double BesideRoomAt(const CenterLimits& limits, const Vec3& center);

// The same for the top alone: the room (mm) of any centre at the height `center_z`.
double TopRoomAt(const CenterLimits& limits, double center_z);

// Remembers the surface points that were last found in the way of a ball, its upward sweep or the shank.
// Mostly they are in the way at neighbouring places, too, where they replace or shorten a search. Within the
// tolerance of an answer, the answer may depend on what is remembered.
class Obstacles {
 public:
  struct Near {
    Vec3 at;
    double distance;
  };
  // Returns the remembered point nearest to the upward ray at c, with its distance (mm); nullopt if none is
  // nearer than `limit` (mm).
  std::optional<Near> NearestToRay(const Vec3& c, double limit) const;
  // The same, but only points above c count (overhangs).
  std::optional<Near> NearestAbove(const Vec3& c, double limit) const;
  // Returns the distance (mm) from c to the nearest remembered point, or `limit` if that is less.
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
// allowed, and a wider shank and the holder are clear; else the reason. If `facing` has two sides, one
// reachable side is enough. `obstacles` belong to this surface; each thread needs its own.
ReachClass ReachAt(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params,
                   Obstacles& obstacles);
ReachClass ReachAt(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params);

// The same for a place of a piece. A place with two sides (Facing::both) counts as reachable only if another
// place beside it is reachable, 0.02 R away along both parameters (at most a quarter of the piece). Otherwise
// it gets the reason of the surface beside it. This matters where the surface is vertical along a line only,
// such as the rim of a sheet that ends vertically and is undercut behind its rim: the ball touches the rim,
// but there is nothing to cut. A point that two pieces share may get different answers from them.
ReachClass ReachOn(const Surface& surface, const SurfacePoint& at, const Facing& facing,
                   const ReachParams& params, Obstacles& obstacles);

// True if the place must be finished. It must be reachable, and its centre may not be within
// params.reach_tolerance of a limit of the operation, because no pass gets to the end of a sharp corner
// between two limits. There is an exception: if a limit runs along the surface, such as a boundary one radius
// beside a wall, so that all places beside this one are reachable, it must be finished, too.
bool IsRequiredOn(const Surface& surface, const SurfacePoint& at, const Facing& facing,
                  const ReachParams& params, Obstacles& obstacles);

// The least distance by which the cylinders of a part of the tool must begin higher.
struct PartRaise {
  UpperPart part = UpperPart::kShank;
  double by = 0.0;  // mm
};

// For a point that only `known.part` makes unreachable: returns the least distance (mm) by which the
// cylinders of the part must begin higher so that the point becomes reachable. Returns `known.by` if the
// distance is no more than that, or if something else blocks the ball, too. Exact to 0.02 of
// params.reach_tolerance.
double RaiseNeeded(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params,
                   const PartRaise& known);

// The lowest part of the tool above the ball that hits the surface (or an avoided patch with its margin) for
// every centre that is no higher than `center` and within `beside` (mm) of it in plan; nullopt if none does.
// Exact to `proof` (mm).
std::optional<UpperPart> UpperPartHitsAll(const Surface& surface, const CenterLimits& limits,
                                          const Vec3& center, double beside, double proof);

// Returns a distance (mm): if the centre moves by less, the ball stays blocked. A lower bound, by what blocks
// the ball most: the surface, the floor or a limit of the operation. The shank does not count. > 0 only for
// an unreachable point.
double BlockedDepth(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params,
                    Obstacles& obstacles);

}  // namespace patchmill
