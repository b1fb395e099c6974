// v1.FairCurveRequest -> CurveFairing, v1.FairNetRequest -> NetFairing, and results -> responses.
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
  std::string title;  // title of the file, or empty
  bool planar = false;
  std::optional<double> polyline_tolerance;
};

// INVALID_ARGUMENT lists all wrong fields, or states line and reason of a fault in the file.
// RESOURCE_EXHAUSTED for a limit.
absl::StatusOr<FairingOrder> FromProto(const v1::FairCurveRequest& request);

// Fills everything but the picture. RESOURCE_EXHAUSTED if the polyline has more than
// limits::kMaxPolylinePoints points.
absl::Status Fill(const FairingOrder& order, const FairedCurve& faired, v1::FairCurveResponse* response);

struct NetFairingOrder {
  NetFairing net;
  std::string title;
  bool planar = false;
};

// Errors as for a curve.
absl::StatusOr<NetFairingOrder> FromProto(const v1::FairNetRequest& request);
void Fill(const NetFairingOrder& order, const FairedNet& faired, v1::FairNetResponse* response);

}  // namespace patchmill
