// How near a part of the surface is: for passes that run on over its border.
#pragma once

#include <cstdint>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/limits/surface_mask.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// Balls around the cells along the border of a mask (a piece's sides count as border), in a tree.
// Thread-safe.
class MaskProximity {
 public:
  // Cost: nine surface points a cell of the border. CANCELLED and DEADLINE_EXCEEDED from `run`.
  static absl::StatusOr<MaskProximity> Make(const Surface& surface, const SurfaceMask& mask,
                                            const RunContext& run);

  // Some point of these cells may lie within `distance` (mm) of p. True up to a cell's size; false takes it
  // that no cell reaches beyond nine of its points by more than a tenth of what they span.
  bool Within(const Vec3& p, double distance) const;

 private:
  struct Ball {
    Vec3 center;
    double radius;
  };
  struct Node {  // left child next, right child at `right`; a leaf has balls [first, right)
    Box3 box;
    std::int32_t right = 0, first = -1;
  };
  void Build(std::size_t begin, std::size_t end);

  std::vector<Ball> balls_;
  std::vector<Node> nodes_;
};

}  // namespace patchmill
