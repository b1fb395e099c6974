#include "cam/plan/footprint.h"

#include <array>
#include <cmath>
#include <deque>

namespace patchmill {

Footprint::Footprint(const Surface& surface, const RunContext& run)
    : grid_(GridOver(surface, {.cells = 400.0, .beside = 4})),
      covered_(CoveredCells(surface, grid_, "seen from above", run)) {
  FloodOutside();
}

bool Footprint::IsOutside(const Vec2& q) const {
  const auto cell = At(q);
  return !cell || outside_[*cell] != 0;
}

bool Footprint::IsBare(const Vec2& q) const {
  const auto cell = At(q);
  return !cell || covered_[*cell] == 0;
}

std::optional<std::size_t> Footprint::At(const Vec2& q) const {
  const auto cell = [&](double d) { return static_cast<int>(std::floor(d / grid_.cell)); };
  const int x = cell(q.x() - grid_.low.x()), y = cell(q.y() - grid_.low.y());
  if (x < 0 || y < 0 || x >= grid_.nx || y >= grid_.ny) return std::nullopt;
  return grid_.Index(x, y);
}

void Footprint::FloodOutside() {
  outside_.assign(covered_.size(), 0);
  std::deque<std::array<int, 2>> open = {{0, 0}};
  outside_[0] = 1;
  while (!open.empty()) {
    const auto [x, y] = open.front();
    open.pop_front();
    for (const auto& [dx, dy] : {std::array{1, 0}, std::array{-1, 0}, std::array{0, 1}, std::array{0, -1}}) {
      const int nx = x + dx, ny = y + dy;
      if (nx < 0 || ny < 0 || nx >= grid_.nx || ny >= grid_.ny) continue;
      const std::size_t i = grid_.Index(nx, ny);
      if (covered_[i] != 0 || outside_[i] != 0) continue;
      outside_[i] = 1;
      open.push_back({nx, ny});
    }
  }
}

}  // namespace patchmill
