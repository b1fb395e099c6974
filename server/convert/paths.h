// The motion of a program as messages, for drawing and simulation.
#pragma once

#include <functional>
#include <variant>

#include "cam/toolpath/toolpath.h"
#include "patchmill/v1/toolpath.pb.h"

namespace patchmill {

using PathEvent = std::variant<v1::PathChunk, v1::ArcMove>;

// Emits the motion in order: straight moves in chunks of at most limits::kPathChunkPoints points, each arc by
// itself. `zero` is program zero in the placed frame, mm. Stops and returns false if `emit` returns false.
bool EmitPaths(const Toolpath& toolpath, const Vec3& zero, const std::function<bool(PathEvent)>& emit);

}  // namespace patchmill
