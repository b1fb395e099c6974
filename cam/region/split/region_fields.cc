#include "cam/region/split/region_fields.h"

#include <algorithm>

#include "cam/region/split/limit_follower.h"
#include "cam/region/split/reach_limits.h"
#include "core/diffgeo/forms.h"
#include "core/lines/line_fields.h"

namespace patchmill {
namespace {

// In R: smallest cell of the split. The ball does not feel smaller shapes.
constexpr double kMinCell = 0.06;

}  // namespace

std::vector<ZeroField> RegionFields(const ReachTest& reach, const RegionParams& params) {
  std::vector<ZeroField> fields(kFieldCount);
  const auto at = [&](Field field) -> ZeroField& { return fields[static_cast<std::size_t>(field)]; };
  at(Field::kTurn) = SilhouetteField();
  at(Field::kSlope) = SlopeField(params.steep_angle);
  at(Field::kCurvature) = ContourCurvatureField();
  ZeroField& free = at(Field::kFree);
  free.smooth = false;
  free.resolution = params.border_tolerance;
  free.value = [&reach](const SurfaceJet& jet) {
    const auto facing = FacingAt(jet);
    return !facing ? 0.0 : reach.Free(jet.p, *facing) ? 1.0 : -1.0;
  };
  free.values = [&reach](std::span<const SurfaceJet> jets, std::span<double> values) {
    reach.FreeAt(jets, values);
  };
  free.limits = [&reach, exact = free.resolution](const Piece& piece, std::span<const ZeroSegment> segments,
                                                  std::span<double> limits) {
    ReachLimits(reach, piece, segments, exact, limits);
  };
  free.follow = [&reach, exact = free.resolution](const Piece& piece) {
    return [follower = LimitFollower(reach, piece, exact)](const ZeroSegment& chord, const Vec2& across,
                                                           double least, double most) mutable {
      return follower.Find(chord, across, least, most);
    };
  };
  ZeroField& above = at(Field::kAbove);
  above.smooth = false;
  above.resolution = params.border_tolerance;
  above.where = static_cast<int>(Field::kFree);
  above.value = [&reach](const SurfaceJet& jet) {
    const auto facing = FacingAt(jet);
    return !facing ? 0.0 : reach.BlockedAbove(jet.p, *facing) ? -1.0 : 1.0;
  };
  above.values = [&reach](std::span<const SurfaceJet> jets, std::span<double> values) {
    reach.BlockedAboveAt(jets, values);
  };
  at(Field::kFloor).value = [&reach](const SurfaceJet& jet) {
    const auto normal = UpwardNormal(jet);
    return !normal ? 0.0 : reach.OverFloor(jet.p, *normal);
  };
  ZeroField& allowed = at(Field::kAllowed);
  allowed.smooth = false;
  allowed.resolution = params.border_tolerance;
  allowed.value = [&reach, any = params.operation_limits != nullptr](const SurfaceJet& jet) {
    if (!any) return 1.0;
    const auto facing = FacingAt(jet);
    return !facing ? 0.0 : reach.Allowed(jet.p, *facing) ? 1.0 : -1.0;
  };
  ZeroField& outside = at(Field::kOutside);
  outside.smooth = false;
  outside.resolution = params.border_tolerance;
  outside.where = static_cast<int>(Field::kAllowed);
  outside.value = [&reach, any = params.operation_limits != nullptr &&
                                 params.operation_limits->HasBeside()](const SurfaceJet& jet) {
    if (!any) return 1.0;
    const auto facing = FacingAt(jet);
    return !facing ? 0.0 : reach.ForbiddenBesidePart(jet.p, *facing) ? -1.0 : 1.0;
  };
  ZeroField& shank = at(Field::kShank);
  shank.smooth = false;
  shank.resolution = params.border_tolerance;
  shank.where = static_cast<int>(Field::kAllowed);
  shank.value = [&reach](const SurfaceJet& jet) {
    const auto facing = FacingAt(jet);
    return !facing ? 0.0 : reach.BlockedByShank(jet.p, *facing) ? -1.0 : 1.0;
  };
  ZeroField& holder = at(Field::kHolder);
  holder.smooth = false;
  holder.resolution = params.border_tolerance;
  holder.where = static_cast<int>(Field::kAllowed);
  holder.value = [&reach, any = params.operation_limits != nullptr &&
                                params.operation_limits->HasHolder()](const SurfaceJet& jet) {
    if (!any) return 1.0;
    const auto facing = FacingAt(jet);
    return !facing ? 0.0 : reach.BlockedByHolder(jet.p, *facing) ? -1.0 : 1.0;
  };
  // The floor and all labels of reachable areas count only where the ball is free.
  at(Field::kFinished).value = params.finished;
  for (const Field field :
       {Field::kFloor, Field::kTurn, Field::kSlope, Field::kCurvature, Field::kFinished}) {
    at(field).where = static_cast<int>(Field::kFree);
    at(field).where_sign = 1;
  }
  if (params.finished) return fields;
  fields.pop_back();
  if (params.operation_limits != nullptr && params.operation_limits->HasUppers()) return fields;
  fields.pop_back();
  fields.pop_back();
  if (params.operation_limits == nullptr) {
    fields.pop_back();
    fields.pop_back();
  }
  return fields;
}

std::vector<ZeroField> ReachFields(const ReachTest& reach, const RegionParams& params) {
  std::vector<ZeroField> fields = RegionFields(reach, params);
  fields.resize(static_cast<std::size_t>(Field::kFloor) + 1);
  ZeroField& above = fields[static_cast<std::size_t>(Field::kAbove)];
  above.value = [](const SurfaceJet&) { return 1.0; };
  above.values = {};
  return fields;
}

ZeroMeshParams RegionMeshParams(const Surface& surface, const RegionParams& params, double part,
                                const RunContext& run) {
  ZeroMeshParams p;
  p.run = &run;
  p.max_turn = 0.7;
  p.skip_negligible = true;
  p.max_cell = std::max(0.6 * params.radius, part * surface.box.Diagonal());
  p.min_cell = kMinCell * params.radius;
  return p;
}

SplitLabel LabelOf(const ZeroTriangle& triangle) {
  const auto sign = [&](Field field) { return triangle.sign[static_cast<std::size_t>(field)]; };
  SplitLabel label;
  if (sign(Field::kFree) < 0) {
    label.reason = sign(Field::kAbove) < 0 ? UnreachableReason::kUndercut : UnreachableReason::kConcave;
  } else if (sign(Field::kAllowed) < 0 && sign(Field::kOutside) < 0) {
    label.reason = UnreachableReason::kOutside;
  } else if (sign(Field::kFloor) < 0) {
    label.reason = UnreachableReason::kFloor;
  } else if (sign(Field::kAllowed) < 0) {
    label.reason = sign(Field::kHolder) < 0  ? UnreachableReason::kHolder
                   : sign(Field::kShank) < 0 ? UnreachableReason::kShank
                                             : UnreachableReason::kAvoided;
  } else if (sign(Field::kFinished) < 0) {
    label.reason = UnreachableReason::kStrategy;
  }
  if (label.reason != UnreachableReason::kNone) return label;
  label.curvature = static_cast<std::int8_t>(sign(Field::kTurn) * sign(Field::kCurvature));
  label.steep = sign(Field::kSlope) < 0;
  return label;
}

}  // namespace patchmill
