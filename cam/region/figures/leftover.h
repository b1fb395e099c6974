// What stays over ground that no free ball touches: the distance to the nearest centre where one may stand,
// less R ([verification, section 1], with all of those centres as the path).
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "cam/region/figures/nearest_center.h"
#include "cam/region/figures/surface_cell.h"
#include "core/base/run_context.h"
#include "core/spatial/point_list.h"

namespace patchmill {

struct Deepest {
  double leftover = 0.0;  // mm, >= 0
  bool proven = true;     // nothing is deeper by more than a twentieth and twice LeftoverParams::fine
};

// The largest over some ground of a ball of locator.radius(). Leftover changes by no more than the way along
// the ground, and a centre found for one place is a bound for all: the part whose bound is largest is looked
// at, or quartered, until none may be deeper. Measured to centres that are free, so a place's own is never
// too small; too large where the search for the nearest ends in another local minimum. Deterministic. Keeps
// references to the locator and params.operation_limits. Cost: two hundred heights for each of the places
// that may be
// the deepest when they are looked at, more under limits; some ten of them on most ground, hundreds where
// much of it is as deep, as along a groove; then not proven where they are more than 100, and one for a
// square of R / 10.
class LeftoverSearch {
 public:
  LeftoverSearch(const Locator& locator, const LeftoverParams& params) : locator_(locator), params_(params) {}

  // A point of the surface. `facing`, none where the surface has no normal: a ball that has hardly any room,
  // as in a hole of its own size, is looked for on that side too.
  void AddPoint(const Vec3& p, const std::optional<Facing>& facing) { Add(PointElement(p, facing)); }
  // A triangle of parameters of a piece of locator.surface().
  void AddTriangle(std::size_t piece, const std::array<Vec2, 3>& uv);

  // Of all that was added. The diagonal of the surface's box at most, and where nothing is allowed within
  // 32 R of a place. Means nothing when `run` was cancelled meanwhile.
  Deepest Find(const RunContext& run);

 private:
  struct Cell {
    SurfaceElement element;
    double bound = kInfinity;  // mm from the nearest centre known: nothing of it is farther
    std::size_t seen = 0;      // centres that the bound is of
  };
  struct Entry {
    double bound = kInfinity;
    std::size_t cell = 0;
  };
  struct Limits {
    double enough = 0.0;  // mm from the nearest centre: places farther than that are looked at
    double proven = 0.0;  // until no cell may be farther than this
  };
  struct Looked {
    Vec3 p;
    Column nearest;
  };
  static bool Below(const Entry& a, const Entry& b);  // in the heap
  void Add(SurfaceElement element) { cells_.push_back({.element = std::move(element)}); }
  void Push(std::size_t cell);
  std::size_t Pop();
  void EnterNew(const RunContext& run);
  void Bound(Cell& cell, double enough);
  Column NearestKnown(const Vec3& p) const;
  Limits Wanted() const;
  void Learn(const Column& column);
  void LookAt(const ElementPlace& place, double enough);
  bool Settle();
  const Looked* Worst() const;
  double Distance() const;  // of the deepest, mm

  const Locator& locator_;
  const LeftoverParams params_;
  std::vector<Cell> cells_;
  std::size_t entered_ = 0;  // of them, in the heap
  std::vector<Entry> heap_;
  std::vector<Column> found_;
  PointList centers_;            // of those found
  std::vector<Looked> deepest_;  // each was the deepest when it was looked at
  std::size_t last_ = 0;         // the centre that bounded the last cell
  double area_ = 0.0;
  std::size_t looks_ = 0, quartered_ = 0;
  int settled_ = 0;
  bool proven_ = true;
};

}  // namespace patchmill
