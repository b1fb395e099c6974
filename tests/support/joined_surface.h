// A model with its network and surface, for tests that look at topology too (borders, neighbours).
#pragma once

#include "core/base/status.h"
#include "core/surface/surface.h"

namespace patchmill::testing {

inline Surface JoinedSurface(PatchModel model, const SurfaceParams& params = {}) {
  absl::StatusOr<PatchNetwork> network = BuildNetwork(std::move(model));
  PM_CHECK(network.ok());
  absl::StatusOr<Surface> surface = BuildSurface(*std::move(network), params, RunContext(1));
  PM_CHECK(surface.ok());
  return *std::move(surface);
}

}  // namespace patchmill::testing
