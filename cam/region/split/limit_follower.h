// Follows a limit of reach from place to place by means of the obstacle that blocks the ball beyond it.
#pragma once

#include <optional>
#include <vector>

#include "cam/location/ray_slide.h"
#include "cam/region/reach/reach.h"
#include "core/lines/zero_field.h"

namespace patchmill {

// A limit of reach divides places where the ball that touches them is free from places where it is not.
// Beyond the limit one branch of the surface blocks the ball. Along the limit this is mostly the same branch.
// Its clearance (ReachTest::Slide) is a smooth function of the touched place, so its zero, the limit, is
// found without a search of the whole surface.
//
// A chord of the limit is refined as follows. If the clearance of one branch is zero at both ends of the
// chord, the arc between them is assumed to be the zero of that branch. A small obstacle between the ends can
// make this wrong (for 1 chord in 100 on a bumpy surface). Otherwise a search decides whether another branch
// blocks the ball.
class LimitFollower {
 public:
  // Follows limits on `piece` to `exact` mm on the surface. Keeps references.
  LimitFollower(const ReachTest& reach, const Piece& piece, double exact)
      : reach_(&reach), piece_(&piece), exact_(exact) {}

  // Finds the limit beside the middle m of a chord whose ends lie on the limit. Returns t such that m + t *
  // across (in parameters) lies on the limit, with t in [least, most] and |t| <= 1/2. It begins with the
  // obstacle of the last call, so each chord should be near the last one. nullopt if no obstacle leads to a
  // limit, or on a vertical face with two sides. Cost: some evaluations of the surface; one search more if
  // the ends of the chord belong to two branches; some searches if the branch is a new one.
  std::optional<double> Find(const ZeroSegment& chord, const Vec2& across, double least, double most);

 private:
  SurfaceJet At(const Vec2& at) const { return Evaluate(*piece_, at.x(), at.y()); }
  // Looks for an obstacle of a ball that touches the segment, and follows it from now on. False if there is
  // none.
  bool FindObstacle(const Vec2& at, const Vec2& step, double least, double most);
  void Take(const SurfacePoint& obstacle);
  // One of the last obstacles, if it is in the way of the ball there, or null.
  RaySlide* InTheWay(const SurfaceJet& jet);
  // True if both ends of the chord lie on the limit that the current obstacle makes.
  bool Joins(const ZeroSegment& chord);
  struct LetGo {
    double share = 0.0;
    double rate = 0.0;  // mm per share, change of the obstacle's clearance
  };
  // Returns the share of the segment at which the current obstacle ceases to block the ball. nullopt if there
  // is no such place, or if it is ill-conditioned (kGrazing).
  std::optional<LetGo> FollowObstacle(const Vec2& at, const Vec2& step, double least, double most,
                                      double length);

  const ReachTest* reach_;
  const Piece* piece_;
  double exact_;
  std::optional<RaySlide> obstacle_;
  std::vector<RaySlide> before_;  // the last obstacles before it
  std::size_t next_ = 0;
};

}  // namespace patchmill
