// The .bv format: BezierView text.
#pragma once

#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "core/network/patch_model.h"

namespace patchmill {

// Patches follow one another until the text ends. Each starts with its kind:
//   3  Bezier triangle: degree, then its points row after row from the bottom edge
//   4  tensor Bezier, one degree for both directions; v fastest
//   5  tensor Bezier: degree-u degree-v; v fastest
//   8  rational tensor Bezier: degrees, then `wx wy wz w` per point (already multiplied by the weight)
// A line `Group n name` before a patch is skipped. Kind 1 (polygon mesh) is refused by name. All errors are
// INVALID_ARGUMENT "line 12: reason". Cost O(text); memory is a small multiple of the text.
absl::StatusOr<PatchModel> ReadBv(std::string_view text);

// Writes the kinds 3, 5 and 8. `digits` is the number of significant digits; 17 keep every double (of a
// rational patch, the products). INVALID_ARGUMENT for B-splines, Gregory quads and rational triangles.
absl::StatusOr<std::string> WriteBv(const PatchModel& model, int digits = 17);

}  // namespace patchmill
