// Surfaces that stay in the store from call to call.
#pragma once

#include <memory>
#include <string>

#include <absl/status/statusor.h>

#include "cam/plan/plan.h"
#include "server/model_source.h"

namespace patchmill {

// The surface of a model as placed by a setup (BuildPlacedSurface). `digest` is that of the model
// (LoadedModel). A caller who has had the same model built in the same placement gets that surface. Else it
// is built and put into `access.store`, if there is one. The errors are those of BuildPlacedSurface.
absl::StatusOr<std::shared_ptr<const Surface>> PlacedSurface(PatchModel model, const std::string& digest,
                                                             const Setup& setup, const RunContext& run,
                                                             const ModelAccess& access);

}  // namespace patchmill
