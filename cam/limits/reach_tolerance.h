// How much room a ball needs to count as free. Planner and verifier share this number [regions, section 6].
#pragma once

namespace patchmill {

// The reach tolerance, mm: half of the whole `tolerance`. The surface may lie this deep inside a ball that
// counts as free, and the floor may lift such a ball by this much above a place. It is the share of the
// tolerance that passes may use themselves. The rest belongs to rounding, certificates and the control
// (SplitBudget). If a ball could use the rest, too, places would be requested that no program could finish
// within [verification P1].
constexpr double ReachTolerance(double tolerance) { return 0.5 * tolerance; }

// Radius, mm. Smaller balls enter only, or almost only, thanks to the tolerance. No tool is recommended for a
// surface that only such balls reach. If something stands above even this ball, the surface is UNDERCUT,
// whatever blocks the tool's ball.
constexpr double SmallestBallRadius(double reach_tolerance) { return 20.0 * reach_tolerance; }

// Rounding of a highest tip that lies at the height of the surface itself, mm.
inline constexpr double kTopSlack = 1e-6;

}  // namespace patchmill
