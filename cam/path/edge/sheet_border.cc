#include "cam/path/edge/sheet_border.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

constexpr double kOnSide = 1e-9;         // piece parameters: contacts on an open edge are clamped onto it
constexpr double kSameDirection = 1e-5;  // rad: smaller angles count as none
constexpr double kRimFall = 0.01;        // sine of the fall away from an open edge that makes it a rim
// A rim is the top of a wall if the horizontal part of its inward unit tangent is smaller than this.
constexpr double kUpright = 0.05;

// Returns the patch edge along which both parameters lie, if any.
std::optional<int> EdgeThrough(bool triangle, const Vec2& a, const Vec2& b) {
  const auto both = [&](auto on) { return on(a) && on(b); };
  // Native parameters.
  constexpr double kEps = 1e-12;
  if (both([](const Vec2& p) { return std::abs(p.y()) < kEps; })) return 0;
  if (triangle) {
    if (both([](const Vec2& p) { return std::abs(p.x() + p.y() - 1) < kEps; })) return 1;
    if (both([](const Vec2& p) { return std::abs(p.x()) < kEps; })) return 2;
    return std::nullopt;
  }
  if (both([](const Vec2& p) { return std::abs(p.x() - 1) < kEps; })) return 1;
  if (both([](const Vec2& p) { return std::abs(p.y() - 1) < kEps; })) return 2;
  if (both([](const Vec2& p) { return std::abs(p.x()) < kEps; })) return 3;
  return std::nullopt;
}

// Corners (0,0) (1,0) (0,1) (1,1) of a piece at the ends of each side.
constexpr int kSideCorner[4][2] = {{0, 1}, {1, 3}, {2, 3}, {0, 2}};
constexpr double kCornerU[4] = {0, 1, 0, 1}, kCornerV[4] = {0, 0, 1, 1};

bool OnSide(const SurfacePoint& c, int side) {
  switch (side) {
    case 0:
      return c.v <= kOnSide;
    case 1:
      return c.u >= 1 - kOnSide;
    case 2:
      return c.v >= 1 - kOnSide;
    default:
      return c.u <= kOnSide;
  }
}

// Returns the unit tangent of the surface that leaves the side inwards, square to it; zero where degenerate.
Vec3 Inward(const SurfaceJet& jet, int side) {
  const Vec3 along = side % 2 == 0 ? jet.du : jet.dv;
  Vec3 in = side % 2 == 0 ? jet.dv : jet.du;
  if (side == 1 || side == 2) in = -in;
  const double l2 = along.squaredNorm();
  if (l2 > 0) in -= in.dot(along) / l2 * along;
  const double length = in.norm();
  return length > 0 ? Vec3(in / length) : Vec3(Vec3::Zero());
}

}  // namespace

Vec3 UpwardNormalNear(const Surface& surface, const SurfacePoint& at) {
  if (const auto n = UpwardNormal(Evaluate(surface, at.piece, at.u, at.v))) return *n;
  for (double step : {1e-6, 1e-4, 1e-2}) {
    const double u = at.u + step * (0.5 - at.u), v = at.v + step * (0.5 - at.v);
    if (const auto n = UpwardNormal(Evaluate(surface, at.piece, u, v))) return *n;
  }
  return Vec3::UnitZ();
}

SheetBorder::SheetBorder(const Surface& surface, bool roll)
    : surface_(surface), roll_(roll), open_(surface.pieces.size()) {
  const PatchNetwork& network = surface.network;
  same_point_ = std::max(network.join_tolerance, 1e-9 * surface.scale);
  for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
    const Piece& piece = surface.pieces[i];
    const bool triangle = IsTriangle(network.model.patches[piece.patch.index()].shape);
    for (int side = 0; side < 4; ++side) {
      const int c0 = kSideCorner[side][0], c1 = kSideCorner[side][1];
      const auto edge = EdgeThrough(triangle, piece.native[static_cast<std::size_t>(c0)],
                                    piece.native[static_cast<std::size_t>(c1)]);
      bool& open = open_[i][static_cast<std::size_t>(side)];
      open = false;
      if (!edge) continue;
      const EdgeLink& link = network.Link({piece.patch, *edge});
      open = !link.neighbor && !link.collapsed && !link.on_t_junction;
      if (!open) continue;
      open_vertices_.push_back(Position(piece, kCornerU[c0], kCornerV[c0]));
      open_vertices_.push_back(Position(piece, kCornerU[c1], kCornerV[c1]));
    }
  }
  std::sort(open_vertices_.begin(), open_vertices_.end(),
            [](const Vec3& a, const Vec3& b) { return a.x() < b.x(); });
}

bool SheetBorder::AtOpenVertex(const Vec3& p) const {
  auto it = std::lower_bound(open_vertices_.begin(), open_vertices_.end(), p.x() - same_point_,
                             [](const Vec3& a, double x) { return a.x() < x; });
  for (; it != open_vertices_.end() && it->x() <= p.x() + same_point_; ++it) {
    if ((*it - p).norm() <= same_point_) return true;
  }
  return false;
}

bool SheetBorder::OnSurfaceNormal(const SurfacePoint& contact, const Vec3& normal) const {
  return UpwardNormalNear(surface_, contact).cross(normal).norm() <= kSameDirection;
}

SheetBorder::Sides SheetBorder::SidesAt(const SurfacePoint& contact) const {
  Sides at;
  int sides = 0;
  for (int side = 0; side < 4; ++side) {
    if (!OnSide(contact, side)) continue;
    ++sides;
    at.open |= open_[contact.piece.index()][static_cast<std::size_t>(side)];
  }
  // A corner between closed sides may still lie on an open edge of the sheet (the middle patch of a fan).
  at.fan_corner = !at.open && sides == 2 && AtOpenVertex(contact.p);
  return at;
}

bool SheetBorder::On(const SurfacePoint& contact) const {
  const Sides at = SidesAt(contact);
  return at.open || at.fan_corner;
}

bool SheetBorder::Allowed(const SurfacePoint& contact, const Vec3& normal) const {
  if (roll_) return true;
  const auto [on_open_side, fan_corner] = SidesAt(contact);
  if (!on_open_side && !fan_corner) return true;
  if (OnSurfaceNormal(contact, normal)) return true;
  const SurfaceJet jet = Evaluate(surface_, contact.piece, contact.u, contact.v);
  for (int side = 0; side < 4; ++side) {
    if (!OnSide(contact, side)) continue;
    if (!fan_corner && !open_[contact.piece.index()][static_cast<std::size_t>(side)]) continue;
    const Vec3 in = Inward(jet, side);
    if (in.dot(normal) >= -kSameDirection) continue;  // the ball is not rolled over this side
    if (in.z() > -kRimFall) return false;
    // The limit is right above the edge: in the vertical plane through it.
    const Vec2 edge = Xy(side % 2 == 0 ? jet.du : jet.dv);
    Vec2 out = -Xy(in);
    if (edge.squaredNorm() > 0) out -= out.dot(edge) / edge.squaredNorm() * edge;
    const double level = out.norm();
    if (level > kUpright && Xy(normal).dot(out) > kSameDirection * level) return false;
  }
  return true;
}

}  // namespace patchmill
