// v1.ModelSource -> PatchModel in millimetres, whatever it came as.
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
  Diagnostics faults;     // everything wrong with the patches; the model may be used only when empty
  Diagnostics remarks;    // warnings about a model that may be used; points in its own frame, mm
  bool unitless = false;  // a file that states no unit, and the request did not either
  std::string digest;     // SHA-256, 32 bytes
  std::string path;       // where the request has it; of a file, its content
};

// INVALID_ARGUMENT for what cannot be read (with line and reason), NOT_FOUND for a digest, RESOURCE_EXHAUSTED
// for a limit; those of `run` while JSON is read and while a network is joined. Limits are checked before the
// cost is paid. `at` is the path of the source in its request. What the message in a file takes in memory is
// held in `in_flight` (may be nothing) as long as there is that message.
absl::StatusOr<LoadedModel> LoadModel(const v1::ModelSource& source, std::string_view at,
                                      const RunContext& run = {}, InFlight* in_flight = nullptr);

// A network as a message and as a value. Errors as LoadModel, and INVALID_ARGUMENT for a model of patches.
struct LoadedNetwork {
  InFlight::Hold held;  // what the message takes, where it was in a file
  v1::PatchModel message;
  CheckedNetwork checked;
};
absl::StatusOr<LoadedNetwork> LoadNetwork(const v1::ModelSource& source, std::string_view at,
                                          const RunContext& run = {}, InFlight* in_flight = nullptr);

}  // namespace patchmill
