#include "server/placed_surface.h"

#include <algorithm>
#include <string>
#include <utility>

#include "server/digest.h"

namespace patchmill {
namespace {

// What a surface takes, bytes: by count where the memory of the call is counted, else about forty times its
// control points.
std::size_t MemoryOfBuilt(const RunContext& run, std::int64_t used_before, std::size_t model_bytes) {
  const std::int64_t used = run.budget() == nullptr ? 0 : run.budget()->used() - used_before;
  return std::max<std::size_t>(used > 0 ? static_cast<std::size_t>(used) : 40 * model_bytes, model_bytes);
}

}  // namespace

absl::StatusOr<std::shared_ptr<const Surface>> PlacedSurface(PatchModel model, const std::string& digest,
                                                             const Setup& setup, const RunContext& run,
                                                             const ModelAccess& access) {
  const bool keeps = access.store != nullptr && access.store->limit_bytes() > 0;
  StoreKey key{Stored::kSurface, access.caller, {}};
  if (keeps) {
    key.digest = PlacementDigest(setup, digest);
    if (auto built = access.store->Find<Surface>(key)) return built;
  }
  const std::size_t model_bytes = MemoryOf(model);
  const std::int64_t used = run.budget() == nullptr ? 0 : run.budget()->used();
  PM_ASSIGN_OR_RETURN(Surface surface, BuildPlacedSurface(std::move(model), setup, run));
  auto built = std::make_shared<const Surface>(std::move(surface));
  if (keeps) access.store->Put<Surface>(key, built, MemoryOfBuilt(run, used, model_bytes), digest);
  return built;
}

}  // namespace patchmill
