// Digests of requests: SHA-256 (32 bytes) over resolved values in the server's own order, never over the
// bytes of the message.
#pragma once

#include <string>
#include <string_view>

#include "cam/plan/job.h"
#include "core/base/digest.h"
#include "core/network/patch_model.h"

namespace patchmill {

// Digest over control points in mm, kinds, degrees, knots, weights and ids, in the order of the model.
std::string ModelDigest(const PatchModel& model);

// Digest over everything that the placed surface of a model depends on, with the model as its digest.
std::string PlacementDigest(const Setup& setup, std::string_view model_digest);

// Digest over everything that the program depends on, with the model as its digest. Threads, outputs and
// request ids are not part of it.
std::string JobDigest(const Job& job, std::string_view model_digest, std::string_view name);

}  // namespace patchmill
