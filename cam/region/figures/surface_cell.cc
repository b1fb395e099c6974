#include "cam/region/figures/surface_cell.h"

#include <algorithm>
#include <cmath>

namespace patchmill {

SurfaceElement PointElement(const Vec3& p, const std::optional<Facing>& facing) {
  SurfaceElement cell;
  cell.point = true;
  cell.hull.fill(p);
  cell.facing = facing;
  return cell;
}

SurfaceElement TriangleElement(const Surface& surface, std::size_t piece, const std::array<Vec2, 3>& uv) {
  SurfaceElement cell;
  cell.piece = piece;
  cell.uv = uv;
  const auto at = [&](const Vec2& q) { return Position(surface.pieces[piece], q.x(), q.y()); };
  for (std::size_t k = 0; k < 3; ++k) cell.hull[k] = at(uv[k]);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    cell.hull[3 + k] = 2.0 * at(0.5 * (uv[k] + uv[next])) - 0.5 * (cell.hull[k] + cell.hull[next]);
  }
  return cell;
}

ElementPlace MiddleOf(const Surface& surface, const SurfaceElement& cell) {
  if (cell.point) return {cell.hull[0], cell.facing};
  const Vec2 middle = (cell.uv[0] + cell.uv[1] + cell.uv[2]) / 3.0;
  const SurfaceJet jet = Evaluate(surface.pieces[cell.piece], middle.x(), middle.y());
  return {jet.p, FacingAt(jet)};
}

std::array<SurfaceElement, 4> Quarters(const Surface& surface, const SurfaceElement& cell) {
  const auto& [a, b, c] = cell.uv;
  const Vec2 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
  return {
      TriangleElement(surface, cell.piece, {a, ab, ca}), TriangleElement(surface, cell.piece, {ab, b, bc}),
      TriangleElement(surface, cell.piece, {ca, bc, c}), TriangleElement(surface, cell.piece, {ab, bc, ca})};
}

double Farthest(const SurfaceElement& cell, const Vec3& from, double known) {
  const double known2 = known * known;
  double most2 = 0.0;
  for (const Vec3& q : cell.hull) {
    most2 = std::max(most2, (q - from).squaredNorm());
    if (most2 >= known2) return known;
  }
  return std::sqrt(most2);
}

}  // namespace patchmill
