#include "cam/path/chord/chord_supports.h"

#include <algorithm>
#include <cmath>

namespace patchmill {

int SupportParts(double radius, double length, double excess) {
  // Parts: more do not pay.
  constexpr double kMost = 16.0;
  return static_cast<int>(
      std::ceil(std::clamp(length * std::sqrt(3.0 / (8.0 * radius * excess)), 2.0, kMost)));
}

std::vector<Support> SupportsBetween(const Surface& surface, const SurfacePoint& a, const SurfacePoint& b,
                                     int parts, double floor_center) {
  const Piece& piece = surface.piece(a.piece);
  std::vector<Support> between;
  between.reserve(static_cast<std::size_t>(parts - 1));
  for (int i = 1; i < parts; ++i) {
    const double s = static_cast<double>(i) / parts;
    between.push_back({Position(piece, a.u + s * (b.u - a.u), a.v + s * (b.v - a.v)), floor_center});
  }
  return between;
}

bool ExcessWithin(double radius, const SupportedChord& chord, double limit) {
  const auto& [a, b, at_a, at_b, between] = chord;
  const std::size_t parts = between.size() + 1;
  Vec3 x = a;
  for (std::size_t i = 0; i < parts; ++i) {
    const Vec3 y =
        i + 1 < parts ? Vec3(a + static_cast<double>(i + 1) / static_cast<double>(parts) * (b - a)) : b;
    const Support &left = i > 0 ? between[i - 1] : at_a, &right = i + 1 < parts ? between[i] : at_b;
    if (ChordExcess(radius, x, y, left, right) > limit) return false;
    x = y;
  }
  return true;
}

}  // namespace patchmill
