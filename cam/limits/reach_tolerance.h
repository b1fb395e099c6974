// How much room a ball needs to count as free: the one number that planner and verifier share
// [regions, section 6].
#pragma once

namespace patchmill {

// How far, mm, the surface may lie inside a ball that counts as free, and how far the ball may have to be
// above a place to keep to the floor, of a whole `tolerance`: what passes may take of it themselves. The rest
// belongs to rounding, certificates and the control (SplitBudget): a place that lets the ball in by that
// alone would be asked for, and no program could finish it within [verification P1].
constexpr double ReachTolerance(double tolerance) { return 0.5 * tolerance; }

// mm, radius: smaller balls get in by the tolerance alone, or nearly so. No tool is named for ground that
// only they reach; and where something stands above this one, ground is UNDERCUT, whatever keeps the tool's
// ball.
constexpr double SmallestBallRadius(double reach_tolerance) { return 20.0 * reach_tolerance; }

// mm: rounding of a highest tip at the surface itself.
inline constexpr double kTopSlack = 1e-6;

}  // namespace patchmill
