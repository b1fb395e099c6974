// Limits of reach followed from place to place by what is in the way beyond them.
#pragma once

#include <optional>
#include <vector>

#include "cam/location/ray_slide.h"
#include "cam/region/reach/reach.h"
#include "core/lines/zero_field.h"

namespace patchmill {

// Where a ball begins to be free the branch of the surface that is in its way beyond it changes little from
// one place of the limit to the next: how far it is outside the ball is a smooth function of the place, whose
// zero is found without a search of the whole surface. Where the ends of a chord lie on the zero of one
// branch, what is between is taken to do so too, which something small in between can make wrong (on bumpy
// ground 1 chord in 100: tests/bench/README.md); elsewhere a search tells whether anything else is in the
// way.
class LimitFollower {
 public:
  // Of limits on `piece`, to `exact` mm on the surface. Keeps references.
  LimitFollower(const ReachTest& reach, const Piece& piece, double exact)
      : reach_(&reach), piece_(&piece), exact_(exact) {}

  // A share t in [least, most], no farther than 1/2, of `across` (parameters) by which the middle of a chord
  // between two places of a limit lies beside it. For chords near each other, one after the other: begins
  // with what was in the way last. Nothing where no obstacle leads to a limit, and on upright ground. Cost:
  // some evaluations; a search for one ball where the chord's ends are of two branches, some more where the
  // branch is a new one.
  std::optional<double> Find(const ZeroSegment& chord, const Vec2& across, double least, double most);

 private:
  SurfaceJet At(const Vec2& at) const { return Evaluate(*piece_, at.x(), at.y()); }
  // Something in the way of a ball on the segment, to be followed from now on.
  bool FindObstacle(const Vec2& at, const Vec2& step, double least, double most);
  void Take(const SurfacePoint& obstacle);
  // One of the last obstacles that is in the way of the ball there, or null.
  RaySlide* InTheWay(const SurfaceJet& jet);
  // Both ends lie on the limit that the obstacle makes.
  bool Joins(const ZeroSegment& chord);
  struct LetGo {
    double share = 0.0;
    double rate = 0.0;  // mm a share, of the obstacle's clearance
  };
  // Where on the segment the obstacle lets go; nothing where it does not, or says little (kGrazing).
  std::optional<LetGo> FollowObstacle(const Vec2& at, const Vec2& step, double least, double most,
                                      double length);

  const ReachTest* reach_;
  const Piece* piece_;
  double exact_;
  std::optional<RaySlide> obstacle_;
  std::vector<RaySlide> before_;  // the last ones
  std::size_t next_ = 0;
};

}  // namespace patchmill
