// v1.PatchModel <-> PatchModel (mm).
#pragma once

#include <absl/status/statusor.h>

#include "core/base/diagnostic.h"
#include "core/base/run_context.h"
#include "core/joining/curve_network.h"
#include "core/network/patch_model.h"
#include "patchmill/v1/model.pb.h"

namespace patchmill {

// mm of one unit; nothing for an unspecified or unknown one.
std::optional<double> MillimetersPer(v1::LengthUnit unit);

// A model and everything that is wrong with it, all at once; the model may be used only when `faults` is
// empty.
struct CheckedModel {
  PatchModel model;
  Diagnostics faults;
  Diagnostics remarks;  // warnings; none beside faults
};

// RESOURCE_EXHAUSTED for a limit, checked before anything is copied; INVALID_ARGUMENT for a missing
// length_unit; those of `run` while a network is joined. Everything else is a fault of a patch. `at` is the
// path of the model in its request.
absl::StatusOr<CheckedModel> FromProto(const v1::PatchModel& proto, std::string_view at,
                                       const RunContext& run = {});

// The network of a model as it is sent.
struct CheckedNetwork {
  CurveNetwork network;  // mm
  double unit = 1.0;     // mm of one of the message's
  Diagnostics faults;    // of the wire; the network may be used only when empty
};
// Errors as above; INVALID_ARGUMENT for a model without network, too.
absl::StatusOr<CheckedNetwork> NetworkFromProto(const v1::PatchModel& proto, std::string_view at);

// The other way, in millimetres.
v1::PatchModel ToProto(const PatchModel& model);

}  // namespace patchmill
