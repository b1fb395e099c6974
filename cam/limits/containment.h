// Where an operation is wanted and where it is allowed (Selection, Obstacle, Heights on the wire). Planner
// and verifier share these definitions. All positions are in the placed frame, mm.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cam/limits/stock_solid.h"
#include "core/base/typed_id.h"
#include "core/math/outline.h"

namespace patchmill {

// The part of the tool that a boundary limits.
enum class BoundaryMode {
  kContact,  // the surface points to finish lie inside
  kCenter,   // the tool's axis stays inside
  kInside,   // the whole ball seen from above stays inside
  kOutside,  // the ball seen from above reaches the inside
};

struct Boundary {
  Outline outline;
  BoundaryMode mode = BoundaryMode::kCenter;
  double offset = 0.0;  // mm; > 0 widens the boundary
};

// A prism without a lower end. Cutter and shank keep off it as one cylinder around the axis that ends at the
// tip. This is simpler than the ball and never too small.
struct Obstacle {
  std::string name;  // for messages: the id in quotes, or # and the index in the request
  Outline outline;
  double top_z = 0.0;   // mm
  double margin = 0.0;  // mm, beside it and above it
  // It limits a cylinder of the holder: it is as much wider and lower as that is wider than the tool below
  // and begins higher.
  bool of_holder = false;
  // The stock in place of the outline, for a cylinder of the holder. It counts as lower by so much (mm).
  std::shared_ptr<const StockSolid> stock = nullptr;
  double lower = 0.0;
};

// An area beside the part. Over it the tool's axis keeps the tip at or above a height
// (cam/plan/beside_part.h).
enum class StripKind {
  kOutside,   // outside the part, where no cut is requested
  kMaterial,  // on the back of a wall
};
struct BesideStrip {
  StripKind kind = StripKind::kOutside;
  Outline area;
  double lowest_tip_z = 0.0;  // mm, height of the wall's upper edge
};

struct Containment {
  std::vector<bool> selected;  // index: patch of the model; empty: all patches
  std::vector<bool> avoided;   // index: patch of the model; empty: none. An avoided patch is not wanted
  double avoid_margin = 0.0;   // mm between the tool and avoided patches
  std::optional<Boundary> boundary;
  std::optional<double> top_z;  // mm, highest tip of a finishing ball
  std::vector<Obstacle> obstacles;
  std::vector<BesideStrip> beside;

  bool WantsAll() const;   // true if every surface point is to be finished
  bool AllowsAll() const;  // true if no place is forbidden to the centre
};

// True if the patch is selected and not avoided. A boundary may still exclude parts of it, see `IsWanted`.
bool IsWantedPatch(const Containment& containment, PatchId patch);

// True if the surface point is to be finished. `depth` concerns the contact boundary only: how far inside it
// the point must lie (mm; negative: how far outside it may lie).
bool IsWanted(const Containment& containment, PatchId patch, const Vec3& p, double depth = 0.0);

// The distance in plan of p outside the contact boundary; <= 0 where p may be inside.
double ContactRoomOutside(const Containment& containment, const Vec3& p);

// Limits of the centre in closed form. Each value is >= 0 where the centre is allowed and +infinity without
// such a limit. Its slope is at most 1, so within this distance the answer stays the same.
double BoundaryRoom(const Containment& containment, const Vec2& center, double ball_radius);
// `tool_radius` is the larger radius of ball and shank.
double ObstacleRoom(const Obstacle& obstacle, const Vec3& tip, double tool_radius);
// The lowest tip over q that an obstacle allows; -infinity beside it.
double LowestTipOver(const Obstacle& obstacle, const Vec2& q, double tool_radius);
double TopRoom(const Containment& containment, double tip_z);
double StripRoom(const BesideStrip& strip, const Vec3& tip);
// The smallest StripRoom of all strips.
double BesideRoom(const Containment& containment, const Vec3& tip);

}  // namespace patchmill
