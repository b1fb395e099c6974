// Goals for a surface: what a place, an edge or a face should be after an edit [editing, section 7].
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

// A place of a quad moves by a distance along the surface normal, or to a point. The place is (u, v), with
// u along the side from the first vertex to the second and v away from it, or the place nearest to `near`.
struct PointGoal {
  int face = 0;
  double u = 0.5, v = 0.5;
  std::optional<Vec3> near = {};
  double distance = 0.0;        // > 0: towards the side from which the vertices run anticlockwise
  std::optional<Vec3> to = {};  // in place of `distance`
};

// An edge passes through a point.
struct EdgeGoal {
  int start = 0, end = 0;  // its vertices, in either order
  std::optional<double> parameter =
      {};  // of the curve at the point, from `start`; default: the nearest place
  Vec3 through = Vec3::Zero();
};

// How far the middle of a quad stands out from the mean of its corners, along the line to the middle of the
// Coons surface of its four edges. The Coons surface has the fullness 1 [editing (10)].
struct FullnessGoal {
  int face = 0;
  double fullness = 1.0;
};

struct Goals {
  std::vector<EdgeGoal> edges;
  std::vector<PointGoal> points;
  std::vector<FullnessGoal> fullness;
};

inline constexpr std::size_t kMaxGoals = 100;  // of one edit

// Goals that are farther from what was reached than this share of the size of their face or edge are
// reported.
inline constexpr double kReachedShare = 1e-9;

enum class GoalKind { kPoint, kEdge, kFullness, kFit };
constexpr GoalKind LastOf(GoalKind) { return GoalKind::kFit; }

// What an edit has made of a goal.
struct ReachedGoal {
  int edit = 0;  // position in the list of edits
  GoalKind kind = GoalKind::kPoint;
  int goal = 0;  // position in its list of goals
  Vec3 target = Vec3::Zero(), reached = Vec3::Zero();
  double distance = 0.0;      // between both
  Vec2 place = Vec2::Zero();  // of the face; of an edge its parameter and 0
  bool missed = false;        // beyond kReachedShare
};

}  // namespace patchmill
