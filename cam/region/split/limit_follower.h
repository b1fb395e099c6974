// Follows limits of reach from place to place by the obstacle that is in the way beyond them.
#pragma once

#include <optional>
#include <vector>

#include "cam/location/ray_slide.h"
#include "cam/region/reach/reach.h"
#include "core/lines/zero_field.h"

namespace patchmill {

// On a limit of reach the ball begins to be free. The branch of the surface that is in its way beyond the
// limit changes little from one place of the limit to the next. The clearance of this branch is a smooth
// function of the place, so its zero is found without a search of the whole surface. If both ends of a chord
// lie on the zero of one branch, the arc between them is taken to lie there, too. Something small in between
// can make this wrong (for 1 chord in 100 on a bumpy surface). Otherwise a search decides whether anything
// else is in the way.
class LimitFollower {
 public:
  // Follows limits on `piece` to `exact` mm on the surface. Keeps references.
  LimitFollower(const ReachTest& reach, const Piece& piece, double exact)
      : reach_(&reach), piece_(&piece), exact_(exact) {}

  // Finds the limit beside the middle of a chord whose ends lie on the limit. Returns the share t of `across`
  // (in parameters) from the middle of the chord to the limit, with t in [least, most] and |t| <= 1/2. Use it
  // for chords near each other, one after the other, because it begins with the last obstacle. nullopt if no
  // obstacle leads to a limit, or on a vertical face with two sides. Cost: some evaluations; a search for one
  // ball if the chord's ends belong to two branches, some more if the branch is a new one.
  std::optional<double> Find(const ZeroSegment& chord, const Vec2& across, double least, double most);

 private:
  SurfaceJet At(const Vec2& at) const { return Evaluate(*piece_, at.x(), at.y()); }
  // Finds something in the way of a ball on the segment and follows it from now on. False if there is
  // nothing.
  bool FindObstacle(const Vec2& at, const Vec2& step, double least, double most);
  void Take(const SurfacePoint& obstacle);
  // One of the last obstacles, if it is in the way of the ball there, or null.
  RaySlide* InTheWay(const SurfaceJet& jet);
  // True if both ends lie on the limit of the current obstacle.
  bool Joins(const ZeroSegment& chord);
  struct LetGo {
    double share = 0.0;
    double rate = 0.0;  // mm per share, change of the obstacle's clearance
  };
  // Where on the segment the obstacle lets the ball go. nullopt if it does not, or if the place is
  // ill-conditioned (kGrazing).
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
