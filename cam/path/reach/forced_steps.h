// What one kind of pass can finish when it is forced upon the whole surface.
#pragma once

#include "cam/path/reach/cell_reach.h"
#include "core/patch/patch.h"

namespace patchmill {

enum class ForcedPasses { kNone, kContours, kLines };

struct ForcedSteps {
  ForcedPasses passes = ForcedPasses::kNone;
  double angle = 0.0;  // rad, of the lines
};

// A ball, and the scallop that its passes may leave.
struct BallFinish {
  double radius = 0.0;   // mm, > 0
  double scallop = 0.0;  // mm, (0, radius)
};

// Returns the spacing that these passes need at a surface point, in flat step-overs. The spacing of levels is
// measured in height, that of lines in plan: it is CenterStep across the feed times sin(slope) for levels
// [spacing (7)], times cos(phi) for lines [spacing (8)], phi being the angle of the surface across the feed.
// `e` is the unit normal, e_z >= 0. The result is 1 if nothing is forced. It is 0 where no spacing is small
// enough: on a horizontal surface under contours, and where the surface is as concave as the ball.
double NeededStep(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e, const BallFinish& ball);

// Returns the wider of the steps that the two sides of a vertical face need; elsewhere NeededStep.
double NeededStepOfSides(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e,
                         const BallFinish& ball);
// Returns the limit of NeededStepOfSides for small scallops, sqrt(1 - kappa R) times what is seen
// ([regions (8)]). Its relative error is some scallop / radius.
double NeededFineStep(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e, double radius);

// Returns what passes leave (mm) whose spacing, measured as in NeededStep, is `fraction` flat step-overs. It
// is ball.scallop where that spacing suffices, more where a smaller one is needed, and infinity where none is
// small enough. On a vertical face it is the better value of the two sides.
double LeftByStep(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e, const BallFinish& ball,
                  double fraction);

// Returns true if NeededStep is below `fraction` all over the rectangle, on each side of the surface that
// looks up somewhere in it. This is judged by nine places, with twice the second-order term as margin
// (BendOver). Each side is judged by itself, because at a silhouette the needed step jumps from the curvature
// of one side to that of the other.
bool NeedsShorterSteps(const ForcedSteps& forced, const Surface& surface, const SurfaceRect& rect,
                       const BallFinish& ball, double fraction);

}  // namespace patchmill
