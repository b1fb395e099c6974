// Step-over and z-step from the scallop height ([spacing (1)-(4)]): exact two-circle form, centre spacing.
#pragma once

namespace patchmill {

// Returns the centre step w_c (mm): the distance between the CENTRES of neighbouring passes, measured on the
// centre surface across the feed, that leaves exactly the scallop s = `scallop` between them. R = `radius` is
// that of the ball plus the stock to leave; 0 < s < R, both in mm. `kappa` is the normal curvature of the
// surface across the feed, in 1/mm, > 0 where it is concave towards the tool. The surface is taken for a
// circle of radius 1 / |kappa|. Then [spacing (1)-(3)]
//   A = 1 - kappa R,  B = 1 - kappa s,  m = sqrt(2 R s - s^2),  x = |kappa| m / (2 sqrt(A B)),
//   w_c = 2 m sqrt(A / B) asin(x) / x
// The step-over along the surface, between contacts, is w_c / A. Special cases:
// - a plane, kappa = 0: 2 m, the flat step-over;
// - kappa >= 1 / R, the ball does not fit: 0;
// - x >= 1, a bore so narrow that one pass along it leaves no more than s all around: the whole circumference
//   2 pi A / kappa of the centres' circle.
double CenterStep(double radius, double scallop, double kappa);

// Returns the scallop (mm) that passes leave whose centres are `center_step` (mm) apart: the inverse of
// CenterStep [spacing (5)]. Infinity where the balls of two neighbouring passes do not meet, or meet only
// beyond the ball's own height.
double ScallopOfStep(double radius, double center_step, double kappa);

// Number of parts into which a gap between two passes is divided so that no part is wider than `need`; 1
// where the gap is narrow enough. A need below `least` is not met: the parts are then as narrow as they can
// be without being narrower than `least`. All in mm, gap and least > 0.
int PartsOfGap(double gap, double need, double least);

// A gap between two passes may exceed the step that the surface needs by this factor, and no pass is added.
// The crest is then at most 3.5 % higher than the scallop.
inline constexpr double kWideGap = 1.0175;

// Returns the factor by which all gaps of an area may exceed their needs. It is kWideGap, or less if kWideGap
// would raise the crest by more than half of `chord_tolerance` (mm) above the scallop (mm), since rest passes
// would then be needed.
double WideGap(double scallop, double chord_tolerance);

}  // namespace patchmill
