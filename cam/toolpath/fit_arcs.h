// Replaces many short moves by few long ones: arcs, and straight moves [linking, section 7].
#pragma once

#include <vector>

#include "cam/toolpath/toolpath.h"
#include "core/base/enum_array.h"

namespace patchmill {

// What arcs a control takes, and how far the path may change.
struct ArcFit {
  MoveKind kind = MoveKind::kCut;  // of the moves that become arcs; never kRapid
  // mm, > 0. The distance between the old and the new path is at most this, at any place of either: both are
  // followed side by side, and chords count with their own distance from the arc.
  double budget = 0.0;
  // mm, 0 to budget. At the ends of the old moves the new path is at most this much nearer to their contacts.
  double into_surface = 0.0;
  EnumArray<ArcPlane, bool> planes{};      // in which arcs may lie
  bool helices = true;                     // arcs may move along the third axis
  double largest_radius = 1000.0;          // mm
  std::vector<bool> straight_passes = {};  // by Move::pass: moves of these passes stay as they are
  // mm/min: a faster feed descends at most as steep as plunge_angle, anywhere on an arc.
  double plunge_feed = 0.0;
  double lowest = -kInfinity;            // mm: an upright arc stays above this centre height by kAboveLowest
  double plunge_angle = Radians(30.25);  // rad; a little above the steepest of the moves themselves
};

inline constexpr double kLeastArcRadius = 0.05;  // mm; smaller arcs stay straight moves
inline constexpr double kAboveLowest = 2e-3;     // mm; rounding to three decimals lowers an arc by less

// Returns the same toolpath with fewer moves. Neighbouring moves of fit.kind with the same feed, pass and
// region become one move, an arc or a straight one, where that keeps within `fit`. The search is greedy:
// the longest move from the end of the last one, straight if both reach as far. Arcs turn by at most 180
// degrees. A closed pass on a circle becomes one full circle. The first and the last place of such moves
// stay, and so does every other move. Cost O(n log n).
Toolpath FitArcs(Toolpath toolpath, const ArcFit& fit);

}  // namespace patchmill
