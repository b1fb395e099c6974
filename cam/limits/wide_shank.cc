#include "cam/limits/wide_shank.h"

#include <algorithm>

#include "cam/tool/tool.h"

namespace patchmill {

std::optional<WideShank> WideShankOf(const Tool& tool) {
  const double ball = BallRadius(tool), radius = 0.5 * tool.shank_diameter.value_or(0.0);
  if (!(radius > ball) || !tool.flute_length) return std::nullopt;
  return WideShank{radius, *tool.flute_length - ball};
}

double WidestRadius(const Tool& tool) {
  return std::max(BallRadius(tool), 0.5 * tool.shank_diameter.value_or(0.0));
}

}  // namespace patchmill
