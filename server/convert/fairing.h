// v1.FairCurveRequest -> CurveFairing, v1.FairNetRequest -> NetFairing, and what was faired back.
#pragma once

#include <optional>
#include <string>

#include <absl/status/statusor.h>

#include "core/fairing/fair_curve.h"
#include "core/fairing/fair_net.h"
#include "patchmill/v1/fairing.pb.h"

namespace patchmill {

struct FairingOrder {
  CurveFairing curve;
  std::string title;  // of the file, else empty
  bool planar = false;
  std::optional<double> polyline_tolerance;
};

// INVALID_ARGUMENT with all wrong fields, or the file's line and reason; RESOURCE_EXHAUSTED for a limit.
absl::StatusOr<FairingOrder> FromProto(const v1::FairCurveRequest& request);

// All but the picture. RESOURCE_EXHAUSTED when the polyline is longer than limits::kMaxPolylinePoints.
absl::Status Fill(const FairingOrder& order, const FairedCurve& faired, v1::FairCurveResponse* response);

struct NetFairingOrder {
  NetFairing net;
  std::string title;
  bool planar = false;
};

// As above.
absl::StatusOr<NetFairingOrder> FromProto(const v1::FairNetRequest& request);
void Fill(const NetFairingOrder& order, const FairedNet& faired, v1::FairNetResponse* response);

}  // namespace patchmill
