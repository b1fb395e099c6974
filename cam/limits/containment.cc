#include "cam/limits/containment.h"

#include <algorithm>

namespace patchmill {
namespace {

bool LimitsContacts(const Containment& c) { return c.boundary && c.boundary->mode == BoundaryMode::kContact; }

}  // namespace

bool Containment::WantsAll() const {
  const auto any = [](const std::vector<bool>& list, bool value) {
    return std::find(list.begin(), list.end(), value) != list.end();
  };
  return !any(selected, false) && !any(avoided, true) && !LimitsContacts(*this);
}

bool Containment::AllowsAll() const {
  const bool margin = avoid_margin > 0.0 && std::find(avoided.begin(), avoided.end(), true) != avoided.end();
  return !margin && (!boundary || LimitsContacts(*this)) && !top_z && obstacles.empty() && beside.empty();
}

bool IsWantedPatch(const Containment& containment, PatchId patch) {
  return (containment.selected.empty() || containment.selected[patch.index()]) &&
         (containment.avoided.empty() || !containment.avoided[patch.index()]);
}

bool IsWanted(const Containment& containment, PatchId patch, const Vec3& p, double depth) {
  if (!IsWantedPatch(containment, patch)) return false;
  if (!LimitsContacts(containment)) return true;
  const Boundary& boundary = *containment.boundary;
  return boundary.outline.SignedDistance(Xy(p)) + boundary.offset >= depth;
}

double ContactRoomOutside(const Containment& containment, const Vec3& p) {
  if (!LimitsContacts(containment)) return -kInfinity;
  return -containment.boundary->outline.SignedDistance(Xy(p)) - containment.boundary->offset;
}

double BoundaryRoom(const Containment& containment, const Vec2& center, double ball_radius) {
  if (!containment.boundary || LimitsContacts(containment)) return kInfinity;
  const Boundary& boundary = *containment.boundary;
  double offset = boundary.offset;
  if (boundary.mode == BoundaryMode::kInside) offset -= ball_radius;
  if (boundary.mode == BoundaryMode::kOutside) offset += ball_radius;
  return boundary.outline.SignedDistance(center) + offset;
}

double ObstacleRoom(const Obstacle& obstacle, const Vec3& tip, double tool_radius) {
  if (obstacle.stock != nullptr)
    return obstacle.stock->CylinderRoom(Xy(tip), tip.z() + obstacle.lower, tool_radius) - obstacle.margin;
  const double beside = -obstacle.outline.SignedDistance(Xy(tip)) - tool_radius;
  return std::max(beside, tip.z() - obstacle.top_z) - obstacle.margin;
}

double LowestTipOver(const Obstacle& obstacle, const Vec2& q, double tool_radius) {
  if (obstacle.stock != nullptr)
    return obstacle.stock->TopNear(q, q, tool_radius + obstacle.margin) - obstacle.lower + obstacle.margin;
  const bool beside = ObstacleRoom(obstacle, Lift(q, -kInfinity), tool_radius) >= 0.0;
  return beside ? -kInfinity : obstacle.top_z + obstacle.margin;
}

double StripRoom(const BesideStrip& strip, const Vec3& tip) {
  return std::max(-strip.area.SignedDistance(Xy(tip)), tip.z() - strip.lowest_tip_z);
}

double BesideRoom(const Containment& containment, const Vec3& tip) {
  double room = kInfinity;
  for (const BesideStrip& strip : containment.beside) room = std::min(room, StripRoom(strip, tip));
  return room;
}

double TopRoom(const Containment& containment, double tip_z) {
  return containment.top_z ? *containment.top_z - tip_z : kInfinity;
}

}  // namespace patchmill
