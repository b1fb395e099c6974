#include "core/base/status.h"
#include "server/convert/fairing.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"

namespace patchmill {

absl::Status HandleFairNet(const Call& call, const v1::FairNetRequest& request,
                           v1::FairNetResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  return RunQuickCall(call, {.max_threads = 1}, [&](const RunContext& run) -> absl::Status {
    PM_ASSIGN_OR_RETURN(const NetFairingOrder order, FromProto(request));
    PM_RETURN_IF_ERROR(run.Check());
    PM_ASSIGN_OR_RETURN(const FairedNet faired, FairNet(order.net, run));
    Fill(order, faired, response);
    return absl::OkStatus();
  });
}

}  // namespace patchmill
