// Finds where the names of areas have room in a picture.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

class LabelPlaces {
 public:
  // Covers a picture of `size` px from `corner` with dots of 4 px.
  LabelPlaces(const Vec2& corner, const Vec2& size);

  // Paints a quadrangle of the area `id` (-1: no area) over everything painted before.
  void Paint(const std::array<Vec2, 4>& quad, int id);

  // For each area 0 .. count - 1 the middle of the widest place where it can be seen. nullopt if that is not
  // at least about `room` px wide.
  std::vector<std::optional<Vec2>> Find(std::size_t count, double room) const;

 private:
  Vec2 Middle(int i, int j) const;
  int& At(int i, int j) { return id_[static_cast<std::size_t>(j * columns_ + i)]; }
  void PaintTriangle(const Vec2& a, const Vec2& b, const Vec2& c, int id);

  Vec2 corner_;
  int columns_, rows_;
  std::vector<int> id_;
};

}  // namespace patchmill
