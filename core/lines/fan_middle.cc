#include "core/lines/fan_middle.h"

#include <algorithm>

namespace patchmill {
namespace {

// True if field k changes its sign at least four times around the cell.
bool MeetsTwice(ZeroVertices& vertices, const std::vector<int>& ring, std::size_t k) {
  int changes = 0, last = 0;
  for (std::size_t i = 0; i <= ring.size(); ++i) {
    const int sign = vertices.Sign(ring[i % ring.size()], k);
    if (sign == 0) continue;
    changes += last != 0 && sign != last;
    last = sign;
  }
  return changes >= 4;
}

// True if the chords from `place` to the ring's vertices of the same sign have this sign all along.
bool SeesItsSign(ZeroVertices& vertices, const std::vector<int>& ring, std::size_t k, const Vec2& place) {
  constexpr int kSteps = 8;
  std::vector<Vec2> seen = {place};
  const int sign = vertices.SignOf(k, vertices.Values(seen, k)[0]);
  if (sign == 0) return false;
  seen.clear();
  for (const int id : ring) {
    if (vertices.Sign(id, k) != sign) continue;
    for (int i = 1; i < kSteps; ++i)
      seen.push_back(place + (Vec2(vertices[id].u, vertices[id].v) - place) * i / kSteps);
  }
  const std::vector<double> values = vertices.Values(seen, k);
  return std::all_of(values.begin(), values.end(),
                     [&](double value) { return vertices.SignOf(k, value) != -sign; });
}

}  // namespace

std::optional<Vec2> BetterMiddle(ZeroVertices& vertices, std::span<const ZeroField> fields,
                                 const std::vector<int>& ring, const Vec2& low, double side) {
  constexpr int kPlaces = 8;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    if (!fields[k].smooth || !MeetsTwice(vertices, ring, k)) continue;
    const Vec2 center = low + Vec2::Constant(0.5 * side);
    if (SeesItsSign(vertices, ring, k, center)) return std::nullopt;
    std::vector<Vec2> places;
    for (int a = 1; a < kPlaces; ++a) {
      for (int b = 1; b < kPlaces; ++b) places.push_back(low + Vec2(a, b) * (side / kPlaces));
    }
    std::stable_sort(places.begin(), places.end(), [&](const Vec2& x, const Vec2& y) {
      return (x - center).squaredNorm() < (y - center).squaredNorm();
    });
    for (const Vec2& place : places) {
      if (SeesItsSign(vertices, ring, k, place)) return place;
    }
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace patchmill
