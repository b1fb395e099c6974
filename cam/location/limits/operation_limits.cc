#include "cam/location/limits/operation_limits.h"

#include <algorithm>

#include "cam/limits/reach_tolerance.h"
#include "core/base/status.h"
#include "core/surface/closest.h"
#include "core/surface/part.h"

namespace patchmill {
namespace {

// Shares of the tolerance: accuracy of the shank, as in the verifier, and its accuracy for moves that climb
// or fall.
constexpr double kShankProof = 0.01, kShankSlope = 0.1;

bool Any(const std::vector<bool>& list) { return std::find(list.begin(), list.end(), true) != list.end(); }

}  // namespace

absl::StatusOr<OperationLimits> OperationLimits::Make(const Surface& surface, const Containment& containment,
                                                      const OperationLimitsParams& params,
                                                      const RunContext& run) {
  OperationLimits keep;
  keep.surface_ = &surface;
  keep.containment_ = &containment;
  keep.params_ = params;
  std::vector<bool> wanted(surface.network.model.patches.size(), true);
  for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = IsWantedPatch(containment, PatchId(i));
  if (Any(wanted) && std::find(wanted.begin(), wanted.end(), false) != wanted.end()) {
    PM_ASSIGN_OR_RETURN(Surface part, PartOf(surface, wanted, run));
    keep.selected_ = std::make_shared<const Surface>(std::move(part));
  }
  if (Any(containment.avoided) && containment.avoid_margin > params.leave) {
    PM_ASSIGN_OR_RETURN(Surface part, PartOf(surface, containment.avoided, run));
    keep.avoided_ = std::make_shared<const Surface>(std::move(part));
    PM_ASSIGN_OR_RETURN(Locator locator,
                        Locator::Make(*keep.avoided_, params.ball_radius + containment.avoid_margin, run));
    keep.avoided_locator_ = std::make_shared<const Locator>(std::move(locator));
  }
  for (const UpperCylinder& cylinder : params.uppers) {
    const auto add = [&](const Surface& off, double distance) {
      const ShankLimit limit(off, cylinder, distance, kShankProof * params.tolerance,
                             kShankSlope * params.tolerance);
      // The ball's centre is never below the lowest point that the ball touches.
      if (limit.MayTouch(surface.box.min.z())) keep.shanks_.push_back(limit);
    };
    add(surface, params.leave);
    if (keep.avoided_) add(*keep.avoided_, containment.avoid_margin);
  }
  return keep;
}

absl::StatusOr<OperationLimits> OperationLimits::Within(std::shared_ptr<const SurfaceMask> part,
                                                        const RunContext& run) const {
  OperationLimits keep = *this;
  PM_ASSIGN_OR_RETURN(MaskProximity near, MaskProximity::Make(*surface_, *part, run));
  keep.mask_proximity_ = std::make_shared<const MaskProximity>(std::move(near));
  keep.part_ = std::move(part);
  return keep;
}

bool OperationLimits::Wants(const SurfacePoint& contact) const {
  if (part_ != nullptr && !part_->Has(contact.piece, contact.u, contact.v)) return false;
  return IsWanted(*containment_, surface_->piece(contact.piece).patch, contact.p);
}

bool OperationLimits::WantsNear(const SurfacePoint& contact, double distance) const {
  if (part_ != nullptr && !part_->Has(contact.piece, contact.u, contact.v) &&
      !mask_proximity_->Within(contact.p, distance)) {
    return false;
  }
  const PatchId patch = surface_->piece(contact.piece).patch;
  if (IsWanted(*containment_, patch, contact.p, -distance)) return true;
  if (ContactRoomOutside(*containment_, contact.p) > distance) return false;
  return selected_ != nullptr && ClosestToPoint(*selected_, contact.p, distance, 0.01 * distance).has_value();
}

bool OperationLimits::WantsNothingNear(const Vec3& c, double distance) const {
  if (ContactRoomOutside(*containment_, c) > distance) return true;
  return selected_ != nullptr && !ClosestToPoint(*selected_, c, 1.01 * distance, 0.01 * distance);
}

bool OperationLimits::WantsNothing(const SurfacePoint& middle, const ParameterBox& part,
                                   double radius) const {
  const auto& [u0, u1, v0, v1] = part;
  if (part_ != nullptr && !part_->HasAny(middle.piece, u0, u1, v0, v1)) return true;
  return !IsWanted(*containment_, surface_->piece(middle.piece).patch, middle.p, -radius);
}

bool OperationLimits::HasHolder() const {
  return (!shanks_.empty() && shanks_.back().part() == UpperPart::kHolder) ||
         std::any_of(containment_->obstacles.begin(), containment_->obstacles.end(),
                     [](const Obstacle& o) { return o.of_holder; });
}

double OperationLimits::OutlineRoom(const Vec3& c, UpperPart part) const {
  double room = BoundaryRoom(*containment_, Xy(c), params_.ball_radius);
  for (const Obstacle& o : containment_->obstacles) {
    if (o.of_holder && part == UpperPart::kShank) continue;
    room = std::min(room, ObstacleRoom(o, Tip(c), params_.tool_radius));
  }
  return room;
}

double OperationLimits::MoveRoom(const Vec3& c, UpperPart part) const {
  return std::min(OutlineRoom(c, part), BesideRoom(*containment_, Tip(c)));
}

bool OperationLimits::TooHigh(double center_z) const {
  return TopRoom(*containment_, center_z - params_.ball_radius) < -kTopSlack;
}

double OperationLimits::Room(const Vec3& c, UpperPart part) const {
  return std::min(MoveRoom(c, part), TopRoom(*containment_, Tip(c).z()) + kTopSlack);
}

std::optional<AllowedHeights> OperationLimits::HeightsOver(const Vec2& q, double gap, double from) const {
  const double r = params_.ball_radius;
  if (BoundaryRoom(*containment_, q, r) < 0.0) return std::nullopt;
  AllowedHeights heights;
  if (containment_->top_z) heights.highest = *containment_->top_z + r;
  for (const Obstacle& o : containment_->obstacles) {
    heights.lowest = std::max(heights.lowest, LowestTipOver(o, q, params_.tool_radius) + r);
  }
  for (const BesideStrip& strip : containment_->beside) {
    if (StripRoom(strip, Lift(q, -kInfinity)) < 0.0)
      heights.lowest = std::max(heights.lowest, strip.lowest_tip_z + r);
  }
  if (avoided_locator_) {
    const auto height = avoided_locator_->Height(q, nullptr, gap);
    if (height && height->z > heights.lowest) {
      heights.lowest = height->z;
      heights.normal = (Lift(q, height->z) - height->contact.p) / avoided_locator_->radius();
    }
  }
  for (const ShankLimit& shank : shanks_) {
    const double lowest =
        shank.LowestOver(q, 0.0, std::max(std::min(from, heights.highest), heights.lowest), gap);
    if (lowest <= heights.lowest) continue;
    heights.lowest = lowest;
    heights.normal = Vec3::UnitZ();
  }
  return heights;
}

double OperationLimits::ClearHeight(const Vec2& a, const Vec2& b) const {
  constexpr double kFine = 0.1;  // mm
  double clear = -kInfinity;
  // True if some place of the outline may lie within `beside` (mm) of the rectangle, judged by boxes.
  const auto meets = [&](const Outline& outline, double beside) {
    const Vec2 low = a.cwiseMin(b).array() - beside, high = a.cwiseMax(b).array() + beside;
    Box3 box;
    for (const Ring& ring : outline.rings()) {
      for (const Vec2& p : ring) box.Add(Lift(p, 0.0));
    }
    return !box.Empty() && (Xy(box.max).array() >= low.array()).all() &&
           (Xy(box.min).array() <= high.array()).all();
  };
  for (const Obstacle& o : containment_->obstacles) {
    if (o.stock != nullptr) continue;  // links look at the stock themselves
    if (meets(o.outline, o.margin + params_.tool_radius))
      clear = std::max(clear, o.top_z + o.margin + params_.ball_radius);
  }
  for (const BesideStrip& strip : containment_->beside) {
    if (meets(strip.area, 0.0)) clear = std::max(clear, strip.lowest_tip_z + params_.ball_radius);
  }
  if (avoided_locator_) {
    clear = std::max(clear, avoided_locator_->MaxHeight(a, b, 0.0, kFine));
    // Over everything within the radius of a cylinder and its margin, such a ball is at least as high as
    // that.
    for (const UpperCylinder& cylinder : params_.uppers) {
      const double wider = cylinder.radius - params_.ball_radius;
      clear = std::max(clear, avoided_locator_->MaxHeight(a, b, wider, kFine) + containment_->avoid_margin -
                                  cylinder.rise);
    }
  }
  return clear;
}

bool OperationLimits::Forbids(const Vec3& c, double radius, double above) const {
  if (Room(c) < -radius) return true;
  const auto by = [&](const ShankLimit& shank) { return shank.Forbids(c, radius, std::min(above, radius)); };
  if (std::any_of(shanks_.begin(), shanks_.end(), by)) return true;
  if (!avoided_locator_) return false;
  const double reach = avoided_locator_->radius();
  return radius < reach && AnythingNearUpwardRay(*avoided_, c, reach - radius, 0.25 * params_.tolerance);
}

bool OperationLimits::HasRoom(const Vec3& a, const Vec3& b) const {
  const Vec3 middle = 0.5 * (a + b);
  const double half = 0.5 * (b - a).norm();
  const double room = MoveRoom(middle);
  if (room - half >= -LimitTolerance()) return true;
  if (room < -LimitTolerance()) return false;
  return HasRoom(a, middle) && HasRoom(middle, b);
}

bool OperationLimits::ClearOfAvoided(const Vec3& a, const Vec3& b) const {
  if (!avoided_locator_) return true;
  return avoided_locator_->GougeWithin(a, b, LimitTolerance(), 0.1 * LimitTolerance());
}

bool OperationLimits::AllowsBelowHolder(const Vec3& c) const {
  return AllowsBall(c) && std::all_of(shanks_.begin(), shanks_.end(), [&](const ShankLimit& limit) {
           return limit.part() == UpperPart::kHolder || limit.Clears(c, c, 0.0);
         });
}

bool OperationLimits::ShankClears(const Vec3& a, const Vec3& b, double allowed_penetration) const {
  return std::all_of(shanks_.begin(), shanks_.end(),
                     [&](const auto& s) { return s.Clears(a, b, allowed_penetration); });
}

bool OperationLimits::AllowsMove(const Vec3& a, const Vec3& b, bool finishing) const {
  const double highest = std::max(Tip(a).z(), Tip(b).z());
  if (finishing && TopRoom(*containment_, highest) < -LimitTolerance()) return false;
  return HasRoom(a, b) && ClearOfAvoided(a, b) && ShankClears(a, b, LimitTolerance());
}

}  // namespace patchmill
