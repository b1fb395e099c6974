#include <fmt/format.h>

#include "cam/picture/fairing_plot.h"
#include "core/base/status.h"
#include "server/convert/fairing.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"

namespace patchmill {
namespace {

std::string Draw(const FairedCurve& faired, const std::string& title) {
  FairingPlot plot{&faired.before, &faired.after, title, {}};
  plot.notes.push_back(fmt::format("energy {:.4g} -> {:.4g} in {} iterations{}", faired.energies.front(),
                                   faired.energies.back(), faired.iterations(),
                                   faired.settled ? "" : ", not settled"));
  plot.notes.push_back("teeth: curvature of this projection, one scale for both, cut off where too long");
  return DrawFairing(plot);
}

}  // namespace

absl::Status HandleFairCurve(const Call& call, const v1::FairCurveRequest& request,
                             v1::FairCurveResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  // One thread suffices: a curve is a chain in which each point depends on the one before.
  return RunQuickCall(call, {.max_threads = 1}, [&](const RunContext& run) -> absl::Status {
    PM_ASSIGN_OR_RETURN(const FairingOrder order, FromProto(request));
    PM_RETURN_IF_ERROR(run.Check());
    PM_ASSIGN_OR_RETURN(const FairedCurve faired, FairCurve(order.curve, run));
    PM_RETURN_IF_ERROR(Fill(order, faired, response));
    if (request.picture()) {
      v1::ArtifactChunk& picture = *response->mutable_picture();
      picture.set_name("fairing.svg");
      picture.set_media_type("image/svg+xml");
      picture.set_data(Draw(faired, request.name().empty() ? order.title : request.name()));
    }
    return absl::OkStatus();
  });
}

}  // namespace patchmill
