// How long the lists of a request, or of a model file, may be before it is parsed.
#pragma once

#include <cstddef>

#include "server/wire_count.h"

namespace patchmill {

// For messages of patchmill.v1. Looser than what the converters allow of each field, whose errors name the
// fields better: a request that passes here costs at most `memory_bytes`, and is not yet right.
WireLimits ListLimits(std::size_t memory_bytes);

}  // namespace patchmill
