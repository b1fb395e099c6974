#include "cam/path/level_items.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

// Items are never cut below this parameter width: their boxes cannot shrink much further in doubles.
constexpr double kSmallestPart = 1e-7;
// mm: contacts this much above the centre still count as at its height.
constexpr double kShankSlack = 1e-6;
// rad: slopes of contacts are compared with this slack, far above the rounding of acos near a flat.
constexpr double kSlopeSlack = 1e-6;

}  // namespace

double DirectionCone::Angle() const { return std::atan2(Cross(right, left), right.dot(left)); }

LevelItems::LevelItems(const Locator& locator, const PieceSides& sides, const std::vector<SlopeRange>& slopes,
                       double z)
    : locator_(locator),
      surface_(locator.surface()),
      sides_(sides),
      slopes_(slopes),
      z_(z),
      radius_(locator.radius()) {
  items_.reserve(1024);
  // A root that touches everything; its children are those of the surface that reach this level.
  items_.emplace_back();
  Item root;
  root.opened = true;
  root.x0 = root.y0 = -kInfinity;
  root.x1 = root.y1 = root.size = kInfinity;
  root.rho = radius_;
  root.first = 1;
  if (!surface_.nodes.empty()) AddNode(0);
  root.last = static_cast<std::int32_t>(items_.size());
  items_[0] = root;
}

double LevelItems::Rho2(double z) const {
  const double below = std::max(0.0, z_ - z);
  return radius_ * radius_ - below * below;
}

// The contact rule on smooth ground: cos(slope) = (c - p_z)/R, or 0 where p is above the centre (shank).
bool LevelItems::SlopeFits(const SlopeRange& slope, double slack, double z_min, double z_max) const {
  const double flattest = std::acos(std::clamp((z_ - z_min) / radius_, 0.0, 1.0));
  const double steepest = std::acos(std::clamp((z_ - z_max) / radius_, 0.0, 1.0));
  slack += kSlopeSlack;
  return slope.min - slack <= steepest && flattest <= slope.max + slack;
}

bool LevelItems::SetBox(Item& item, const Box3& box) const {
  item.rho2 = Rho2(box.max.z());
  if (box.max.z() <= z_ - radius_) return false;
  item.rho = std::sqrt(item.rho2);
  item.x0 = box.min.x();
  item.x1 = box.max.x();
  item.y0 = box.min.y();
  item.y1 = box.max.y();
  item.size = std::max(item.x1 - item.x0, item.y1 - item.y0);
  item.z_min = box.min.z();
  item.flattest = std::acos(std::clamp((z_ - box.min.z()) / radius_, 0.0, 1.0));
  item.steepest = std::acos(std::clamp((z_ - box.max.z()) / radius_, 0.0, 1.0));
  return true;
}

// The half space under the upward side of the box, and the box itself where no shank contact is possible.
void LevelItems::SetOriented(Item& item, const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half,
                             double z_max) const {
  Vec3 n = axis.col(2);
  if (n.z() < 0.0) n = -n;
  item.nx = n.x();
  item.ny = n.y();
  item.off = n.dot(center) + half.z() + radius_ * n.norm() - n.z() * z_;
  item.oriented = z_max <= z_;
  if (item.oriented) {
    item.center = center;
    item.axis = axis;
    item.half = half;
  }
}

void LevelItems::AddNode(std::int32_t node) {
  const SurfaceNode& n = surface_.nodes[static_cast<std::size_t>(node)];
  if (n.leaf >= 0) {
    AddLeaf(surface_.leaves[static_cast<std::size_t>(n.leaf)], static_cast<std::size_t>(n.leaf), n.box);
    return;
  }
  Item item;
  item.id = node;
  if (SetBox(item, n.box)) items_.push_back(item);
}

void LevelItems::AddLeaf(const SurfaceLeaf& leaf, std::size_t leaf_index, const Box3& box) {
  Item item;
  if (!SetBox(item, box)) return;
  item.kind = Kind::kRect;
  item.id = leaf.piece.value;
  item.u0 = leaf.u0;
  item.u1 = leaf.u1;
  item.v0 = leaf.v0;
  item.v1 = leaf.v1;
  const bool on[4] = {item.v0 == 0.0, item.u1 == 1.0, item.v1 == 1.0, item.u0 == 0.0};
  for (int side = 0; side < 4; ++side) {
    if (!on[side]) continue;
    const PieceSide& s = sides_.At(leaf.piece, side);
    if (s.kind == SideKind::kSmooth) {
      item.slope_slack = std::max(item.slope_slack, 1.5 * s.angle);
    } else {
      const bool along_u = side % 2 == 0;
      AddCurve(leaf.piece, side, along_u ? item.u0 : item.v0, along_u ? item.u1 : item.v1);
    }
  }
  const Piece& piece = surface_.piece(leaf.piece);
  const Vec3 corner = Position(piece, item.u0, item.v0);
  item.split_u = (Position(piece, item.u1, item.v0) - corner).norm() +
                     (Position(piece, item.u1, item.v1) - Position(piece, item.u0, item.v1)).norm() >=
                 (Position(piece, item.u0, item.v1) - corner).norm() +
                     (Position(piece, item.u1, item.v1) - Position(piece, item.u1, item.v0)).norm();
  item.slope = !slopes_.empty() ? slopes_[leaf_index]
                                : BoundSlopes(SubNet(piece.net, item.u0, item.u1, item.v0, item.v1));
  if (!SlopeFits(item.slope, item.slope_slack, box.min.z(), box.max.z())) return;
  SetOriented(item, leaf.center, leaf.axis.cast<double>(), leaf.half.cast<double>(), box.max.z());
  const Vec3 middle = Position(piece, 0.5 * (item.u0 + item.u1), 0.5 * (item.v0 + item.v1));
  item.middle = Plan(middle);
  item.middle_rho = Rho2(middle.z()) > 0.0 ? std::sqrt(Rho2(middle.z())) : -1.0;
  items_.push_back(item);
}

void LevelItems::AddRect(const Item& parent, double u0, double u1, double v0, double v1) {
  const Piece& piece = surface_.pieces[static_cast<std::size_t>(parent.id)];
  const BernsteinNet net = SubNet(piece.net, u0, u1, v0, v1);
  const RectBounds bounds = BoundNet(net);
  Item item;
  if (!SetBox(item, bounds.box)) return;
  item.kind = Kind::kRect;
  item.id = parent.id;
  item.u0 = u0;
  item.u1 = u1;
  item.v0 = v0;
  item.v1 = v1;
  item.slope_slack = parent.slope_slack;
  item.slope = net.rational ? parent.slope : BoundSlopes(net);
  item.slope.min = std::max(item.slope.min, parent.slope.min);
  item.slope.max = std::min(item.slope.max, parent.slope.max);
  if (!SlopeFits(item.slope, item.slope_slack, bounds.box.min.z(), bounds.box.max.z())) return;
  SetOriented(item, bounds.center, bounds.axis, bounds.half, bounds.box.max.z());
  const Vec3 corner = Position(piece, u0, v0);
  item.split_u = (Position(piece, u1, v0) - corner).norm() >= (Position(piece, u0, v1) - corner).norm();
  const Vec3 middle = Position(piece, 0.5 * (u0 + u1), 0.5 * (v0 + v1));
  item.middle = Plan(middle);
  item.middle_rho = Rho2(middle.z()) > 0.0 ? std::sqrt(Rho2(middle.z())) : -1.0;
  items_.push_back(item);
}

void LevelItems::AddCurve(PieceId piece_id, int side, double t0, double t1) {
  const Piece& piece = surface_.piece(piece_id);
  BernsteinNet row;
  row.rational = piece.net.rational;
  const int nu = piece.net.degree_u, nv = piece.net.degree_v;
  row.degree_u = side % 2 == 0 ? nu : nv;
  row.degree_v = 0;
  for (int k = 0; k <= row.degree_u; ++k) {
    const int i = side == 1 ? nu : side == 3 ? 0 : k, j = side == 0 ? 0 : side == 2 ? nv : k;
    row.points.push_back(piece.net.points[static_cast<std::size_t>(i * (nv + 1) + j)]);
  }
  row = SubNet(row, t0, t1, 0.0, 1.0);
  Box3 box;
  for (const Vec4& p : row.points) {
    if (p.w() > 0.0) box.Add(p.head<3>() / p.w());
  }
  Item item;
  if (box.Empty() || !SetBox(item, box)) return;
  item.kind = Kind::kCurve;
  item.id = piece_id.value;
  item.side = side;
  item.u0 = t0;
  item.u1 = t1;
  const Vec2 uv = SideParameters(side, 0.5 * (t0 + t1));
  const Vec3 middle = Position(piece, uv.x(), uv.y());
  item.middle = Plan(middle);
  item.middle_rho = Rho2(middle.z()) > 0.0 ? std::sqrt(Rho2(middle.z())) : -1.0;
  items_.push_back(item);
}

bool LevelItems::CanOpen(const Item& item) const {
  if (item.kind == Kind::kNode) return true;
  const double part =
      item.kind == Kind::kCurve ? item.u1 - item.u0 : std::max(item.u1 - item.u0, item.v1 - item.v0);
  return part > kSmallestPart;
}

void LevelItems::Open(std::int32_t index) {
  const Item item = items_[static_cast<std::size_t>(index)];  // a copy: the vector grows
  const auto first = static_cast<std::int32_t>(items_.size());
  switch (item.kind) {
    case Kind::kNode:
      AddNode(item.id + 1);
      AddNode(surface_.nodes[static_cast<std::size_t>(item.id)].right);
      break;
    case Kind::kRect:
      if (item.split_u) {
        const double u = 0.5 * (item.u0 + item.u1);
        AddRect(item, item.u0, u, item.v0, item.v1);
        AddRect(item, u, item.u1, item.v0, item.v1);
      } else {
        const double v = 0.5 * (item.v0 + item.v1);
        AddRect(item, item.u0, item.u1, item.v0, v);
        AddRect(item, item.u0, item.u1, v, item.v1);
      }
      break;
    case Kind::kCurve: {
      const double t = 0.5 * (item.u0 + item.u1);
      AddCurve(PieceId(item.id), item.side, item.u0, t);
      AddCurve(PieceId(item.id), item.side, t, item.u1);
      break;
    }
  }
  Item& opened = items_[static_cast<std::size_t>(index)];
  opened.opened = true;
  opened.first = first;
  opened.last = static_cast<std::int32_t>(items_.size());
}

bool LevelItems::Touches(std::int32_t index, const PlanCell& cell) const {
  const Item& item = items_[static_cast<std::size_t>(index)];
  const double x = cell.mid.x(), y = cell.mid.y(), hx = cell.half.x(), hy = cell.half.y();
  const double gx = std::max({0.0, item.x0 - x - hx, x - hx - item.x1});
  const double gy = std::max({0.0, item.y0 - y - hy, y - hy - item.y1});
  if (gx * gx + gy * gy > item.rho2) return false;
  if (item.kind != Kind::kRect) return true;
  if (item.nx * x + item.ny * y - std::abs(item.nx) * hx - std::abs(item.ny) * hy > item.off) return false;
  if (!item.oriented) return true;
  double squares = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double ax = item.axis(0, k), ay = item.axis(1, k), az = item.axis(2, k);
    const double along =
        (x - item.center.x()) * ax + (y - item.center.y()) * ay + (z_ - item.center.z()) * az;
    const double gap = std::abs(along) - item.half[k] - std::abs(ax) * hx - std::abs(ay) * hy;
    if (gap > 0.0) squares += gap * gap;
  }
  return squares <= radius_ * radius_ * (1.0 + 1e-6);
}

void LevelItems::Collect(const std::vector<std::int32_t>& items, const PlanCell& cell, double width,
                         std::vector<std::int32_t>& out) {
  const double small = std::min(width, radius_ / 3.0);
  stack_.assign(items.rbegin(), items.rend());
  while (!stack_.empty()) {
    const std::int32_t index = stack_.back();
    stack_.pop_back();
    if (!Touches(index, cell)) continue;
    const Item& item = items_[static_cast<std::size_t>(index)];
    const double limit = std::max(0.5 * width, std::min(0.3 * std::sqrt(small * radius_), 0.2 * item.rho));
    const bool open = item.size > limit || (item.kind == Kind::kNode && width <= radius_);
    if (!open || (!item.opened && !CanOpen(item))) {
      out.push_back(index);
      continue;
    }
    if (!item.opened) Open(index);
    const Item& opened = items_[static_cast<std::size_t>(index)];
    for (std::int32_t child = opened.last; child-- > opened.first;) stack_.push_back(child);
  }
}

bool LevelItems::Wanted(std::int32_t index, const SlopeWindow& window) const {
  const Item& item = items_[static_cast<std::size_t>(index)];
  if (item.kind == Kind::kNode) return true;
  double flattest = item.flattest, steepest = item.steepest;
  if (item.kind == Kind::kRect) {
    flattest = std::max(flattest, item.slope.min - item.slope_slack);
    steepest = std::min(steepest, item.slope.max + item.slope_slack);
  }
  return item.z_min <= z_ + kShankSlack && steepest >= window.min && flattest <= window.max;
}

bool LevelItems::Covers(std::int32_t index, const PlanCell& cell) const {
  const Item& item = items_[static_cast<std::size_t>(index)];
  if (item.middle_rho <= 0.0) return false;
  const double dx = std::abs(item.middle.x() - cell.mid.x()) + cell.half.x();
  const double dy = std::abs(item.middle.y() - cell.mid.y()) + cell.half.y();
  const double reach = item.middle_rho * (1.0 - 1e-9);
  return dx * dx + dy * dy < reach * reach;
}

DirectionCone LevelItems::Directions(const std::vector<std::int32_t>& items, const PlanCell& cell) const {
  DirectionCone cone;
  cone.valid = true;
  for (const std::int32_t index : items) {
    if (!Touches(index, cell)) continue;
    const Item& item = items_[static_cast<std::size_t>(index)];
    const double x0 = cell.mid.x() - cell.half.x() - item.x1, x1 = cell.mid.x() + cell.half.x() - item.x0;
    const double y0 = cell.mid.y() - cell.half.y() - item.y1, y1 = cell.mid.y() + cell.half.y() - item.y0;
    if (x0 <= 0.0 && x1 >= 0.0 && y0 <= 0.0 && y1 >= 0.0) {
      cone.valid = cone.empty = false;
      return cone;
    }
    for (const Vec2& e : {Vec2(x0, y0), Vec2(x1, y0), Vec2(x0, y1), Vec2(x1, y1)}) {
      if (cone.empty) {
        cone.right = cone.left = e;
        cone.empty = false;
        continue;
      }
      const double from_right = Cross(cone.right, e), from_left = Cross(cone.left, e);
      if (from_right >= 0.0 && from_left <= 0.0) {
        cone.valid = cone.right.dot(e) > 0.0 || cone.left.dot(e) > 0.0 || from_right > 0.0;
      } else if (from_right > 0.0) {
        cone.left = e;
      } else if (from_left < 0.0) {
        cone.right = e;
      } else {
        cone.valid = false;
      }
      if (!cone.valid) return cone;
    }
  }
  return cone;
}

}  // namespace patchmill
