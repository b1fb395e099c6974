// Polygon meshes in Wavefront's form (.obj).
#pragma once

#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/vec.h"

namespace patchmill {

inline constexpr int kMaxObjPoints = 400'000;
inline constexpr int kMaxObjFaces = 100'000;

struct ObjMesh {
  std::vector<Vec3> points;
  std::vector<std::vector<int>> faces;  // three or four points, from 0
};

// Reads lines "v x y z" (a fourth number is passed over) and "f a b c [d]", where a corner is "7", "7/1",
// "7/1/3", "7//3", or negative: counted back from the last point read. All other lines are passed over.
// INVALID_ARGUMENT "line 12: reason" for faces of more than four corners and for corners that do not exist.
absl::StatusOr<ObjMesh> ReadObj(std::string_view text);

}  // namespace patchmill
