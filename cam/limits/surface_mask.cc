#include "cam/limits/surface_mask.h"

#include <algorithm>
#include <cmath>

namespace patchmill {

SurfaceMask::SurfaceMask(int cells, const std::vector<std::vector<bool>>& marked) : cells_(cells) {
  const auto n = static_cast<std::size_t>(cells), row = n + 1;
  below_.reserve(marked.size());
  for (const std::vector<bool>& piece : marked) {
    if (std::find(piece.begin(), piece.end(), true) == piece.end()) {
      below_.emplace_back();
      continue;
    }
    if (std::find(piece.begin(), piece.end(), false) == piece.end()) {
      below_.push_back({1});
      continue;
    }
    std::vector<std::int32_t> sums(row * row, 0);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        sums[(i + 1) * row + j + 1] =
            sums[i * row + j + 1] + sums[(i + 1) * row + j] - sums[i * row + j] + (piece[i * n + j] ? 1 : 0);
      }
    }
    below_.push_back(std::move(sums));
  }
}

std::int32_t SurfaceMask::Count(PieceId piece, int i0, int i1, int j0, int j1) const {
  const std::vector<std::int32_t>& sums = below_[piece.index()];
  if (sums.empty()) return 0;
  if (sums.size() == 1) return 1;
  const auto at = [&](int i, int j) { return sums[static_cast<std::size_t>(i * (cells_ + 1) + j)]; };
  return at(i1, j1) - at(i0, j1) - at(i1, j0) + at(i0, j0);
}

bool SurfaceMask::Has(PieceId piece, double u, double v) const {
  const auto cell = [&](double x) { return std::clamp(static_cast<int>(x * cells_), 0, cells_ - 1); };
  return HasCell(piece, cell(u), cell(v));
}

bool SurfaceMask::HasAny(PieceId piece, double u0, double u1, double v0, double v1) const {
  constexpr double kSlack = 1e-9;  // of a cell: repeatedly halved parameters meet its sides up to rounding
  const auto first = [&](double x) {
    return std::clamp(static_cast<int>(std::floor(x * cells_ + kSlack)), 0, cells_ - 1);
  };
  const auto end = [&](double x, int least) {
    return std::clamp(static_cast<int>(std::ceil(x * cells_ - kSlack)), least + 1, cells_);
  };
  const int i = first(u0), j = first(v0);
  return Count(piece, i, end(u1, i), j, end(v1, j)) > 0;
}

}  // namespace patchmill
