#include "cam/path/zlevel/piece_sides.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace patchmill {
namespace {

// Native parameters: places this near to each other are one.
constexpr double kNativeTolerance = 1e-9;

// Returns the parameter of a native point on an edge of its patch (the inverse of EdgeParameters); nullopt
// when the point is not on the edge.
std::optional<double> OnPatchEdge(bool triangle, int edge, const Vec2& uv) {
  const auto on = [](double x) { return std::abs(x) < kNativeTolerance; };
  if (triangle) {
    if (edge == 0 && on(uv.y())) return uv.x();
    if (edge == 1 && on(uv.x() + uv.y() - 1.0)) return uv.y();
    if (edge == 2 && on(uv.x())) return uv.y();
    return std::nullopt;
  }
  if (edge == 0 && on(uv.y())) return uv.x();
  if (edge == 1 && on(uv.x() - 1.0)) return uv.y();
  if (edge == 2 && on(uv.y() - 1.0)) return uv.x();
  if (edge == 3 && on(uv.x())) return uv.y();
  return std::nullopt;
}

// Native points of the start (t = 0) and end of a side.
Vec2 SideStart(const Piece& piece, int side) {
  constexpr int kCorner[4] = {0, 1, 2, 0};
  return piece.native[static_cast<std::size_t>(kCorner[side])];
}
Vec2 SideEnd(const Piece& piece, int side) {
  constexpr int kCorner[4] = {1, 3, 3, 2};
  return piece.native[static_cast<std::size_t>(kCorner[side])];
}

// The place between SideStart (0) and SideEnd (1), linear in native parameters, for the place t of a side.
double NativeShare(const Piece& piece, int side, double t) {
  return Eased(t, side % 2 == 0 ? piece.speed.x() : piece.speed.y());
}
// Its inverse.
double SideShare(const Piece& piece, int side, double share) {
  return Eased(share, 1.0 / (side % 2 == 0 ? piece.speed.x() : piece.speed.y()));
}

SurfacePoint AtSide(const Surface& surface, PieceId piece, int side, double t) {
  const Vec2 uv = SideParameters(side, t);
  return {piece, uv.x(), uv.y(), Position(surface.piece(piece), uv.x(), uv.y())};
}

}  // namespace

Vec2 SideParameters(int side, double t) {
  switch (side) {
    case 0:
      return {t, 0.0};
    case 1:
      return {1.0, t};
    case 2:
      return {t, 1.0};
    default:
      return {0.0, t};
  }
}

std::optional<Vec3> OutwardTangent(const Surface& surface, PieceId piece, int side, double t) {
  const Vec2 uv = SideParameters(side, t);
  const SurfaceJet jet = Evaluate(surface, piece, uv.x(), uv.y());
  const Vec3 along = side % 2 == 0 ? jet.du : jet.dv;
  Vec3 out = side % 2 == 0 ? jet.dv : jet.du;
  if (side == 0 || side == 3) out = -out;
  const double length = along.norm(), reach = out.norm();
  if (length <= 1e-12 * surface.scale || reach <= 1e-12 * surface.scale) return std::nullopt;
  out -= along * (along.dot(out) / (length * length));
  if (out.norm() <= 1e-9 * reach) return std::nullopt;
  return out.normalized();
}

PieceSides::PieceSides(const Surface& surface, const RunContext& run) : surface_(&surface) {
  sides_.resize(surface.pieces.size());
  for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
    if (i % 256 == 0 && run.Cancelled()) return;
    const Piece& piece = surface.pieces[i];
    const PatchShape& shape = surface.network.model.patches[piece.patch.index()].shape;
    for (int side = 0; side < 4; ++side) {
      inner_[MiddleOf(PieceId(i), side)].emplace_back(PieceId(i), side);
      for (int edge = 0; edge < EdgeCount(shape); ++edge) {
        const auto t0 = OnPatchEdge(IsTriangle(shape), edge, SideStart(piece, side));
        const auto t1 = OnPatchEdge(IsTriangle(shape), edge, SideEnd(piece, side));
        if (t0 && t1 && *t0 != *t1) edges_[{piece.patch, edge}].push_back({PieceId(i), side, *t0, *t1});
      }
    }
  }
  for (auto& [edge, parts] : edges_) {
    std::sort(parts.begin(), parts.end(), [](const EdgePart& a, const EdgePart& b) {
      return std::min(a.t0, a.t1) < std::min(b.t0, b.t1);
    });
  }
  for (const PartLink& link : surface.network.part_links) {
    junctions_[link.part].push_back(link);
    junctions_[link.whole].push_back(link);
  }
  // A cancel leaves the remaining sides open. The caller finds out from the run itself.
  (void)ParallelFor(run, nullptr, sides_.size(), [&](std::size_t i) {
    for (int side = 0; side < 4; ++side)
      sides_[i][static_cast<std::size_t>(side)] = Classify(PieceId(i), side);
  });
}

PieceSides::Place PieceSides::MiddleOf(PieceId id, int side) const {
  // Units per native parameter in which middles are compared: finer than the spans of uneven weights.
  constexpr double kUnits = 1e12;
  const Piece& piece = surface_->piece(id);
  const Vec2 middle = 0.5 * (SideStart(piece, side) + SideEnd(piece, side));
  return {piece.patch.value, std::llround(middle.x() * kUnits), std::llround(middle.y() * kUnits)};
}

// Returns a point of an edge of a patch at parameter t, as a point of the piece that holds it.
std::optional<PieceSides::SidePoint> PieceSides::OnEdge(PatchEdge edge, double t) const {
  const auto found = edges_.find(edge);
  if (found == edges_.end()) return std::nullopt;
  const std::vector<EdgePart>& parts = found->second;
  auto part = std::upper_bound(parts.begin(), parts.end(), t,
                               [](double x, const EdgePart& p) { return x < std::min(p.t0, p.t1); });
  if (part != parts.begin()) --part;
  const double share = std::clamp((t - part->t0) / (part->t1 - part->t0), 0.0, 1.0);
  const double s = SideShare(surface_->piece(part->piece), part->side, share);
  return SidePoint{AtSide(*surface_, part->piece, part->side, s), part->side};
}

// Goes from an edge to the longer edge along which it lies, or to the shorter edge that lies along it there.
std::optional<PieceSides::SidePoint> PieceSides::AcrossJunction(PatchEdge edge, double t) const {
  const auto found = junctions_.find(edge);
  if (found == junctions_.end()) return std::nullopt;
  for (const PartLink& link : found->second) {
    if (link.part == edge) return OnEdge(link.whole, link.from + t * (link.to - link.from));
    // Places between two parts are known only to rounding.
    const double s = (t - link.from) / (link.to - link.from), clamped = std::clamp(s, 0.0, 1.0);
    if (std::abs(s - clamped) <= kNativeTolerance) return OnEdge(link.part, clamped);
  }
  return std::nullopt;
}

std::optional<PieceSides::SidePoint> PieceSides::Beyond(PieceId id, int side, double t) const {
  const Piece& piece = surface_->piece(id);
  const Vec2 a = SideStart(piece, side), b = SideEnd(piece, side);
  const PatchShape& shape = surface_->network.model.patches[piece.patch.index()].shape;
  for (int edge = 0; edge < EdgeCount(shape); ++edge) {
    const auto s0 = OnPatchEdge(IsTriangle(shape), edge, a), s1 = OnPatchEdge(IsTriangle(shape), edge, b);
    if (!s0 || !s1 || *s0 == *s1) continue;
    const EdgeLink& link = surface_->network.Link({piece.patch, edge});
    if (link.collapsed) return std::nullopt;
    const double s = *s0 + NativeShare(piece, side, t) * (*s1 - *s0);
    if (!link.neighbor) return AcrossJunction({piece.patch, edge}, s);
    return OnEdge(*link.neighbor, link.reversed ? 1.0 - s : s);
  }
  for (const auto& [other, other_side] : inner_.at(MiddleOf(id, side))) {
    if (other == id) continue;
    const Piece& there = surface_->piece(other);
    const bool same = (SideStart(there, other_side) - a).norm() < (SideEnd(there, other_side) - a).norm();
    return SidePoint{AtSide(*surface_, other, other_side, same ? t : 1.0 - t), other_side};
  }
  return std::nullopt;
}

std::optional<SurfacePoint> PieceSides::Across(PieceId id, int side, double t) const {
  const auto beyond = Beyond(id, side, t);
  return beyond ? std::optional(beyond->at) : std::nullopt;
}

// Returns the angle by which the surface turns at the point t of a side, 0 < t < 1, and its step there.
std::optional<PieceSide> PieceSides::TurnAt(PieceId piece, int side, double t) const {
  const auto beyond = Beyond(piece, side, t);
  if (!beyond) return std::nullopt;
  const auto& [other, other_side] = *beyond;
  const std::optional<Vec3> out = OutwardTangent(*surface_, piece, side, t);
  const std::optional<Vec3> in =
      OutwardTangent(*surface_, other.piece, other_side, other_side % 2 == 0 ? other.u : other.v);
  if (!out || !in) return std::nullopt;
  const Vec2 uv = SideParameters(side, t);
  const double step = (Position(surface_->piece(piece), uv.x(), uv.y()) - other.p).norm();
  return PieceSide{SideKind::kSmooth, std::atan2(out->cross(*in).norm(), -out->dot(*in)), step};
}

PieceSide PieceSides::Classify(PieceId piece, int side) const {
  // Places on the side that are sampled.
  constexpr double kAt[5] = {0.02, 0.27, 0.5, 0.73, 0.98};
  PieceSide result;
  int found = 0;
  for (double t : kAt) {
    const std::optional<PieceSide> turn = TurnAt(piece, side, t);
    if (!turn) continue;
    ++found;
    result.angle = std::max(result.angle, turn->angle);
    result.step = std::max(result.step, turn->step);
  }
  if (found == 0) return {};
  result.kind = found == 5 && result.angle <= kSmoothSideAngle ? SideKind::kSmooth : SideKind::kCrease;
  return result;
}

}  // namespace patchmill
