#include "cam/path/zlevel/contact_candidates.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

// mm per mm of coordinate: margin for the rounding of a box of centres.
constexpr double kBoxSlack = 1e-12;
// Part of its length in the parameters: a narrower part is cut across, wherever corners and middles lie in
// plan. So no shape is sliced without end.
constexpr double kSliver = 1e-4;

}  // namespace

ContactCandidates::ContactCandidates(const Locator& locator, const PieceSides& sides,
                                     const LevelBounds& bounds, double z)
    : locator_(locator),
      surface_(locator.surface()),
      sides_(sides),
      bounds_(bounds),
      z_(z),
      radius_(locator.radius()),
      first_of_leaf_(surface_.leaves.size() + 1, -1) {
  candidates_.reserve(1024);
}

double ContactCandidates::ForbiddenRadius2(double z) const {
  const double below = std::max(0.0, z_ - z);
  return radius_ * radius_ - below * below;
}

bool ContactCandidates::SetLevel(Candidate& item, const Box3& box) const {
  if (box.max.z() <= z_ - radius_) return false;
  item.rho2 = ForbiddenRadius2(box.max.z());
  item.rho = std::sqrt(item.rho2);
  item.px0 = box.min.x();
  item.px1 = box.max.x();
  item.py0 = box.min.y();
  item.py1 = box.max.y();
  item.x0 = box.min.x() - item.rho;
  item.x1 = box.max.x() + item.rho;
  item.y0 = box.min.y() - item.rho;
  item.y1 = box.max.y() + item.rho;
  item.size = std::max(box.max.x() - box.min.x(), box.max.y() - box.min.y());
  item.z_min = box.min.z();
  item.z_max = box.max.z();
  return true;
}

void ContactCandidates::SetMiddle(Candidate& item, const Vec3& p) const {
  item.middle = Xy(p);
  const double square = ForbiddenRadius2(p.z());
  item.middle_rho = square > 0.0 ? std::sqrt(square) : -1.0;
}

// Adds the sides of a smooth part that can be touched at this level.
void ContactCandidates::AddFace(Candidate item, const RectBounds& part) {
  if (!SetLevel(item, part.box)) return;
  item.below = part.box.max.z() <= z_;
  SetMiddle(item, Position(surface_.pieces[static_cast<std::size_t>(item.piece)], 0.5 * (item.u0 + item.u1),
                           0.5 * (item.v0 + item.v1)));
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    item.ax[i] = part.axis(0, k);
    item.ay[i] = part.axis(1, k);
    item.own_mid[i] = part.center.dot(part.axis.col(k)) - part.axis(2, k) * z_;
    item.own_half[i] = part.half[k];
  }
  if (!(item.normals.angle < kWidestNormals)) {
    candidates_.push_back(item);
    return;
  }
  const int asked = item.side;
  const double rounding = kBoxSlack * surface_.scale;
  for (const int side : {1, -1}) {
    if (asked == -side) continue;
    const CenterBounds centers = BoundCenters(part, item.normals, side, radius_);
    if (!centers.possible) continue;
    if (z_ < centers.box.min.z() - rounding || z_ > centers.box.max.z() + rounding) continue;
    item.side = side;
    item.oriented = true;
    item.directed = centers.directed;
    item.right = centers.right;
    item.left = centers.left;
    item.x0 = centers.box.min.x() - rounding;
    item.x1 = centers.box.max.x() + rounding;
    item.y0 = centers.box.min.y() - rounding;
    item.y1 = centers.box.max.y() + rounding;
    // Heights of p + R e: that of the level or, where the shank touches, those of the part.
    const double bottom = centers.shank ? std::max(z_, part.box.min.z()) : z_;
    const double high = centers.shank ? std::max(z_, part.box.max.z()) : z_;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double az = centers.axis(2, k);
      item.mid[i] = centers.center.dot(centers.axis.col(k)) - az * 0.5 * (bottom + high);
      item.half[i] = centers.half[k] + std::abs(az) * 0.5 * (high - bottom) + rounding;
    }
    candidates_.push_back(item);
  }
}

std::pair<std::int32_t, std::int32_t> ContactCandidates::OfLeaf(std::int32_t node) {
  const SurfaceNode& n = surface_.nodes[static_cast<std::size_t>(node)];
  const auto index = static_cast<std::size_t>(n.leaf);
  if (first_of_leaf_[index] >= 0) {
    const Candidate& rest = candidates_[static_cast<std::size_t>(first_of_leaf_[index])];
    return {rest.first, rest.last};
  }
  // A candidate that is never used itself holds the range.
  const auto holder = static_cast<std::int32_t>(candidates_.size());
  first_of_leaf_[index] = holder;
  candidates_.emplace_back();
  const SurfaceLeaf& leaf = surface_.leaves[index];
  for (int side = 0; side < 4; ++side) {
    if (!OnSide(leaf, side) || sides_.At(leaf.piece, side).kind == SideKind::kSmooth) continue;
    const bool along_u = side % 2 == 0;
    AddCurve(leaf.piece, side, along_u ? leaf.u0 : leaf.v0, along_u ? leaf.u1 : leaf.v1);
  }
  Candidate item;
  item.piece = leaf.piece.value;
  item.u0 = leaf.u0;
  item.u1 = leaf.u1;
  item.v0 = leaf.v0;
  item.v1 = leaf.v1;
  item.normals = bounds_.Normals(index);
  AddFace(item, leaf.Bounds(n.box));
  Candidate& range = candidates_[static_cast<std::size_t>(holder)];
  range.first = holder + 1;
  range.last = static_cast<std::int32_t>(candidates_.size());
  return {range.first, range.last};
}

void ContactCandidates::AddRect(const Candidate& parent, double u0, double u1, double v0, double v1) {
  const BernsteinNet net =
      SubNet(surface_.pieces[static_cast<std::size_t>(parent.piece)].net, u0, u1, v0, v1);
  SurfaceLeaf rect;
  rect.piece = PieceId(parent.piece);
  rect.u0 = static_cast<float>(u0);
  rect.u1 = static_cast<float>(u1);
  rect.v0 = static_cast<float>(v0);
  rect.v1 = static_cast<float>(v1);
  const double slack = JointSlack(rect, sides_, radius_);
  Candidate item;
  item.piece = parent.piece;
  item.u0 = u0;
  item.u1 = u1;
  item.v0 = v0;
  item.v1 = v1;
  item.side = parent.side;
  item.normals = parent.normals;
  if (!net.rational) {
    NormalCone own = BoundNormals(net);
    own.angle += slack;
    // The normals keep the sign of the parent's, so that `side` keeps its meaning.
    if (own.axis.dot(parent.normals.axis) < 0.0) own.axis = -own.axis;
    if (own.angle < parent.normals.angle) item.normals = own;
  }
  AddFace(item, BoundNet(net));
}

void ContactCandidates::AddCurve(PieceId piece_id, int side, double t0, double t1) {
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
  RectBounds part;
  for (const Vec4& p : row.points) {
    if (p.w() > 0.0) part.box.Add(p.head<3>() / p.w());
  }
  if (part.box.Empty()) return;
  Candidate item;
  item.kind = Kind::kCurve;
  item.piece = piece_id.value;
  item.side = side;
  item.u0 = t0;
  item.u1 = t1;
  if (!SetLevel(item, part.box)) return;
  const Vec2 uv = SideParameters(side, 0.5 * (t0 + t1));
  SetMiddle(item, Position(piece, uv.x(), uv.y()));
  candidates_.push_back(item);
}

void ContactCandidates::Open(std::int32_t index) {
  const Candidate item = candidates_[static_cast<std::size_t>(index)];  // a copy: the vector grows
  const auto first = static_cast<std::int32_t>(candidates_.size());
  if (item.kind == Kind::kCurve) {
    const double t = 0.5 * (item.u0 + item.u1);
    AddCurve(PieceId(item.piece), item.side, item.u0, t);
    AddCurve(PieceId(item.piece), item.side, t, item.u1);
  } else {
    const Piece& piece = surface_.pieces[static_cast<std::size_t>(item.piece)];
    // Surface above the centre counts by its plan: of a vertical wall up there only the length is cut.
    const auto corner = [&](double u, double v) {
      const Vec3 p = Position(piece, u, v);
      return Lift(Xy(p), std::min(p.z(), z_));
    };
    // Distances run through the middles, since the ends of a convex rim may lie over each other.
    const double u = 0.5 * (item.u0 + item.u1), v = 0.5 * (item.v0 + item.v1);
    const auto way = [&](double u0, double v0, double u1, double v1) {
      const Vec3 m = corner(0.5 * (u0 + u1), 0.5 * (v0 + v1));
      return (m - corner(u0, v0)).norm() + (corner(u1, v1) - m).norm();
    };
    const double along_u = way(item.u0, item.v0, item.u1, item.v0) + way(item.u0, v, item.u1, v) +
                           way(item.u0, item.v1, item.u1, item.v1);
    const double along_v = way(item.u0, item.v0, item.u0, item.v1) + way(u, item.v0, u, item.v1) +
                           way(item.u1, item.v0, item.u1, item.v1);
    const double wide_u = item.u1 - item.u0, wide_v = item.v1 - item.v0;
    const bool sliver = std::min(wide_u, wide_v) < kSliver * std::max(wide_u, wide_v);
    if (sliver ? wide_u >= wide_v : along_u >= along_v) {
      AddRect(item, item.u0, u, item.v0, item.v1);
      AddRect(item, u, item.u1, item.v0, item.v1);
    } else {
      AddRect(item, item.u0, item.u1, item.v0, v);
      AddRect(item, item.u0, item.u1, v, item.v1);
    }
  }
  Candidate& opened = candidates_[static_cast<std::size_t>(index)];
  opened.opened = true;
  opened.first = first;
  opened.last = static_cast<std::int32_t>(candidates_.size());
}

}  // namespace patchmill
