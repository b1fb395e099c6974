#include "cam/region/map/regions_digest.h"

namespace patchmill {

std::string RegionsDigest(const RegionMap& map) {
  Canonical out;
  out.Add("patchmill regions 1").Add(static_cast<std::int64_t>(map.regions.size()));
  for (const Region& region : map.regions) {
    out.Add(std::int64_t{region.id.value}).Add(static_cast<std::int64_t>(region.kind));
    // An override of a region removes its kStrategy; the digest must stay the same.
    const bool forced = region.reason == UnreachableReason::kStrategy;
    out.Add(static_cast<std::int64_t>(region.slope));
    out.Add(static_cast<std::int64_t>(forced ? UnreachableReason::kNone : region.reason));
    out.Add(static_cast<std::int64_t>(region.border.size()));
    for (const auto& loop : region.border) {
      out.Add(static_cast<std::int64_t>(loop.size()));
      for (const Vec3& p : loop) out.Add(p.x()).Add(p.y()).Add(p.z());
    }
  }
  return out.Digest();
}

}  // namespace patchmill
