// What one kind of pass can finish when it is forced upon all ground.
#pragma once

#include "cam/path/reach/cell_reach.h"
#include "core/patch/patch.h"

namespace patchmill {

enum class ForcedPasses { kNone, kContours, kLines };

struct ForcedSteps {
  ForcedPasses passes = ForcedPasses::kNone;
  double angle = 0.0;  // rad, of the lines
};

// The step these passes need at a surface point, measured as they are spaced (level heights, or offsets of
// lines in plan), as a fraction of the flat step: CenterStep across the feed times what the spacing sees of
// it ([spacing (7), (8)]: sin(slope) for levels, cos(phi) for lines). `e`: unit normal, e_z >= 0. 1 when
// nothing is forced; 0 where no step will do (level ground under contours, ground as hollow as the ball).
double NeededStep(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e, double radius,
                  double scallop);

// The wider of what the two sides of an upright face need; elsewhere NeededStep.
double NeededStepOfSides(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e, double radius,
                         double scallop);
// The limit of NeededStepOfSides for small scallops, sqrt(1 - kappa R) times what is seen ([regions (8)]): it
// is off by some scallop / radius of itself.
double NeededFineStep(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e, double radius);

// What passes leave whose step, measured as they are spaced, is `fraction` of the flat one, on the better of
// the sides of an upright face, mm: `scallop` where that step is needed, more where a shorter one is;
// infinity where no step will do.
double LeftByStep(const ForcedSteps& forced, const SurfaceJet& jet, const Vec3& e, double radius,
                  double scallop, double fraction);

// True when the needed step is below `fraction` all over the rectangle on every side of it that looks up
// somewhere, judged by nine places (second order, twice). Each side is judged by itself: where a silhouette
// crosses the rectangle, what passes need leaps from the one's curvature to the other's.
bool NeedsShorterSteps(const ForcedSteps& forced, const Surface& surface, const SurfaceRect& rect,
                       double radius, double scallop, double fraction);

}  // namespace patchmill
