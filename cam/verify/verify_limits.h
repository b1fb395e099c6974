// Which patches are to be finished and where centres are allowed, for one call of Verify.
#pragma once

#include <optional>
#include <vector>

#include "cam/verify/reach.h"
#include "cam/verify/surface_cells.h"
#include "core/base/run_context.h"

namespace patchmill {

class VerifyLimits {
 public:
  // Keeps references to `surface` and `params`. Builds the avoided patches as a separate surface if a margin
  // is kept from them. CANCELLED and DEADLINE_EXCEEDED from `run`.
  static absl::StatusOr<VerifyLimits> Make(const Surface& surface, const Tool& tool,
                                           const VerifyParams& params, const RunContext& run);

  CenterLimits centers() const;  // valid as long as this object
  // The cells whose patches are to be finished.
  std::vector<CellRect> Wanted(const std::vector<CellRect>& cells) const;
  // The first piece of the whole surface that belongs to the same patch as this piece of the avoided patches.
  PieceId PieceOfWhole(PieceId avoided) const;

 private:
  VerifyLimits() = default;
  const Surface* surface_ = nullptr;
  const Containment* containment_ = nullptr;
  double ball_ = 0.0, tool_ = 0.0, leave_ = 0.0;
  std::vector<UpperCylinder> uppers_;
  std::optional<Surface> avoided_;
};

}  // namespace patchmill
