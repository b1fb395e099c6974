#include "cam/verify/verify_limits.h"

#include <algorithm>

#include "core/base/status.h"
#include "core/surface/part.h"

namespace patchmill {

absl::StatusOr<VerifyLimits> VerifyLimits::Make(const Surface& surface, const Tool& tool,
                                                const VerifyParams& params, const RunContext& run) {
  VerifyLimits limits;
  limits.surface_ = &surface;
  limits.containment_ = &params.containment;
  limits.ball_ = BallRadius(tool);
  limits.tool_ = WidestRadius(tool);
  limits.leave_ = params.leave;
  limits.uppers_ = UpperCylindersOf(tool);
  const Containment& c = params.containment;
  const bool any = std::find(c.avoided.begin(), c.avoided.end(), true) != c.avoided.end();
  if (any && c.avoid_margin > params.leave) {
    PM_ASSIGN_OR_RETURN(Surface part, PartOf(surface, c.avoided, run));
    limits.avoided_.emplace(std::move(part));
  }
  return limits;
}

CenterLimits VerifyLimits::centers() const {
  CenterLimits limits;
  limits.containment = containment_;
  limits.ball = ball_;
  limits.tool = tool_;
  limits.uppers = uppers_;
  limits.upper_keep = leave_;
  if (!avoided_) return limits;
  limits.avoided = &*avoided_;
  limits.avoid_distance = ball_ + containment_->avoid_margin;
  return limits;
}

std::vector<CellRect> VerifyLimits::Wanted(const std::vector<CellRect>& cells) const {
  std::vector<CellRect> wanted;
  for (const CellRect& cell : cells) {
    const PatchId patch = surface_->piece(cell.piece).patch;
    if (IsWantedPatch(*containment_, patch)) wanted.push_back(cell);
  }
  return wanted;
}

PieceId VerifyLimits::PieceOfWhole(PieceId avoided) const {
  // The separate surface has the avoided patches in the order of the model.
  std::int32_t left = avoided_->piece(avoided).patch.value;
  for (std::size_t i = 0; i < containment_->avoided.size(); ++i) {
    if (containment_->avoided[i] && left-- == 0) return surface_->first_piece[i];
  }
  PM_CHECK(false);
  return {};
}

}  // namespace patchmill
