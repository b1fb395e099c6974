// Where an operation is wanted and where it is allowed (Selection, Obstacle, Heights on the wire):
// definitions that the planner and the judge share. Everything in the placed frame, mm.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/typed_id.h"
#include "core/math/outline.h"

namespace patchmill {

// What of the tool a boundary limits.
enum class BoundaryMode {
  kContact,  // the surface points to finish lie inside
  kCenter,   // the tool's axis stays inside
  kInside,   // the whole ball seen from above stays inside
  kOutside,  // the ball seen from above touches the inside
};

struct Boundary {
  Outline outline;
  BoundaryMode mode = BoundaryMode::kCenter;
  double offset = 0.0;  // mm, > 0 widens
};

// A prism without a lower end. Cutter and shank keep off it as one cylinder about the axis that ends at the
// tip: simpler than the ball and never too little.
struct Obstacle {
  std::string id;
  Outline outline;
  double top_z = 0.0;   // mm
  double margin = 0.0;  // mm, beside it and above it
};

// An area beside the part over which the tool's axis keeps the tip at or above a height
// (cam/plan/beside_part.h).
enum class StripKind {
  kOutside,   // outside the part: nobody asked for it
  kMaterial,  // on the back of a wall
};
struct BesideStrip {
  StripKind kind = StripKind::kOutside;
  Outline area;
  double lowest_tip_z = 0.0;  // mm: of the wall's upper edge
};

struct Containment {
  std::vector<bool> selected;  // per patch of the model; empty: all
  std::vector<bool> avoided;   // per patch of the model; empty: none. An avoided one is not wanted either
  double avoid_margin = 0.0;   // mm between the tool and avoided patches
  std::optional<Boundary> boundary;
  std::optional<double> top_z;  // highest tip of a finishing ball
  std::vector<Obstacle> obstacles;
  std::vector<BesideStrip> beside;

  bool WantsAll() const;   // every surface point is to be finished
  bool AllowsAll() const;  // no place is forbidden to the centre
};

// The patch is selected and not avoided; what a boundary leaves of it is for `IsWanted` to say.
bool IsWantedPatch(const Containment& containment, PatchId patch);

// The surface point is to be finished. `depth`: for the contact boundary alone, how far inside it must lie
// (negative: how far outside it may).
bool IsWanted(const Containment& containment, PatchId patch, const Vec3& p, double depth = 0.0);

// How far the surface around p stays outside the contact boundary, in plan; <= 0 where it may be inside.
double ContactRoomOutside(const Containment& containment, const Vec3& p);

// The ways a centre may be forbidden in closed form. Each is >= 0 where it is allowed, +infinity
// without such a limit, and has slope at most 1: within this distance the answer stays.
double BoundaryRoom(const Containment& containment, const Vec2& center, double ball_radius);
// `tool_radius`: the wider one of ball and shank.
double ObstacleRoom(const Obstacle& obstacle, const Vec3& tip, double tool_radius);
double TopRoom(const Containment& containment, double tip_z);
double StripRoom(const BesideStrip& strip, const Vec3& tip);
// The least StripRoom of all.
double BesideRoom(const Containment& containment, const Vec3& tip);

}  // namespace patchmill
