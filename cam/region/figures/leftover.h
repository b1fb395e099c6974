// Finds the deepest leftover of an unreachable area. The leftover at a place is its distance from the nearest
// centre at which the ball is free and allowed, less R: what would stay there if the tool passed through all
// such centres [regions, section 9].
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
  bool proven =
      true;  // false: some place may be deeper by more than a twentieth plus twice LeftoverParams::fine
};

// Finds the largest leftover over some area for a ball of locator.radius(). It works by branch and bound over
// parts of the area. Two facts bound the leftover of a part [regions T16]: from one place to another it
// changes by no more than their distance along the surface; and every free centre known gives an upper bound
// for all places. The part with the largest bound is either examined at its middle (a search for the nearest
// centre) or quartered, until no part may be deeper than the deepest place found. All centres used are free,
// so the leftover found for a place is never too small. It is too large if the search for the nearest centre
// ends in a local minimum that is not the nearest. Deterministic. Keeps references to the locator and to
// params.operation_limits.
//
// Cost: two hundred heights for each place that may be the deepest when it is examined, more under limits.
// These are some ten places of most areas, and hundreds where much of the area is equally deep, as along a
// groove. At most 100 places and one more for each square of R / 10 are examined (1000 in all); if that is
// not enough, the result is not proven.
class LeftoverSearch {
 public:
  LeftoverSearch(const Locator& locator, const LeftoverParams& params) : locator_(locator), params_(params) {}

  // Adds a point of the surface. `facing` is nullopt if the surface has no normal there. If it has one,
  // centres in narrow room on the side of `facing`, as in a hole of the ball's own size, are searched, too.
  void AddPoint(const Vec3& p, const std::optional<Facing>& facing) { Add(PointElement(p, facing)); }
  // Adds a triangle in the parameters of a piece of locator.surface().
  void AddTriangle(std::size_t piece, const std::array<Vec2, 3>& uv);

  // The deepest leftover of all that was added. It is at most the diagonal of the surface's box, and it is
  // that where no centre is allowed within 32 R of a place. Meaningless if `run` was cancelled meanwhile.
  Deepest Find(const RunContext& run);

 private:
  struct Cell {
    SurfaceElement element;
    double bound = kInfinity;  // mm; no point of it is farther than this from the nearest known centre
    std::size_t seen = 0;      // number of centres that the bound takes into account
  };
  struct Entry {
    double bound = kInfinity;
    std::size_t cell = 0;
  };
  struct Limits {
    double enough = 0.0;  // mm; places farther than this from the nearest known centre are examined
    double proven = 0.0;  // mm; the search ends when no cell has a larger bound
  };
  struct Looked {
    Vec3 p;
    Column nearest;
  };
  static bool Below(const Entry& a, const Entry& b);  // order of the heap
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
  double Distance() const;  // mm, from the deepest place known to its nearest centre; at least R

  const Locator& locator_;
  const LeftoverParams params_;
  std::vector<Cell> cells_;
  std::size_t entered_ = 0;  // number of cells that have been entered into the heap
  std::vector<Entry> heap_;
  std::vector<Column> found_;
  PointList centers_;            // centres of found_
  std::vector<Looked> deepest_;  // places that were the deepest when they were examined
  std::size_t last_ = 0;         // index in found_ of the centre that bounded the last cell
  double area_ = 0.0;
  std::size_t looks_ = 0, quartered_ = 0;
  int settled_ = 0;
  bool proven_ = true;
};

}  // namespace patchmill
