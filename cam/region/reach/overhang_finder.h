// Decides UNDERCUT [regions U1, U2, U3] by looking for overhangs: surface above the centre of a ball that the
// ball's upward sweep would hit. The sweep is the vertical cylinder of the ball's radius from the centre up.
// It stands for the shank.
#pragma once

#include <array>
#include <optional>

#include "cam/location/ray_slide.h"
#include "cam/region/reach/obstacle_cloud.h"
#include "core/surface/surface.h"

namespace patchmill {

// Asks about balls of one size that touch the surface, one ball after the other. Order the balls so that each
// is near the last: the finder remembers where overhangs and nearest points were, and one query there often
// settles the next ball. Remembered points only save time. Each answer is proven for its own ball.
//
// In the comments below B is the distance from a ball's centre to the surface, and T the distance from the
// upward ray at the centre to the surface [regions, section 6].
class OverhangFinder {
 public:
  // The balls have the radius `radius` and touch the surface. An overhang counts if it is nearer to the axis
  // than `free_radius`. Both in mm, free_radius < radius.
  OverhangFinder(const Surface& surface, const ObstacleCloud& cloud, double free_radius, double radius);

  // For a ball that is not free, T < free_radius. Returns true if the place is UNDERCUT by U1 or U2:
  // U1: an overhang is nearer to the axis than any surface is to the centre, T < B - 0.02 radius. T and B are
  //     known to 0.001 radius.
  // U2: the ball alone, without its sweep, is free: B >= (free_radius + radius) / 2, which is R - g/2 for
  //     free_radius = R - g.
  bool IsUndercut(const Vec3& center);
  // For any ball. Returns true if U1 holds and the overhang is nearer to the axis than `free_radius`. This is
  // U3 if the ball is the smallest one and free_radius is half of its radius.
  bool HasOverhang(const Vec3& center);

 private:
  // U1. `known` says that DistanceToKnownOverhang is below the free radius. `most_b` is an upper bound for B;
  // it may be cut off at free_radius_ + proof_ + margin_, since a larger B makes no difference.
  bool OverhangIsNearer(const Vec3& center, bool known, double most_b);
  // U2. `most_b` is an upper bound for B.
  bool BallAloneIsFree(const Vec3& center, double most_b);
  // Returns an upper bound for B, mm: the distance to a known surface point, or `most` if that is less.
  double NearestAtMost(const Vec3& center, double most);
  // Tries the points that were nearest to other centres: each slides over the surface towards this centre.
  // Returns true if one of them comes nearer to the centre than `limit` (mm).
  bool SlidesNear(const Vec3& center, double limit);
  // Returns the least distance (mm, in plan) from the axis to a remembered overhang that is above `center`,
  // infinite if there is none.
  double DistanceToKnownOverhang(const Vec3& center) const;

  const Surface& surface_;
  const ObstacleCloud& cloud_;
  const double free_radius_, radius_;      // mm
  const double alone_radius_;              // mm: the limit of U2, halfway between the two radii
  const double proof_;                     // mm: error of T and B
  const double margin_;                    // mm: by this much T must be below B in U1
  Vec3 near_ = Vec3::Constant(kInfinity);  // the surface point that was last nearest to a centre
  std::array<std::optional<RaySlide>, 4>
      slides_;                     // the last nearest points that a search of the surface found
  std::array<Vec3, 8> overhangs_;  // the last overhangs found
  std::size_t next_slide_ = 0, next_overhang_ = 0;
};

}  // namespace patchmill
