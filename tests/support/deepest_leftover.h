// What stays over some places: LeftoverSearch of points alone.
#pragma once

#include <span>

#include "cam/region/figures/leftover.h"
#include "core/base/status.h"

namespace patchmill::testing {

// `normals`: as many, or none.
inline Deepest DeepestLeftover(const Locator& locator, const LeftoverParams& params,
                               std::span<const Vec3> places, const RunContext& run,
                               std::span<const Vec3> normals = {}) {
  PM_CHECK(normals.empty() || normals.size() == places.size());
  LeftoverSearch search(locator, params);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool none = normals.empty() || normals[i].isZero();
    search.AddPoint(places[i], none ? std::nullopt
                                    : std::optional(Facing{normals[i], normals[i].z() <= kUprightFace,
                                                           normals[i].z() <= kUprightFace}));
  }
  return search.Find(run);
}

}  // namespace patchmill::testing
