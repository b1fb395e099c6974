// The .bv format: BezierView text.
#pragma once

#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "core/base/diagnostic.h"
#include "core/network/patch_model.h"

namespace patchmill {

// Patches follow one another until the text ends. Each starts with its kind:
//   3  Bezier triangle: degree, then its points row after row from the bottom edge
//   4  tensor Bezier, one degree for both directions; v fastest
//   5  tensor Bezier: degree-u degree-v; v fastest
//   8  rational tensor Bezier: degrees, then `wx wy wz w` per point (already multiplied by the weight)
//   11 rational Bezier triangle: degree, then `wx wy wz w` per point in the order of kind 3
// A line `Group n name` before a patch is skipped. Kind 1 is a polygon mesh. Beside patches it is read over,
// with the finding MESH_LEFT_OUT in `remarks` (may be null); alone it is refused by name. All errors are
// INVALID_ARGUMENT "line 12: reason". Cost O(text); memory is a small multiple of the text.
absl::StatusOr<PatchModel> ReadBv(std::string_view text, Diagnostics* remarks = nullptr);

// Writes the kinds 3, 5, 8 and 11. `digits` is the number of significant digits; 17 keep every double (of a
// rational patch, the products). INVALID_ARGUMENT for B-splines and Gregory patches.
absl::StatusOr<std::string> WriteBv(const PatchModel& model, int digits = 17);

}  // namespace patchmill
