// What stays over some places: LeftoverSearch of points alone.
#pragma once

#include <span>

#include "cam/region/leftover.h"
#include "core/base/status.h"

namespace patchmill::testing {

// `normals`: as many, or none.
inline Deepest DeepestLeftover(const Locator& locator, const LeftoverParams& params,
                               std::span<const Vec3> places, const RunContext& run,
                               std::span<const Vec3> normals = {}) {
  PM_CHECK(normals.empty() || normals.size() == places.size());
  LeftoverSearch search(locator, params);
  for (std::size_t i = 0; i < places.size(); ++i) {
    search.AddPoint(places[i], normals.empty() ? Vec3(Vec3::Zero()) : normals[i]);
  }
  return search.Find(run);
}

}  // namespace patchmill::testing
