// A model with its surface, for tests of what does not look at the network's topology.
#pragma once

#include "core/base/status.h"
#include "core/surface/surface.h"

namespace patchmill::testing {

inline Surface SurfaceOf(PatchModel model, const SurfaceParams& params = {}) {
  PatchNetwork network;
  network.model = std::move(model);
  absl::StatusOr<Surface> surface = BuildSurface(std::move(network), params, RunContext(1));
  PM_CHECK(surface.ok());
  return *std::move(surface);
}

}  // namespace patchmill::testing
