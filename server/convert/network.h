// v1.CurveNetwork -> CurveNetwork (mm).
#pragma once

#include <absl/status/status.h>

#include "core/base/diagnostic.h"
#include "core/joining/curve_network.h"
#include "patchmill/v1/network.pb.h"

namespace patchmill {

// RESOURCE_EXHAUSTED for a network larger than server/limits.h allows. Call it before anything is copied.
absl::Status CheckNetworkLimits(const v1::CurveNetwork& proto);

// Reads a network. `unit` is the length unit in mm. Faults that only a message can have are added to the
// faults: a vector without three numbers, a list of points of the wrong length, an enum that this server
// does not know. JoinNetwork finds the other faults.
CurveNetwork FromProto(const v1::CurveNetwork& proto, double unit, Diagnostics& faults);

}  // namespace patchmill
