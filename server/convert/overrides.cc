#include "server/convert/overrides.h"

#include <cmath>

#include <fmt/format.h>

#include "server/convert/enums.h"
#include "server/convert/fields.h"
#include "server/convert/setup.h"
#include "server/limits.h"

namespace patchmill {
namespace {

RegionOverride ReadOverride(const v1::RegionOverride& proto, const std::string& at, double radius,
                            FieldErrors& errors) {
  RegionOverride change;
  change.region = RegionId(proto.region_id());
  if (proto.has_at()) {
    change.region = kNoRegion;
    change.at = ReadPoint(proto.at(), At(at, "at"), errors);
    if (proto.region_id() != 0) errors.Add(At(at, "region_id"), "is set together with at; set one of them");
  } else if (proto.region_id() < 0) {
    errors.Add(At(at, "region_id"), fmt::format("= {}; must be at least 0", proto.region_id()));
  }
  change.skip = proto.skip();
  if (proto.strategy() != v1::STRATEGY_UNSPECIFIED) {
    change.strategy = FromProto(proto.strategy(), At(at, "strategy"), errors);
  }
  if (proto.has_zigzag_angle_deg()) {
    const double angle = proto.zigzag_angle_deg();
    Require(errors, At(at, "zigzag_angle_deg"), angle, std::abs(angle) <= 360.0, "in [-360, 360]");
    change.zigzag_angle = Radians(angle);
  }
  if (proto.has_one_way_lines()) change.one_way = proto.one_way_lines();
  if (proto.has_scallop_mm()) {
    change.scallop = proto.scallop_mm();
    Require(errors, At(at, "scallop_mm"), *change.scallop, *change.scallop > 0.0 && *change.scallop < radius,
            fmt::format("in (0, ball radius = {:.10g})", radius));
  }
  if (change.skip && (change.strategy || change.zigzag_angle || change.one_way || change.scallop)) {
    errors.Add(At(at, "skip"), "is set together with how to cut the region; set one of them");
  }
  return change;
}

}  // namespace

void ReadOverrides(const std::string& regions_sha256,
                   const google::protobuf::RepeatedPtrField<v1::RegionOverride>& overrides,
                   std::string_view at, Operation& op, FieldErrors& errors) {
  constexpr std::size_t kDigest = 32;
  if (!regions_sha256.empty() && regions_sha256.size() != kDigest) {
    errors.Add(At(at, "regions_sha256"),
               fmt::format("has {} bytes; must have {}", regions_sha256.size(), kDigest));
  }
  op.regions_sha256 = regions_sha256;
  if (overrides.size() > limits::kMaxRegionOverrides) {
    errors.Add(At(at, "region_overrides"), fmt::format("has {} elements; must have at most {}",
                                                       overrides.size(), limits::kMaxRegionOverrides));
    return;
  }
  const double radius = BallRadius(op.tool);
  bool by_id = false;
  for (int i = 0; i < overrides.size(); ++i) {
    const std::string path = fmt::format("{}[{}]", At(at, "region_overrides"), i);
    op.overrides.push_back(ReadOverride(overrides[i], path, radius, errors));
    by_id = by_id || !overrides[i].has_at();
  }
  if (by_id && regions_sha256.empty()) {
    errors.Add(At(at, "regions_sha256"), "is missing; required when region_overrides name regions by id");
  }
}

v1::RegionOverride ToProto(const RegionOverride& change) {
  v1::RegionOverride proto;
  if (change.at) {
    *proto.mutable_at() = ToProto(*change.at);
  } else {
    proto.set_region_id(change.region.value);
  }
  if (change.skip) proto.set_skip(true);
  if (change.strategy) proto.set_strategy(ToProto(*change.strategy));
  if (change.zigzag_angle) proto.set_zigzag_angle_deg(Degrees(*change.zigzag_angle));
  if (change.one_way) proto.set_one_way_lines(*change.one_way);
  if (change.scallop) proto.set_scallop_mm(*change.scallop);
  return proto;
}

}  // namespace patchmill
