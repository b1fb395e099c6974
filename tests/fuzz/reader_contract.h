// What every reader of model text owes whatever bytes it is given. Used by the fuzz targets and by the replay
// of their corpus in tests/core/io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "core/network/control_points.h"
#include "core/network/patch_network.h"

namespace patchmill {

// Either INVALID_ARGUMENT "line N: ..." in at most 400 printable bytes, or a sound model no larger than the
// text can spell; a small one also goes through BuildNetwork, which must accept it.
inline bool KeepsReaderContract(std::string_view text, const absl::StatusOr<PatchModel>& model) {
  if (!model.ok()) {
    const std::string message(model.status().message());
    for (const char c : message) {
      if (c < 0x20 || c > 0x7e) return false;
    }
    return model.status().code() == absl::StatusCode::kInvalidArgument && message.substr(0, 5) == "line " &&
           message.size() <= 400;
  }
  if (!ValidateModel(*model).empty()) return false;
  std::size_t points = 0;
  for (const Patch& patch : model->patches) points += ControlPoints(patch.shape).size();
  if (points * 6 > text.size() + 1) return false;  // "0 0 0 " is the shortest point
  return points > 2000 || BuildNetwork(*model).ok();
}

}  // namespace patchmill
