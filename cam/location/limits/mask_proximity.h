// Tells whether a place is near a part of the surface, for passes that overrun the border of the part.
#pragma once

#include <cstdint>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/limits/surface_mask.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// Keeps balls around the cells along the border of a mask, in a tree. Cells at the sides of a piece count as
// border cells. Thread-safe.
class MaskProximity {
 public:
  // Cost: nine surface points per cell of the border. CANCELLED and DEADLINE_EXCEEDED from `run`.
  static absl::StatusOr<MaskProximity> Make(const Surface& surface, const SurfaceMask& mask,
                                            const RunContext& run);

  // True if a point of the mask's border cells may lie within `distance` (mm) of p. It may be true although
  // the border is farther away, by the size of a cell at most. False relies on an assumption: no cell reaches
  // beyond its nine sample points by more than a tenth of their span.
  bool Within(const Vec3& p, double distance) const;

 private:
  struct Ball {
    Vec3 center;
    double radius;
  };
  struct Node {  // the left child is the next node, the right one is `right`; a leaf has balls [first, right)
    Box3 box;
    std::int32_t right = 0, first = -1;
  };
  void Build(std::size_t begin, std::size_t end);

  std::vector<Ball> balls_;
  std::vector<Node> nodes_;
};

}  // namespace patchmill
