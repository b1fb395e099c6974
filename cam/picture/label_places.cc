#include "cam/picture/label_places.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

constexpr double kDot = 4.0;  // px, side of a dot

}  // namespace

LabelPlaces::LabelPlaces(const Vec2& corner, const Vec2& size)
    : corner_(corner),
      columns_(1 + static_cast<int>(size.x() / kDot)),
      rows_(1 + static_cast<int>(size.y() / kDot)),
      id_(static_cast<std::size_t>(columns_ * rows_), -1) {}

Vec2 LabelPlaces::Middle(int i, int j) const { return corner_ + kDot * Vec2(i + 0.5, j + 0.5); }

void LabelPlaces::Paint(const std::array<Vec2, 4>& quad, int id) {
  PaintTriangle(quad[0], quad[1], quad[2], id);
  PaintTriangle(quad[0], quad[2], quad[3], id);
}

void LabelPlaces::PaintTriangle(const Vec2& a, const Vec2& b, const Vec2& c, int id) {
  const Vec2 low = (a.cwiseMin(b).cwiseMin(c) - corner_) / kDot,
             high = (a.cwiseMax(b).cwiseMax(c) - corner_) / kDot;
  const int i1 = std::min(columns_ - 1, static_cast<int>(high.x())),
            j1 = std::min(rows_ - 1, static_cast<int>(high.y()));
  const double turn = Cross(b - a, c - a);
  for (int j = std::max(0, static_cast<int>(low.y())); j <= j1; ++j) {
    for (int i = std::max(0, static_cast<int>(low.x())); i <= i1; ++i) {
      const Vec2 x = Middle(i, j);
      if (turn * Cross(b - a, x - a) >= 0.0 && turn * Cross(c - b, x - b) >= 0.0 &&
          turn * Cross(a - c, x - c) >= 0.0) {
        At(i, j) = id;
      }
    }
  }
}

std::vector<std::optional<Vec2>> LabelPlaces::Find(std::size_t count, double room) const {
  // Counts the steps to the nearest dot of another area, in two sweeps over the picture.
  const auto index = [&](int i, int j) { return static_cast<std::size_t>(j * columns_ + i); };
  std::vector<int> steps(id_.size(), 0);
  const auto look = [&](int i, int j, int di, int dj) {
    const int x = i + di, y = j + dj;
    const bool same = x >= 0 && y >= 0 && x < columns_ && y < rows_ && id_[index(x, y)] == id_[index(i, j)];
    return same ? steps[index(x, y)] + 1 : 1;
  };
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      steps[index(i, j)] =
          std::min({look(i, j, -1, 0), look(i, j, 0, -1), look(i, j, -1, -1), look(i, j, 1, -1)});
    }
  }
  std::vector<std::optional<Vec2>> places(count);
  std::vector<int> widest(count, static_cast<int>(std::ceil(0.5 * room / kDot)) - 1);
  for (int j = rows_ - 1; j >= 0; --j) {
    for (int i = columns_ - 1; i >= 0; --i) {
      int& here = steps[index(i, j)];
      here = std::min({here, look(i, j, 1, 0), look(i, j, 0, 1), look(i, j, 1, 1), look(i, j, -1, 1)});
      const int id = id_[index(i, j)];
      if (id < 0 || static_cast<std::size_t>(id) >= count || here <= widest[static_cast<std::size_t>(id)])
        continue;
      widest[static_cast<std::size_t>(id)] = here;
      places[static_cast<std::size_t>(id)] = Middle(i, j);
    }
  }
  return places;
}

}  // namespace patchmill
