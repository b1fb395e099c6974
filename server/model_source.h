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
#include "server/store.h"

namespace patchmill {

// What a call may use to load a model.
struct ModelAccess {
  InFlight* in_flight = nullptr;  // counts the memory of messages in files
  Store* store = nullptr;         // has the models that were uploaded, and the CAD files that were read
  std::string caller = {};        // whose they are
};

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
// line and reason), NOT_FOUND for a digest of a model that the store does not have, RESOURCE_EXHAUSTED for a
// limit, and the errors of `run` while JSON is read and while a network is joined. Limits are checked before
// the cost that they bound arises. The memory of the message in a file is held in `access.in_flight` as long
// as that message lives. A CAD file that was read is kept in the store.
absl::StatusOr<LoadedModel> LoadModel(const v1::ModelSource& source, std::string_view at,
                                      const RunContext& run = {}, const ModelAccess& access = {});

// Loads a network as a message and as a value. Errors as LoadModel, and INVALID_ARGUMENT for a model of
// patches.
struct LoadedNetwork {
  InFlight::Hold held;  // what the message takes, where it was in a file
  v1::PatchModel message;
  CheckedNetwork checked;
};
absl::StatusOr<LoadedNetwork> LoadNetwork(const v1::ModelSource& source, std::string_view at,
                                          const RunContext& run = {}, const ModelAccess& access = {});

// A model in the store.
struct StoredModel {
  LoadedModel loaded;
  std::string network;          // a curve network as serialized v1::PatchModel; empty for any other model
  std::string findings_digest;  // of what was found while the model was read: answers repeat it
};
// The findings_digest of the model with this key; empty if the store has none.
std::string FindingsOfStored(Store& store, const StoreKey& key);
// Keeps a loaded model without faults. `source` is what it was loaded from. RESOURCE_EXHAUSTED
// LIMIT_EXCEEDED if the store is too small for it.
absl::Status KeepModel(const LoadedModel& loaded, const v1::ModelSource& source, const RunContext& run,
                       const ModelAccess& access);

// About the memory that a model takes, bytes.
std::size_t MemoryOf(const PatchModel& model);

}  // namespace patchmill
