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

// Returns the step these passes need at a surface point, measured as they are spaced (level heights, or
// offsets of lines in plan), as a fraction of the flat step-over. It is CenterStep across the feed times what
// the spacing sees of it ([spacing (7), (8)]: sin(slope) for levels, cos(phi) for lines). `e` is the unit
// normal, e_z >= 0. The result is 1 when nothing is forced, and 0 where no step will do (horizontal surface
// under contours, surface as concave as the ball).
double NeededStep(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e, const BallFinish& ball);

// Returns the wider of the steps that the two sides of a vertical face need; elsewhere NeededStep.
double NeededStepOfSides(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e,
                         const BallFinish& ball);
// Returns the limit of NeededStepOfSides for small scallops, sqrt(1 - kappa R) times what is seen
// ([regions (8)]). Its relative error is some scallop / radius.
double NeededFineStep(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e, double radius);

// Returns what passes leave (mm) whose step, measured as they are spaced, is `fraction` of the flat
// step-over, on the better side of a vertical face. It is `scallop` where that step suffices and more where a
// shorter one is needed; infinity where no step will do.
double LeftByStep(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e, const BallFinish& ball,
                  double fraction);

// Returns true if the needed step is below `fraction` all over the rectangle, on every side of it that looks
// up somewhere, judged by nine places (second order, twice). Each side is judged by itself: where a
// silhouette crosses the rectangle the needed step jumps from the curvature of one side to that of the other.
bool NeedsShorterSteps(const ForcedSteps& forced, const Surface& surface, const SurfaceRect& rect,
                       const BallFinish& ball, double fraction);

}  // namespace patchmill
