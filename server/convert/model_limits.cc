#include "server/convert/model_limits.h"

#include <algorithm>
#include <span>
#include <string>

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/patch/patch.h"
#include "core/patch/split_pieces.h"
#include "server/convert/fields.h"
#include "server/convert/network.h"
#include "server/limits.h"

namespace patchmill {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

std::size_t Count(const Numbers& numbers) { return static_cast<std::size_t>(numbers.size()); }

std::span<const double> View(const Numbers& numbers) { return {numbers.data(), Count(numbers)}; }

struct Sizes {
  std::size_t points = 0, knots = 0;
};

// Control points that a Hosaka patch counts as. A few breaks cut a patch into many pieces, so the points of
// all pieces count.
std::size_t HosakaPoints(const v1::HosakaPatch& patch) {
  std::size_t columns = 1, rows = 1;
  for (const v1::HosakaBreak& b : patch.breaks()) ++(b.side() % 2 == 0 ? columns : rows);
  const auto across = static_cast<std::size_t>(std::clamp(patch.degree() + 4, 7, kMaxDegree + 1));
  return std::max(Count(patch.points()) / 3, columns * rows * across * across);
}

// As HosakaPoints; the knots cut the patch.
std::size_t BsplinePoints(const v1::BsplinePatch& patch) {
  return std::max(Count(patch.points()) / 3,
                  CountSplinePiecePoints({patch.degree_u(), View(patch.knots_u())},
                                         {patch.degree_v(), View(patch.knots_v())}));
}

// As HosakaPoints: each bulge cuts a patch both ways. What the patch has without them is `plain`.
std::size_t WithBulges(const v1::Patch& patch, std::size_t plain) {
  const auto bulges = static_cast<std::size_t>(patch.bulges_size());
  return bulges == 0 ? plain : plain + (bulges + 1) * (bulges + 1) * 64 + 2 * bulges * plain;
}

// As HosakaPoints.
std::size_t BrownPoints(const v1::BrownPatch& patch) {
  const std::size_t pieces = (Count(patch.breaks_u()) + 1) * (Count(patch.breaks_v()) + 1);
  if (pieces == 1) return Count(patch.points()) / 3;
  const auto across = [](int degree) {
    return static_cast<std::size_t>(std::clamp(degree, 3, kMaxBrownDegree) + 5);
  };
  return std::max(Count(patch.points()) / 3, pieces * across(patch.degree_u()) * across(patch.degree_v()));
}

Sizes SizesOf(const v1::Patch& patch) {
  switch (patch.shape_case()) {
    case v1::Patch::kBezier:
      return {Count(patch.bezier().points()) / 3, 0};
    case v1::Patch::kBspline:
      return {BsplinePoints(patch.bspline()),
              Count(patch.bspline().knots_u()) + Count(patch.bspline().knots_v())};
    case v1::Patch::kGregory:
      return {Count(patch.gregory().points()) / 3, 0};
    case v1::Patch::kTriangle:
      return {Count(patch.triangle().points()) / 3, 0};
    case v1::Patch::kBrown:
      return {BrownPoints(patch.brown()), Count(patch.brown().breaks_u()) + Count(patch.brown().breaks_v())};
    case v1::Patch::kGregoryTriangle:
      return {Count(patch.gregory_triangle().points()) / 3, 0};
    case v1::Patch::kLoftTriangle:
      return {Count(patch.loft_triangle().points()) / 3, 0};
    case v1::Patch::kG2Gregory:
      return {Count(patch.g2_gregory().points()) / 3, 0};
    case v1::Patch::kHosaka:
      return {HosakaPoints(patch.hosaka()), static_cast<std::size_t>(patch.hosaka().breaks_size())};
    case v1::Patch::SHAPE_NOT_SET:
      break;
  }
  return {};
}

// Explains why a patch counts as more points than it has.
std::string NoteOn(const v1::Patch& patch, int index, std::size_t points) {
  if (patch.shape_case() != v1::Patch::kBspline || points <= Count(patch.bspline().points()) / 3) return "";
  return fmt::format(
      "patches[{}].bspline counts as {}, the control points of its Bezier pieces: one piece for each "
      "rectangle between distinct knots",
      index, points);
}

}  // namespace

absl::Status CheckLimits(const v1::PatchModel& proto) {
  const auto patches = static_cast<std::size_t>(proto.patches_size());
  if (patches > limits::kMaxPatches) {
    return LimitError("model.patch_count", limits::kMaxPatches, static_cast<double>(patches));
  }
  PM_RETURN_IF_ERROR(CheckNetworkLimits(proto.network()));
  Sizes all;
  std::size_t most = 0;
  int largest = 0;
  for (int i = 0; i < proto.patches_size(); ++i) {
    Sizes sizes = SizesOf(proto.patches(i));
    sizes.points = WithBulges(proto.patches(i), sizes.points);
    all.points += sizes.points;
    all.knots += sizes.knots;
    if (sizes.points <= most) continue;
    most = sizes.points;
    largest = i;
  }
  if (all.points > limits::kMaxControlPoints) {
    return LimitError("model.control_point_count", limits::kMaxControlPoints, static_cast<double>(all.points),
                      NoteOn(proto.patches(largest), largest, most));
  }
  if (all.knots > limits::kMaxKnots) {
    return LimitError("model.knot_count", limits::kMaxKnots, static_cast<double>(all.knots));
  }
  return absl::OkStatus();
}

}  // namespace patchmill
