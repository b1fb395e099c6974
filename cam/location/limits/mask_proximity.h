// How near a part of the surface is. Used for passes that overrun its border.
#pragma once

#include <cstdint>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/limits/surface_mask.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// Balls around the cells along the border of a mask, in a tree. The sides of a piece count as border.
// Thread-safe.
class MaskProximity {
 public:
  // Cost: nine surface points per cell of the border. CANCELLED and DEADLINE_EXCEEDED from `run`.
  static absl::StatusOr<MaskProximity> Make(const Surface& surface, const SurfaceMask& mask,
                                            const RunContext& run);

  // Whether some point of these cells may lie within `distance` (mm) of p. True is exact up to the size of a
  // cell. False assumes that no cell reaches beyond nine of its points by more than a tenth of their span.
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
