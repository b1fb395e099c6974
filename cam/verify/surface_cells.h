// Divides the surface into rectangles of parameters with the control points of each. Bounds are taken over
// these cells.
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

// A surface, and root cells that cover the part of it that is judged. Refers to both.
struct RootedSurface {
  const Surface& surface;
  const std::vector<CellRect>& roots;
};

// One cell as a visitor gets it. The surface over the rectangle lies in the convex hull of
// hull[0..hull_count).
struct SurfaceCell {
  CellRect rect;
  int depth = 0;  // halvings below the root cell
  const Vec3* hull = nullptr;
  int hull_count = 0;
  Vec3 middle = Vec3::Zero();  // surface point at the middle of the rectangle
  double radius = 0.0;         // mm; no surface point of the cell is farther from `middle`
};

inline constexpr int kMaxCellDepth = 48;  // halvings

// Halves the net of a piece. It allocates no memory after the first use.
class CellWalker {
 public:
  explicit CellWalker(const Surface& surface) : surface_(surface) {}

  // Visits `root` and, as long as visit(cell) returns true, the halves of the cell along its longer side,
  // depth first. So a cell is visited after its parent and before its parent's second half.
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
  bool Halve(int depth);              // halves the net in use at `depth`; returns true if along u
  void Choose(int depth, int which);  // uses half `which` at depth + 1

  const Surface& surface_;
  NetShape shape_;
  std::vector<std::vector<Vec4>> nets_;  // [depth]: the nets of both halves
  std::vector<const Vec4*> in_use_;      // [depth]
  std::vector<Vec3> hull_;
};

// The root cells: all pieces in their order, halved until no cell is wider than `size` mm. Incomplete if
// `run` is cancelled.
std::vector<CellRect> RootCells(const Surface& surface, double size, const RunContext& run);

// The area of the surface, mm^2, estimated from 4 x 4 samples of each piece. Use it only to choose cell
// sizes.
double RoughArea(const Surface& surface);

}  // namespace patchmill
