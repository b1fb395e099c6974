// Step-over and z-step from the scallop height ([spacing (1)-(4)]): exact two-circle form, centre spacing.
#pragma once

namespace patchmill {

// Distance between neighbouring CENTRES, measured on the centre surface across the feed, that leaves exactly
// `scallop` (mm) between two passes of a ball of `radius` (mm) on a surface of normal curvature `kappa`
// across the feed (1/mm, > 0 concave towards the tool).
//   cos(w kappa / 2) = [(rho +- R)^2 + (rho +- s)^2 - R^2] / [2 (rho +- R)(rho +- s)],
//   w_c = w |rho +- R| / rho
// kappa -> 0: 2 sqrt(2 R s - s^2). kappa >= 1/R (the ball does not fit): 0. 0 < scallop < radius.
double CenterStep(double radius, double scallop, double kappa);

// The scallop that a given centre step leaves: the inverse of CenterStep. Infinity where the two balls do not
// meet (or meet only beyond the ball's own height).
double ScallopOfStep(double radius, double center_step, double kappa);

// Number of parts into which a gap between two passes is divided so that no part is wider than `need`; 1
// where the gap is narrow enough. A need below `least` is not met: the parts are then as narrow as they can
// be without being narrower than `least`. All in mm, gap and least > 0.
int PartsOfGap(double gap, double need, double least);

// A gap that exceeds its need by less than this factor leaves at most 3.5 % more than the scallop. No pass is
// added for that.
inline constexpr double kWideGap = 1.0175;

// Factor by which gaps may exceed their needs throughout: kWideGap, or less where kWideGap would leave more
// than half the chord tolerance (mm) above the scallop and so begin to cost rest passes.
double WideGap(double scallop, double chord_tolerance);

}  // namespace patchmill
