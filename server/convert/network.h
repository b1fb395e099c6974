// v1.CurveNetwork -> CurveNetwork (mm).
#pragma once

#include <absl/status/status.h>

#include "core/base/diagnostic.h"
#include "core/joining/curve_network.h"
#include "patchmill/v1/network.pb.h"

namespace patchmill {

// RESOURCE_EXHAUSTED for a network larger than server/limits.h allows; before anything is copied.
absl::Status CheckNetworkLimits(const v1::CurveNetwork& proto);

// `unit`: mm of one length unit. What only the wire can get wrong is a fault: a vector without three numbers,
// a point list of odd length, an enum this server does not know. The rest is JoinNetwork's.
CurveNetwork FromProto(const v1::CurveNetwork& proto, double unit, Diagnostics& faults);

}  // namespace patchmill
