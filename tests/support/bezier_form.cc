#include "tests/support/bezier_form.h"

#include <utility>

#include "core/patch/piece.h"

namespace patchmill::testing {

PatchModel BezierForm(const PatchModel& model) {
  PatchModel out;
  for (const Patch& patch : model.patches) {
    if (!std::holds_alternative<BsplinePatch>(patch.shape)) {
      out.patches.push_back({"", patch.shape});
      continue;
    }
    for (const Piece& piece : SplitIntoPieces(PatchId(0), patch.shape)) {
      BezierPatch bezier{piece.net.degree_u, piece.net.degree_v, {}, {}};
      for (const Vec4& p : piece.net.points) {
        bezier.points.push_back(p.head<3>() / p.w());
        if (piece.net.rational) bezier.weights.push_back(p.w());
      }
      out.patches.push_back({"", std::move(bezier)});
    }
  }
  return out;
}

}  // namespace patchmill::testing
