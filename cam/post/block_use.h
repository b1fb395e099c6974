// Checks that each word of a block has a use. A word without one was meant for something that the reader of
// programs does not know.
#pragma once

#include <absl/status/status.h>

#include "cam/post/dialect.h"
#include "cam/post/gcode_modes.h"

namespace patchmill {

inline bool IsArc(int motion_code) { return motion_code == 20 || motion_code == 30; }
inline bool IsCycle(int motion_code) {
  return motion_code == 730 || (motion_code >= 810 && motion_code <= 830);
}
// G28 or G30.
inline bool IsReference(const BlockModes& block) {
  const int code = block.once.value_or(0);
  return code == 280 || code == 300;
}
inline bool HasAxis(const BlockModes& block) { return block['X'] || block['Y'] || block['Z']; }
inline bool HasCenter(const BlockModes& block) {
  return block['I'] || block['J'] || block['K'] || block['R'];
}

// `motion_code` is the motion in force before the block. INVALID_ARGUMENT (without the line number) names the
// first word without a use.
absl::Status CheckUse(const BlockModes& block, int motion_code, const Dialect& dialect);

}  // namespace patchmill
