#include "cam/path/zlevel/level_cells.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace patchmill {
namespace {

// Marks a free slot.
constexpr std::uint64_t kNoKey = ~std::uint64_t{0};
// rad: a cell is a graph only if its cone of directions is narrower than this: half a turn less a margin.
constexpr double kWidestCone = kPi - 0.05;
// Parts of the smallest cell by which the grid is shifted against the model. Faces and symmetry planes of a
// model lie on round numbers; so they do not run along cell edges.
constexpr double kShiftX = 0.3819660112501051, kShiftY = 0.7236067977499789;

std::uint64_t Mix(std::uint64_t k) {
  k ^= k >> 31;
  k *= 0x9e3779b97f4a7c15ULL;
  k ^= k >> 29;
  k *= 0xbf58476d1ce4e5b9ULL;
  return k ^ (k >> 32);
}

class Search {
 public:
  Search(ContactCandidates& items, const LevelOracle& oracle, const LevelCellLimits& limits,
         const RunContext& run, const WantedLevel* wanted)
      : items_(items), oracle_(oracle), limits_(limits), run_(run), wanted_(wanted) {}

  // Fills `out`, of which the grid is known.
  LevelCells Root(LevelCells out) {
    out_ = std::move(out);
    const std::int32_t side = std::int32_t{1} << out_.grid.levels;
    pool_.resize(static_cast<std::size_t>(out_.grid.levels) + 2);
    pool_[0] = {ContactCandidates::kRoot};
    Visit(0, 0, side, 0);
    return std::move(out_);
  }

 private:
  bool Stopped() const { return out_.overflow || out_.exhausted || out_.cancelled; }

  // Does the disc of the deepest point found below the cell's middle hold the whole cell?
  bool MiddleCovers(const XyRect& cell) {
    if (cell.half.norm() >= oracle_.radius()) return false;
    constexpr double kMargin = 1e-9;  // mm
    if (recent_.Holding(cell.mid, cell.half, kMargin) != nullptr) return true;
    const std::optional<SurfacePoint> obstacle = oracle_.Obstacle(cell.mid, hint_ ? &*hint_ : nullptr);
    if (!obstacle) return false;
    hint_ = oracle_.DeepestOnBranch(*obstacle, cell.mid);
    RecentDiscs found;
    found.Add(*hint_, oracle_.ForbiddenRadius(hint_->p));
    recent_.Add(*hint_, oracle_.ForbiddenRadius(hint_->p));
    return found.Holding(cell.mid, cell.half, kMargin) != nullptr;
  }

  void Visit(std::int32_t x, std::int32_t y, std::int32_t side, std::size_t depth) {
    if (Stopped()) return;
    if (++looked_ % 64 == 0 && run_.Cancelled()) {
      out_.cancelled = true;
      return;
    }
    if (looked_ > limits_.max_cells) {
      out_.exhausted = true;
      return;
    }
    const LevelCell here{.x = x, .y = y, .side = side};
    const XyRect cell = XyRectOf(out_.grid, here);
    if (wanted_ != nullptr && wanted_->where != nullptr && !wanted_->where->Meets(cell)) return;
    const double width = side * out_.grid.unit;
    std::vector<std::int32_t>& mine = pool_[depth + 1];
    mine.clear();
    items_.Collect(pool_[depth], cell, width, mine);
    if (mine.empty()) return;
    if (wanted_ != nullptr && std::none_of(mine.begin(), mine.end(), [this](std::int32_t item) {
          return items_.Wanted(item, wanted_->window);
        })) {
      return;
    }
    for (const std::int32_t item : mine) {
      if (items_.Covers(item, cell)) return;
    }
    if (width <= oracle_.radius() / 3.0) {
      for (const bool closely : {false, true}) {
        const DirectionCone cone = items_.Directions(mine, cell, closely);
        if (!cone.valid || cone.Angle() >= kWidestCone) continue;
        Keep(here, (cone.left.normalized() + cone.right.normalized()).normalized(), mine);
        return;
      }
    }
    if (MiddleCovers(cell)) return;
    if (side == 1) {
      Keep(here, std::nullopt, mine);
      return;
    }
    const std::int32_t h = side / 2;
    for (std::int32_t i = 0; i <= side; i += h) {
      for (std::int32_t j = 0; j <= side; j += h) out_.vertices[GridKey(x + i, y + j)];
    }
    Visit(x, y, h, depth + 1);
    Visit(x + h, y, h, depth + 1);
    Visit(x, y + h, h, depth + 1);
    Visit(x + h, y + h, h, depth + 1);
  }

  void Keep(LevelCell cell, const std::optional<Vec2>& free, const std::vector<std::int32_t>& mine) {
    cell.ambiguous = !free;
    if (free) cell.free = *free;
    cell.first_candidate = static_cast<std::int32_t>(out_.items.size());
    out_.items.insert(out_.items.end(), mine.begin(), mine.end());
    cell.last_candidate = static_cast<std::int32_t>(out_.items.size());
    out_.cells.push_back(cell);
    if (cell.ambiguous && ++out_.ambiguous > limits_.max_ambiguous) out_.overflow = true;
  }

  ContactCandidates& items_;
  const LevelOracle& oracle_;
  const LevelCellLimits& limits_;
  const RunContext& run_;
  const WantedLevel* wanted_;
  LevelCells out_;
  std::vector<std::vector<std::int32_t>> pool_;  // candidates by depth
  std::optional<SurfacePoint> hint_;
  RecentDiscs recent_;
  int looked_ = 0;
};

}  // namespace

GridMap::GridMap() : keys_(1024, kNoKey), values_(1024, -1) {}

std::size_t GridMap::Find(std::uint64_t key) const {
  const std::size_t mask = keys_.size() - 1;
  std::size_t i = Mix(key) & mask;
  while (keys_[i] != kNoKey && keys_[i] != key) i = (i + 1) & mask;
  return i;
}

bool GridMap::Contains(std::uint64_t key) const { return keys_[Find(key)] == key; }

std::int32_t& GridMap::operator[](std::uint64_t key) {
  std::size_t i = Find(key);
  if (keys_[i] == kNoKey) {
    if (2 * ++used_ > keys_.size()) {
      Grow();
      i = Find(key);
    }
    keys_[i] = key;
  }
  return values_[i];
}

void GridMap::Grow() {
  std::vector<std::uint64_t> keys(2 * keys_.size(), kNoKey);
  std::vector<std::int32_t> values(2 * keys_.size(), -1);
  keys.swap(keys_);
  values.swap(values_);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] == kNoKey) continue;
    const std::size_t to = Find(keys[i]);
    keys_[to] = keys[i];
    values_[to] = values[i];
  }
}

XyRect XyRectOf(const LevelGrid& grid, const LevelCell& cell) {
  const double half = 0.5 * grid.unit * cell.side;
  return {grid.At(cell.x, cell.y) + Vec2(half, half), Vec2(half, half)};
}

LevelCells FindCells(ContactCandidates& items, const LevelOracle& oracle, const LevelCellLimits& limits,
                     const RunContext& run, const WantedLevel* wanted) {
  LevelCells out;
  const Box3& box = oracle.surface().box;
  out.grid.unit = limits.smallest;
  if (box.Empty()) return out;
  const double margin = oracle.radius() + 4.0 * limits.smallest;
  const double extent = std::max(box.max.x() - box.min.x(), box.max.y() - box.min.y()) + 2.0 * margin;
  while (out.grid.levels < 28 && out.grid.unit * (std::int32_t{1} << out.grid.levels) < extent)
    ++out.grid.levels;
  out.grid.unit = std::max(out.grid.unit, extent / (std::int32_t{1} << out.grid.levels));
  out.grid.origin = Xy(box.min) - Vec2(margin + kShiftX * out.grid.unit, margin + kShiftY * out.grid.unit);
  return Search(items, oracle, limits, run, wanted).Root(std::move(out));
}

}  // namespace patchmill
