// The surface cut into parameter rectangles with the control points of each: what bounds are taken over.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/run_context.h"
#include "core/surface/net_kernel.h"
#include "core/surface/surface.h"

namespace patchmill {

struct CellRect {
  PieceId piece;
  double u0 = 0.0, u1 = 1.0, v0 = 0.0, v1 = 1.0;
  double u() const { return 0.5 * (u0 + u1); }
  double v() const { return 0.5 * (v0 + v1); }
};

// One cell as a visitor sees it. The surface over the rectangle lies in the hull of `hull[0..hull_count)`.
struct SurfaceCell {
  CellRect rect;
  int depth = 0;  // halvings below the root cell
  const Vec3* hull = nullptr;
  int hull_count = 0;
  Vec3 middle = Vec3::Zero();  // the surface at the rectangle's middle
  double radius = 0.0;         // no surface point of the cell is farther from `middle`
};

inline constexpr int kMaxCellDepth = 48;

// Halves nets of one piece without touching the heap after the first use.
class CellWalker {
 public:
  explicit CellWalker(const Surface& surface) : surface_(surface) {}

  // Depth-first over `root` and, as long as visit(cell) returns true, its halves along the longer side. The
  // cell of depth d is visited after its parent of depth d - 1 and before the parent's sibling.
  template <class Visit>
  void Walk(const CellRect& root, Visit&& visit) {
    Load(root);
    Descend(root, 0, visit);
  }

 private:
  template <class Visit>
  void Descend(const CellRect& rect, int depth, Visit& visit) {
    const SurfaceCell cell = View(rect, depth);
    if (!visit(cell) || depth >= kMaxCellDepth) return;
    const bool along_u = Halve(depth);
    for (int k = 0; k < 2; ++k) {
      Choose(depth, k);
      CellRect half = rect;
      if (along_u) {
        (k == 0 ? half.u1 : half.u0) = rect.u();
      } else {
        (k == 0 ? half.v1 : half.v0) = rect.v();
      }
      Descend(half, depth + 1, visit);
    }
  }

  void Load(const CellRect& root);
  SurfaceCell View(const CellRect& rect, int depth);
  bool Halve(int depth);              // the net in use at `depth` into the two of depth + 1; true: along u
  void Choose(int depth, int which);  // which half is in use at depth + 1

  const Surface& surface_;
  NetShape shape_;
  std::vector<std::vector<Vec4>> nets_;  // per depth: two nets
  std::vector<const Vec4*> in_use_;      // per depth
  std::vector<Vec3> hull_;
};

// Roots: every piece, halved until no cell is wider than `size` mm. In order of piece. Cancelled: incomplete.
std::vector<CellRect> RootCells(const Surface& surface, double size, const RunContext& run);

// Area estimated from one 4 x 4 sampling per piece, for choosing sizes only.
double RoughArea(const Surface& surface);

}  // namespace patchmill
