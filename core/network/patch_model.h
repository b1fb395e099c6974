// The model as given by a client or a file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/diagnostic.h"
#include "core/base/typed_id.h"
#include "core/network/model_face.h"
#include "core/patch/patch.h"

namespace patchmill {

// Limits of a model. ValidateModel refuses a model beyond them.
inline constexpr int kMaxPatches = 100'000;
inline constexpr int kMaxControlPoints = 10'000'000;  // of all patches together
inline constexpr double kMaxCoordinate = 1e9;         // |x|, |y|, |z|
inline constexpr double kMinExtent = 1e-9;  // of the box diagonal; also 1e-9 of the largest coordinate
inline constexpr double kMinWeight = 1e-9;  // homogeneous sums keep 1e-12 relative between these two
inline constexpr double kMaxWeight = 1e9;
inline constexpr double kMinJoinTolerance = 1e-9;  // of the box diagonal
inline constexpr double kMaxJoinTolerance = 1e-2;
inline constexpr double kDefaultJoinTolerance = 1e-5;
inline constexpr double kMinKnotSpan = 1e-9;  // of the domain: distinct knots closer than that are a fault

struct PatchModel {
  std::vector<Patch> patches;
  std::optional<double> join_tolerance;  // length unit of the points; default kDefaultJoinTolerance
  std::vector<ModelFace> faces;          // that patches are parts of; may be empty
};

// Whether the patch is a part of a face that is skipped.
bool IsSkipped(const PatchModel& model, PatchId patch);
// The place of a finding about a patch: the patch's id, its index and the id of its face.
Where WhereOf(const PatchModel& model, PatchId patch);
// "face f12 (pocket floor)" or "face f12" for a part of a face, else "patch 7 (lid)" or "patch 7".
std::string Title(const PatchModel& model, PatchId patch);

// How the model lies on the machine: it is scaled, then turned, then translated ([machining M3]).
enum class UpAxis { kZ, kY, kX, kNegZ, kNegY, kNegX };
const char* Name(UpAxis axis);  // "z", "-y"
struct Placement {
  double scale = 1.0;  // > 0
  UpAxis up = UpAxis::kZ;
  Vec3 translation = Vec3::Zero();
  std::optional<Mat3> turn = std::nullopt;  // a rotation, in place of `up`
};
Vec3 Place(const Placement& placement, const Vec3& p);
// The box of the placed box: exactly that of the placed points, unless they are turned by a rotation.
Box3 Place(const Placement& placement, const Box3& box);
// All control points placed, and join_tolerance scaled with them. This is exact but for rounding, because
// all kinds are affine-invariant. Radii of faces are scaled. A model that is moved in is placed in its own
// memory.
PatchModel Place(const Placement& placement, PatchModel model);

// Finds everything that makes a single patch unusable: sizes, degrees, knots, weights, finite numbers,
// magnitude. There is one error diagnostic per kind of fault and patch, with patch index, field path and
// reason (the first bad point of a patch stands for all of them), at most 1000. It is empty if the model is
// sound. Cost O(points). Codes: PATCH_COUNT, POINT_COUNT, WEIGHT_COUNT, INVALID_DEGREE, INVALID_KNOTS,
// INVALID_WEIGHT, NOT_FINITE, TOO_LARGE, ZERO_EXTENT, DUPLICATE_ID, INVALID_JOIN_TOLERANCE, INVALID_BREAKS,
// INVALID_BULGE, INVALID_FACE.
Diagnostics ValidateModel(const PatchModel& model);

Box3 ControlBox(const PatchModel& model);  // of all control points

}  // namespace patchmill
