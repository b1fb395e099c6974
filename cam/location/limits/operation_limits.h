// Where an operation wants the ball, and where it allows its centre. Evaluates Containment against the exact
// surface.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cam/limits/containment.h"
#include "cam/limits/surface_mask.h"
#include "cam/limits/upper_cylinders.h"
#include "cam/location/limits/mask_proximity.h"
#include "cam/location/limits/shank_limit.h"
#include "cam/location/locator.h"

namespace patchmill {

struct OperationLimitsParams {
  double ball_radius = 3.0;  // mm, radius of the ball itself
  double tool_radius = 3.0;  // mm, larger radius of ball and shank: obstacles are kept off by it
  double leave = 0.0;        // mm, stock to leave; also kept off avoided patches
  std::vector<UpperCylinder> uppers = {};  // kept `leave` off the surface, the margin off avoided patches
  double tolerance = 0.01;                 // mm; moves may violate a limit by half of it
};

// Centre heights allowed over one place, mm: from `lowest` to `highest`. There are none if lowest is above
// highest.
struct AllowedHeights {
  double lowest = -kInfinity, highest = kInfinity;
  Vec3 normal = Vec3::UnitZ();  // of the limit at `lowest`, towards the allowed side
};

// Keeps references to the surface and to the containment. Thread-safe.
class OperationLimits {
 public:
  // Builds the avoided and the selected patches as separate surfaces. CANCELLED and DEADLINE_EXCEEDED from
  // `run`.
  static absl::StatusOr<OperationLimits> Make(const Surface& surface, const Containment& containment,
                                              const OperationLimitsParams& params, const RunContext& run);

  // The same limits, but only this part of the surface is wanted.
  absl::StatusOr<OperationLimits> Within(std::shared_ptr<const SurfaceMask> part,
                                         const RunContext& run) const;

  bool HasPart() const { return part_ != nullptr; }
  bool WantsAll() const { return part_ == nullptr && containment_->WantsAll(); }
  bool AllowsAll() const { return containment_->AllowsAll() && shanks_.empty(); }
  // True if there are areas beside the part that are closed to the tool.
  bool HasBeside() const { return !containment_->beside.empty(); }
  // True if a shank wider than the ball, or the holder, may touch the surface from some centre.
  bool HasUppers() const { return !shanks_.empty() || HasHolder(); }
  // True if the holder may touch the surface or an obstacle.
  bool HasHolder() const;

  // True if the contact is to be finished.
  bool Wants(const SurfacePoint& contact) const;
  // True if some point to be finished may lie within `distance` (mm) of the contact.
  bool WantsNear(const SurfacePoint& contact, double distance) const;
  // True proves that nothing to be finished lies within `distance` (mm) of the place c; false proves nothing.
  // Fast if few patches are selected.
  bool WantsNothingNear(const Vec3& c, double distance) const;
  // True if no point of this part of middle.piece is to be finished. All these points must lie within
  // `radius` (mm) of middle.p.
  bool WantsNothing(const SurfacePoint& middle, const ParameterBox& part, double radius) const;

  // True if a finishing ball may not be centred at this height or higher, because its tip would be above
  // top_z by more than rounding.
  bool TooHigh(double center_z) const;
  // True if a finishing ball may be centred at c.
  bool Allows(const Vec3& c) const {
    return Room(c) >= 0.0 && ClearOfAvoided(c, c) && ShankClears(c, c, 0.0);
  }
  // As Allows, but without the limits beside the part.
  bool AllowsBesidePart(const Vec3& c) const {
    return OutlineRoom(c) >= 0.0 && !TooHigh(c.z()) && ClearOfAvoided(c, c) && ShankClears(c, c, 0.0);
  }
  // As Allows, for a shank that is no wider than the ball, without a holder.
  bool AllowsBall(const Vec3& c) const { return Room(c, UpperPart::kShank) >= 0.0 && ClearOfAvoided(c, c); }
  // As Allows, without a holder.
  bool AllowsBelowHolder(const Vec3& c) const;
  // The heights over q at which a finishing ball may be centred, to `gap` (mm). nullopt outside a boundary.
  // Every limit but top_z holds from below, so the allowed heights are one interval. If it begins below
  // `from` (mm) and below its own end, its beginning need not be exact.
  std::optional<AllowedHeights> HeightsOver(const Vec2& q, double gap, double from = -kInfinity) const;
  // True if no finishing ball may be centred within `radius` (mm, >= 0) of c at places at most `above` higher
  // than c. On a flat surface a shank forbids large areas even if it is only slightly in the way.
  bool Forbids(const Vec3& c, double radius, double above) const;
  bool Forbids(const Vec3& c, double radius) const { return Forbids(c, radius, radius); }
  // Returns the height of the centre (mm) from which on the tool may be anywhere over a rectangle in plan
  // with opposite corners a and b and sides along x and y. Obstacles, avoided patches and the areas beside
  // the part count. It may be some mm too high where the outline of an obstacle is hollow. -infinity: any
  // height is allowed.
  double ClearHeight(const Vec2& a, const Vec2& b) const;
  // True if the centre may feed straight from a to b: every place of the move is allowed, up to half the
  // tolerance. With `finishing`, top_z holds, too.
  bool AllowsMove(const Vec3& a, const Vec3& b, bool finishing) const;

 private:
  OperationLimits() = default;
  Vec3 Tip(const Vec3& c) const { return c - Vec3(0.0, 0.0, params_.ball_radius); }
  // Room (containment.h, mm) of the centre c inside boundary and obstacles. MoveRoom: the areas beside the
  // part, too. Room: top_z, too.
  // Obstacles limit the holder, too, unless `part` is the shank.
  double OutlineRoom(const Vec3& c, UpperPart part = UpperPart::kHolder) const;
  double MoveRoom(const Vec3& c, UpperPart part = UpperPart::kHolder) const;
  double Room(const Vec3& c, UpperPart part = UpperPart::kHolder) const;
  bool HasRoom(const Vec3& a, const Vec3& b) const;  // all along the move a b, by MoveRoom
  bool ClearOfAvoided(const Vec3& a, const Vec3& b) const;
  bool ShankClears(const Vec3& a, const Vec3& b, double allowed_penetration) const;
  double LimitTolerance() const { return 0.5 * params_.tolerance; }

  const Surface* surface_ = nullptr;
  const Containment* containment_ = nullptr;
  OperationLimitsParams params_;
  std::shared_ptr<const Surface> selected_;         // if only some patches are selected
  std::shared_ptr<const Surface> avoided_;          // if a margin is kept from them
  std::shared_ptr<const Locator> avoided_locator_;  // for ball and margin, over avoided_
  std::vector<ShankLimit> shanks_;                  // of the surface and the avoided patches; holder last
  std::shared_ptr<const SurfaceMask> part_;         // null: the whole surface
  std::shared_ptr<const MaskProximity> mask_proximity_;
};

}  // namespace patchmill
