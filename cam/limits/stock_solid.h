// The stock as it lies on the machine, without a lower end: a prism or a model of its own, less the area that
// was roughed.
#pragma once

#include <memory>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/limits/covered_cells.h"
#include "cam/limits/stock_columns.h"
#include "cam/limits/stock_depth.h"
#include "core/base/run_context.h"
#include "core/math/outline.h"
#include "core/surface/surface.h"

namespace patchmill {

// Positions are in the placed frame, mm. Immutable, thread-safe. Distances to a whole prism are exact.
// Those to a prism that was roughed are known to accuracy(), because the area that the surface covers is
// found on a grid of 1500 cells along the longer side of the part. Distances to a whole model are those to
// columns that contain it (StockColumns), so they are never too large. Cost of a distance: some ns on the
// grid, O(log n) beyond it; some microseconds for a model.
class StockSolid {
 public:
  // The whole prism: nothing has been cut from it.
  static StockSolid Whole(Outline outline, double top_z);
  // The prism stands beside the area that the surface covers as seen from above; holes of the surface are
  // not covered. Cost: up to 130,000 triangles a piece, and 50 ns a cell. CANCELLED and DEADLINE_EXCEEDED
  // from `run`.
  static absl::StatusOr<StockSolid> Roughed(Outline outline, double top_z, const Surface& surface,
                                            const RunContext& run);

  // A model as stock, cut off at top_z; `roughed` is the part to which it has been cut down, null: none.
  static absl::StatusOr<StockSolid> OfModel(const Surface& model, double top_z, const Surface* roughed,
                                            const RunContext& run);

  double top_z() const { return top_z_; }                   // nothing is higher
  bool has_one_top() const { return columns_ == nullptr; }  // all of it ends at top_z
  // mm, by which distances may be too large; 0 where nothing has been roughed
  double accuracy() const { return accuracy_; }

  // Distance in plan: positive outside, negative inside. Its slope is at most 1, up to the accuracy.
  double PlanDistance(const Vec2& q) const;
  // Distance in space: positive outside, negative inside. The lower end does not count as a side.
  double Distance(const Vec3& c) const;
  // The depth at the side of the solid that is nearest to c: that of floors at its top, that of walls beside
  // it. In between, as between walls and floors.
  double DepthAt(const Vec3& c, const StockDepth& depth) const;
  // True if a place between a and b comes nearer to the solid than `distance`, to the accuracy or 0.01 mm,
  // whichever is more. With both at height -infinity the distance is that in plan.
  bool SegmentComesNearer(const Vec3& a, const Vec3& b, double distance) const;
  // True if a place of a rectangle in plan comes nearer to the solid in plan than `distance`, as exactly as
  // above. a and b are opposite corners of the rectangle, whose sides run along x and y.
  bool RectangleComesNearer(const Vec2& a, const Vec2& b, double distance) const;
  // True if a place of a level rectangle at the height z comes nearer to the solid in space than `distance`.
  bool RectangleComesNearer(const Vec2& a, const Vec2& b, double z, double distance) const;
  // A height (mm) above which nothing of the solid is within `distance` in plan of such a rectangle;
  // -infinity: nothing of it is there.
  double TopNear(const Vec2& a, const Vec2& b, double distance) const;
  // Room of an upright cylinder without an upper end, whose axis is at q and whose lower end is at the height
  // z: how far both may move before the cylinder touches the solid; negative where it does. Its slope is at
  // most 1.
  double CylinderRoom(const Vec2& q, double z, double radius) const;

 private:
  StockSolid() = default;
  double Step() const;  // mm; places closer together than this are not told apart
  double OnGrid(const Vec2& q) const;
  double RoomInGrid(const Vec2& q) const;  // mm, to the border of the grid; negative beyond it

  Outline outline_;
  double top_z_ = 0.0;
  PlanGrid grid_;
  std::vector<float> distance_;  // mm, signed, at the middles of cells; empty for a whole prism
  bool goes_beyond_ = false;     // the outline reaches beyond the grid
  double accuracy_ = 0.0;        // mm
  std::shared_ptr<const StockColumns> columns_;  // of a model; it has no outline
};

}  // namespace patchmill
