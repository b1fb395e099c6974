// Limits on the lists of a request or of a model file, checked before it is parsed.
#pragma once

#include <cstddef>

#include "server/wire_count.h"

namespace patchmill {

// Limits for messages of patchmill.v1. They are looser than those of the converters, whose errors name the
// fields better. A request that passes costs at most `memory_bytes`; it may still be wrong.
WireLimits ListLimits(std::size_t memory_bytes);

}  // namespace patchmill
