// What of the surface is to be finished and where centres are allowed, for one judgement.
#pragma once

#include <optional>
#include <vector>

#include "cam/verify/reach.h"
#include "cam/verify/surface_cells.h"
#include "core/base/run_context.h"

namespace patchmill {

class VerifyLimits {
 public:
  // Keeps references to `surface` and `params`. Builds the avoided patches as a surface of their own when a
  // margin is kept from them. CANCELLED and DEADLINE_EXCEEDED from `run`.
  static absl::StatusOr<VerifyLimits> Make(const Surface& surface, const Tool& tool,
                                           const VerifyParams& params, const RunContext& run);

  CenterLimits centers() const;  // good as long as this object
  // Those cells whose patches are to be finished.
  std::vector<CellRect> Wanted(const std::vector<CellRect>& cells) const;
  // A piece of the avoided patches as a piece of the whole surface: the first one of its patch.
  PieceId PieceOfWhole(PieceId avoided) const;

 private:
  VerifyLimits() = default;
  const Surface* surface_ = nullptr;
  const Containment* containment_ = nullptr;
  double ball_ = 0.0, tool_ = 0.0, leave_ = 0.0;
  std::optional<WideShank> shank_;
  std::optional<Surface> avoided_;
};

}  // namespace patchmill
