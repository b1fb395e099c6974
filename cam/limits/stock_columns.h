// A stock with a surface of its own, as columns over the squares of a grid in plan.
#pragma once

#include <cstddef>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/limits/covered_cells.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// Everything below the highest place of a surface is stock, without a lower end, as a tool from above meets
// it. The columns contain this stock: their tops bound the control points of parts of the surface that are
// smaller than a square. A column reaches beyond the stock by at most accuracy() in plan, and its top by what
// the surface rises over that. Positions are in the placed frame, mm. Immutable, thread-safe. Cost of a
// distance: some microseconds.
class StockColumns {
 public:
  // `roughed` is the part to which the stock has been cut down: over the squares that it covers as seen from
  // above there are no columns. null: nothing has been cut. Nothing is above top_z (mm). Cost: some
  // microseconds for each square that the surface covers. CANCELLED and DEADLINE_EXCEEDED from `run`.
  static absl::StatusOr<StockColumns> Make(const Surface& stock, double top_z, const Surface* roughed,
                                           const RunContext& run);

  double accuracy() const { return 2.0 * grid_.cell; }  // mm

  // Distance in space: positive outside, negative inside. At the height -infinity it is that in plan. Its
  // slope is at most 1.
  double Distance(const Vec3& c) const;
  // True if a place of a rectangle at the height z, or above -infinity, comes nearer to a column than
  // `distance`. a and b are opposite corners of the rectangle, whose sides run along x and y.
  bool RectangleComesNearer(const Vec2& a, const Vec2& b, double z, double distance) const;
  // Height of the highest column within `distance` (mm, in plan) of such a rectangle; -infinity: none.
  double TopNear(const Vec2& a, const Vec2& b, double distance) const;
  // As StockSolid::CylinderRoom.
  double CylinderRoom(const Vec2& q, double z, double radius) const;

 private:
  // Squares of four squares, and so on up to one square: the highest and the lowest top among them.
  struct Level {
    int nx = 0, ny = 0;
    std::vector<float> highest, lowest;  // mm; -infinity where no stock is
  };
  struct Square {
    int level = 0, x = 0, y = 0;
  };
  StockColumns() = default;
  void AddLevels(std::vector<float> tops);
  const Level& LevelOf(const Square& square) const { return levels_[static_cast<std::size_t>(square.level)]; }
  double HighestOf(const Square& square) const;
  double LowestOf(const Square& square) const;
  Vec2 LowOf(const Square& square) const;
  Vec2 HighOf(const Square& square) const;
  template <class Visit>
  void Descend(const Square& square, const Vec2& q, Visit& visit) const;
  Square Root() const { return {static_cast<int>(levels_.size()) - 1, 0, 0}; }

  PlanGrid grid_;
  std::vector<Level> levels_;  // from single squares on
};

}  // namespace patchmill
