// Where an operation wants the ball, and where it allows its centre: Containment against the exact surface.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "cam/limits/containment.h"
#include "cam/limits/surface_mask.h"
#include "cam/limits/wide_shank.h"
#include "cam/location/limits/mask_proximity.h"
#include "cam/location/limits/shank_limit.h"
#include "cam/location/locator.h"

namespace patchmill {

struct OperationLimitsParams {
  double ball_radius = 3.0;  // mm, the ball's own
  double tool_radius = 3.0;  // mm, the wider one of ball and shank: what obstacles are kept off
  double leave = 0.0;        // mm, stock to leave: kept off avoided patches too
  std::optional<WideShank> shank = std::nullopt;  // kept out of the surface, `leave` off it; the margin off
                                                  // avoided patches
  double tolerance = 0.01;                        // mm: moves may be off a limit by half of it
};

// Centre heights allowed in a column, mm: from `lowest` to `highest`; none where lowest is above.
struct AllowedHeights {
  double lowest = -kInfinity, highest = kInfinity;
  Vec3 normal = Vec3::UnitZ();  // of the limit at `lowest`, towards what is allowed
};

// Thread-safe. Keeps references to the surface and to the containment.
class OperationLimits {
 public:
  // Builds the avoided and the selected patches as surfaces of their own. CANCELLED and DEADLINE_EXCEEDED
  // from `run`.
  static absl::StatusOr<OperationLimits> Make(const Surface& surface, const Containment& containment,
                                              const OperationLimitsParams& params, const RunContext& run);

  // The same limits; of what is wanted only that part of the surface.
  absl::StatusOr<OperationLimits> Within(std::shared_ptr<const SurfaceMask> part,
                                         const RunContext& run) const;

  bool HasPart() const { return part_ != nullptr; }
  bool WantsAll() const { return part_ == nullptr && containment_->WantsAll(); }
  bool AllowsAll() const { return containment_->AllowsAll() && shanks_.empty(); }
  // Something is forbidden beside the part.
  bool HasBeside() const { return !containment_->beside.empty(); }
  // A shank wider than the ball may touch the surface from somewhere.
  bool HasShank() const { return !shanks_.empty(); }

  // The contact is to be finished.
  bool Wants(const SurfacePoint& contact) const;
  // Some point to be finished may lie within `distance` (mm) of the contact.
  bool WantsNear(const SurfacePoint& contact, double distance) const;
  // Proof that nothing to be finished lies within `distance` (mm) of the place c; false proves nothing. Quick
  // where few patches are selected.
  bool WantsNothingNear(const Vec3& c, double distance) const;
  // No point of a piece's parameters [u0, u1] x [v0, v1], all within `radius` (mm) of p, is to be finished.
  bool WantsNothing(PieceId piece, double u0, double u1, double v0, double v1, const Vec3& p,
                    double radius) const;

  // A finishing ball may not be centred at this height or higher: its tip would be above top_z by more than
  // rounding.
  bool TooHigh(double center_z) const;
  // A finishing ball may be centred at c.
  bool Allows(const Vec3& c) const { return AllowsBall(c) && ShankClears(c, c, 0.0); }
  // A finishing ball might be centred at c if nothing were forbidden beside the part.
  bool AllowsBesidePart(const Vec3& c) const {
    return OutlineRoom(c) >= 0.0 && !TooHigh(c.z()) && ClearOfAvoided(c, c) && ShankClears(c, c, 0.0);
  }
  // The same as if the shank were no wider than the ball.
  bool AllowsBall(const Vec3& c) const { return Room(c) >= 0.0 && ClearOfAvoided(c, c); }
  // Where in the column over q a finishing ball may be centred, to `gap` (mm); nothing outside a boundary.
  // Every limit but top_z holds from below: what is allowed is one interval. `from`: where below that (mm),
  // and below its end, it begins need not be known.
  std::optional<AllowedHeights> HeightsOver(const Vec2& q, double gap, double from = -kInfinity) const;
  // No finishing ball may be centred within `radius` (mm, >= 0) of c where that is at most `above` higher
  // than c. Flat ground is forbidden by a shank in large pieces, however little it is in its way.
  bool Forbids(const Vec3& c, double radius, double above) const;
  bool Forbids(const Vec3& c, double radius) const { return Forbids(c, radius, radius); }
  // Centre height from which on the tool may be anywhere over the rectangle with corners a and b and sides
  // along x and y, as far as obstacles, avoided patches and what lies beside the part go; some mm more where
  // obstacles have hollows.
  // -infinity: at any.
  double ClearHeight(const Vec2& a, const Vec2& b) const;
  // The centre may feed straight from a to b: every place of the move is allowed, up to half the tolerance.
  // `finishing`: top_z holds too.
  bool AllowsMove(const Vec3& a, const Vec3& b, bool finishing) const;

 private:
  OperationLimits() = default;
  Vec3 Tip(const Vec3& c) const { return c - Vec3(0.0, 0.0, params_.ball_radius); }
  double OutlineRoom(const Vec3& c) const;           // boundary and obstacles
  double MoveRoom(const Vec3& c) const;              // beside the part too
  double Room(const Vec3& c) const;                  // top_z too
  bool HasRoom(const Vec3& a, const Vec3& b) const;  // by MoveRoom
  bool ClearOfAvoided(const Vec3& a, const Vec3& b) const;
  bool ShankClears(const Vec3& a, const Vec3& b, double allowed_penetration) const;
  double LimitTolerance() const { return 0.5 * params_.tolerance; }

  const Surface* surface_ = nullptr;
  const Containment* containment_ = nullptr;
  OperationLimitsParams params_;
  std::shared_ptr<const Surface> selected_;         // when only some are
  std::shared_ptr<const Surface> avoided_;          // when a margin is kept from them
  std::shared_ptr<const Locator> avoided_locator_;  // ball and margin over avoided_
  std::vector<ShankLimit> shanks_;                  // of the surface, of what is avoided
  std::shared_ptr<const SurfaceMask> part_;         // null: all
  std::shared_ptr<const MaskProximity> mask_proximity_;
};

}  // namespace patchmill
