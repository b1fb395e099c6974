// v1.PatchModel <-> PatchModel (mm).
#pragma once

#include <absl/status/statusor.h>

#include "core/base/diagnostic.h"
#include "core/base/run_context.h"
#include "core/joining/curve_network.h"
#include "core/network/patch_model.h"
#include "patchmill/v1/model.pb.h"

namespace patchmill {

// The unit in mm. Nothing for an unspecified or unknown unit.
std::optional<double> MillimetersPer(v1::LengthUnit unit);
// What is wrong with a unit for which MillimetersPer is empty.
std::string UnitFault(v1::LengthUnit unit);

// A model and all its faults. The model may be used only if `faults` is empty.
struct CheckedModel {
  PatchModel model;
  Diagnostics faults;
  Diagnostics remarks;  // warnings; empty if there are faults
};

// Reads a model. `at` is its path in the request. RESOURCE_EXHAUSTED for a limit; limits are checked before
// anything is copied. INVALID_ARGUMENT for a missing length_unit. The errors of `run` while a network is
// joined. Everything else is a fault of a patch.
absl::StatusOr<CheckedModel> FromProto(const v1::PatchModel& proto, std::string_view at,
                                       const RunContext& run = {});

// The network of a model as the client sent it.
struct CheckedNetwork {
  CurveNetwork network;  // mm
  double unit = 1.0;     // length unit of the message in mm
  Diagnostics faults;    // of the message; the network may be used only if empty
};
// Errors as FromProto, and INVALID_ARGUMENT for a model without network.
absl::StatusOr<CheckedNetwork> NetworkFromProto(const v1::PatchModel& proto, std::string_view at);

// The message of a model, in millimetres.
v1::PatchModel ToProto(const PatchModel& model);

}  // namespace patchmill
