// A curve network as it was joined before any edit, kept for the next preview of the same source.
#pragma once

#include <memory>
#include <string_view>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/joining/join_network.h"
#include "patchmill/v1/model.pb.h"
#include "server/model_source.h"

namespace patchmill {

struct JoinedBase {
  CheckedNetwork checked;  // without the message it came from
  JoinedNetwork joined;    // empty if `checked` has faults
};

// Loads and joins the network, or finds it in the store of `access`. Both give the same values. The source
// itself is the key: each caller has its own, and a model that is forgotten takes its joined network along.
// Errors as LoadNetwork and JoinNetwork.
absl::StatusOr<std::shared_ptr<const JoinedBase>> FindJoinedBase(const v1::ModelSource& source,
                                                                 std::string_view at, const RunContext& run,
                                                                 const ModelAccess& access);

}  // namespace patchmill
