// v1.ModelSource of any form -> PatchModel in millimetres.
#pragma once

#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "core/base/diagnostic.h"
#include "core/base/run_context.h"
#include "core/network/patch_model.h"
#include "patchmill/v1/model.pb.h"
#include "server/convert/model.h"
#include "server/in_flight.h"

namespace patchmill {

struct LoadedModel {
  PatchModel model;
  Diagnostics faults;     // of the patches; the model may be used only if empty
  Diagnostics remarks;    // warnings about a usable model; points in its own frame, mm
  bool unitless = false;  // neither the file nor the request states a unit
  bool network = false;   // the patches are those of a curve network
  std::string digest;     // SHA-256, 32 bytes
  std::string path;       // of the model in the request; for a file, of its content
};

// Loads a model. `at` is the path of the source in its request. INVALID_ARGUMENT if it cannot be read (with
// line and reason), NOT_FOUND for a digest, RESOURCE_EXHAUSTED for a limit, and the errors of `run` while
// JSON is read and while a network is joined. Limits are checked before the cost that they bound arises. The
// memory of the message in a file is held in `in_flight` (may be null) as long as that message lives.
absl::StatusOr<LoadedModel> LoadModel(const v1::ModelSource& source, std::string_view at,
                                      const RunContext& run = {}, InFlight* in_flight = nullptr);

// Loads a network as a message and as a value. Errors as LoadModel, and INVALID_ARGUMENT for a model of
// patches.
struct LoadedNetwork {
  InFlight::Hold held;  // what the message takes, where it was in a file
  v1::PatchModel message;
  CheckedNetwork checked;
};
absl::StatusOr<LoadedNetwork> LoadNetwork(const v1::ModelSource& source, std::string_view at,
                                          const RunContext& run = {}, InFlight* in_flight = nullptr);

}  // namespace patchmill
