// What a request is, in 32 bytes: SHA-256 over resolved values in the server's own order, never over wire
// bytes.
#pragma once

#include <string>
#include <string_view>

#include "cam/plan/job.h"
#include "core/base/digest.h"
#include "core/network/patch_model.h"

namespace patchmill {

// Over units-resolved control points (mm), kinds, degrees, knots, weights and ids, in the order of the model.
std::string ModelDigest(const PatchModel& model);

// Over everything the program depends on, the model by its digest; not over threads, outputs or request ids.
std::string JobDigest(const Job& job, std::string_view model_digest, std::string_view name);

}  // namespace patchmill
