// Which parts of the surface a cell of a level has to look at, and in which directions they lie.
#include <algorithm>
#include <cmath>

#include "cam/path/zlevel/contact_candidates.h"

namespace patchmill {
namespace {

// Parameter width: candidates are not cut below it. Their boxes cannot shrink much further in doubles.
constexpr double kSmallestPart = 1e-7;
// mm: contacts at most this far above the centre still count as at its height.
constexpr double kShankSlack = 1e-6;
// rad: slack for comparing slopes of contacts, far above the rounding of acos near a flat.
constexpr double kSlopeSlack = 1e-6;

}  // namespace

bool ContactCandidates::NodeTouches(std::int32_t node, const XyRect& cell) const {
  const LevelBounds::NodeBox& box = bounds_.nodes()[static_cast<std::size_t>(node)];
  return z_ >= box.min[2] && z_ <= box.max[2] && cell.mid.x() + cell.half.x() >= box.min[0] &&
         cell.mid.x() - cell.half.x() <= box.max[0] && cell.mid.y() + cell.half.y() >= box.min[1] &&
         cell.mid.y() - cell.half.y() <= box.max[1];
}

bool ContactCandidates::Touches(const Candidate& item, const XyRect& cell) const {
  const double x = cell.mid.x(), y = cell.mid.y(), hx = cell.half.x(), hy = cell.half.y();
  if (x + hx < item.x0 || x - hx > item.x1 || y + hy < item.y0 || y - hy > item.y1) return false;
  if (item.oriented) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double off = std::abs(item.ax[k] * x + item.ay[k] * y - item.mid[k]);
      if (off > item.half[k] + std::abs(item.ax[k]) * hx + std::abs(item.ay[k]) * hy) return false;
    }
  } else {
    const double gx = std::max({0.0, item.px0 - x - hx, x - hx - item.px1});
    const double gy = std::max({0.0, item.py0 - y - hy, y - hy - item.py1});
    if (gx * gx + gy * gy > item.rho2) return false;
  }
  if (!item.below) return true;
  double squares = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double off = std::abs(item.ax[k] * x + item.ay[k] * y - item.own_mid[k]);
    const double gap = off - item.own_half[k] - std::abs(item.ax[k]) * hx - std::abs(item.ay[k]) * hy;
    if (gap > 0.0) squares += gap * gap;
  }
  return squares <= radius_ * radius_ * (1.0 + 1e-9);
}

bool ContactCandidates::NeedsOpening(const Candidate& item, double width) const {
  const double small = std::min(width, radius_ / 3.0);
  const double limit = std::max(0.5 * width, std::min(0.3 * std::sqrt(small * radius_), 0.2 * item.rho));
  if (item.size <= limit) return false;
  if (item.directed && item.normals.angle * radius_ <= width) return false;
  const double part =
      item.kind == Kind::kCurve ? item.u1 - item.u0 : std::max(item.u1 - item.u0, item.v1 - item.v0);
  return part > kSmallestPart;
}

void ContactCandidates::Collect(const std::vector<std::int32_t>& candidates, const XyRect& cell, double width,
                                std::vector<std::int32_t>& out) {
  stack_.assign(candidates.rbegin(), candidates.rend());
  while (!stack_.empty()) {
    const std::int32_t index = stack_.back();
    stack_.pop_back();
    std::pair<std::int32_t, std::int32_t> inside;
    if (index < 0) {
      const std::int32_t node = ~index;
      if (!NodeTouches(node, cell)) continue;
      const SurfaceNode& n = surface_.nodes[static_cast<std::size_t>(node)];
      if (width > radius_) {
        const LevelBounds::NodeBox& box = bounds_.nodes()[static_cast<std::size_t>(node)];
        if (std::max(box.max[0] - box.min[0], box.max[1] - box.min[1]) <= 0.5 * width) {
          out.push_back(index);
          continue;
        }
      }
      if (n.leaf < 0) {
        stack_.push_back(~n.right);
        stack_.push_back(~(node + 1));
        continue;
      }
      inside = OfLeaf(node);
    } else {
      const Candidate& item = candidates_[static_cast<std::size_t>(index)];
      if (!Touches(item, cell)) continue;
      if (!NeedsOpening(item, width)) {
        out.push_back(index);
        continue;
      }
      if (!item.opened) Open(index);
      const Candidate& opened = candidates_[static_cast<std::size_t>(index)];
      inside = {opened.first, opened.last};
    }
    for (std::int32_t child = inside.second; child-- > inside.first;) stack_.push_back(child);
  }
}

bool ContactCandidates::Wanted(std::int32_t index, const SlopeWindow& window) const {
  if (index < 0) return true;
  const Candidate& item = candidates_[static_cast<std::size_t>(index)];
  if (item.z_min > z_ + kShankSlack) return false;
  // The contact rule: cos(slope) = (c - p_z)/R, or 0 where p is above the centre (shank).
  double flattest = std::acos(std::clamp((z_ - item.z_min) / radius_, 0.0, 1.0)) - kSlopeSlack;
  double steepest = std::acos(std::clamp((z_ - item.z_max) / radius_, 0.0, 1.0)) + kSlopeSlack;
  if (item.kind == Kind::kRect) {
    const SlopeRange slopes = SlopesOf(item.normals);
    flattest = std::max(flattest, slopes.min - kSlopeSlack);
    steepest = std::min(steepest, slopes.max + kSlopeSlack);
  }
  return steepest >= window.min && flattest <= window.max;
}

bool ContactCandidates::Covers(std::int32_t index, const XyRect& cell) const {
  if (index < 0) return false;
  const Candidate& item = candidates_[static_cast<std::size_t>(index)];
  if (item.middle_rho <= 0.0) return false;
  const double dx = std::abs(item.middle.x() - cell.mid.x()) + cell.half.x();
  const double dy = std::abs(item.middle.y() - cell.mid.y()) + cell.half.y();
  const double reach = item.middle_rho * (1.0 - 1e-9);
  return dx * dx + dy * dy < reach * reach;
}

DirectionCone ContactCandidates::DirectionsFrom(const Candidate& item, const XyRect& cell,
                                                bool closely) const {
  DirectionCone cone;
  if (item.oriented && (item.directed || !closely)) {
    cone.valid = item.directed;  // else a flat spot lies inside: any direction
    cone.empty = false;
    cone.right = item.right;
    cone.left = item.left;
    if (!closely) return cone;
  }
  const double x0 = cell.mid.x() - cell.half.x() - item.px1, x1 = cell.mid.x() + cell.half.x() - item.px0;
  const double y0 = cell.mid.y() - cell.half.y() - item.py1, y1 = cell.mid.y() + cell.half.y() - item.py0;
  if (x0 <= 0.0 && x1 >= 0.0 && y0 <= 0.0 && y1 >= 0.0) {
    cone.empty = false;
    return cone;
  }
  DirectionCone place;
  place.valid = true;
  for (const Vec2& e : {Vec2(x0, y0), Vec2(x1, y0), Vec2(x0, y1), Vec2(x1, y1)}) place.Add(e);
  if (!cone.valid) return place;
  // Both cones hold the directions, so their common part does. If they have none, the first cone stays.
  if (Cross(cone.right, place.right) > 0.0 && Cross(place.right, cone.left) > 0.0) cone.right = place.right;
  if (Cross(cone.right, place.left) > 0.0 && Cross(place.left, cone.left) > 0.0) cone.left = place.left;
  return cone;
}

DirectionCone ContactCandidates::Directions(const std::vector<std::int32_t>& candidates, const XyRect& cell,
                                            bool closely) const {
  DirectionCone cone;
  cone.valid = true;
  for (const std::int32_t index : candidates) {
    if (index < 0) {
      if (!NodeTouches(~index, cell)) continue;
      cone.valid = cone.empty = false;
      return cone;
    }
    const Candidate& item = candidates_[static_cast<std::size_t>(index)];
    if (!Touches(item, cell)) continue;
    cone.Add(DirectionsFrom(item, cell, closely));
    if (!cone.valid) return cone;
  }
  return cone;
}

}  // namespace patchmill
