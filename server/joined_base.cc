#include "server/joined_base.h"

#include <utility>

#include "core/base/status.h"
#include "server/digest.h"

namespace patchmill {
namespace {

// About the memory of a network and of what it was joined to, bytes.
std::size_t MemoryOfBase(const JoinedBase& base) {
  const CurveNetwork& network = base.checked.network;
  std::size_t bytes = 2 * MemoryOf(base.joined.model) + 200 * network.vertices.size() +
                      300 * network.faces.size() + 300 * network.edges.size();
  for (const JoinedEdge& edge : base.joined.edges) {
    std::size_t points = edge.curve.points.size();
    for (const BezierChain& tangent : edge.tangents) points += tangent.points.size();
    bytes += sizeof(JoinedEdge) + sizeof(Vec3) * points + edge.rows.size() * sizeof(CrossRows) * 4;
  }
  return bytes;
}

}  // namespace

absl::StatusOr<std::shared_ptr<const JoinedBase>> FindJoinedBase(const v1::ModelSource& source,
                                                                 std::string_view at, const RunContext& run,
                                                                 const ModelAccess& access) {
  const bool keeps = access.store != nullptr && access.store->limit_bytes() > 0;
  StoreKey key{Stored::kJoined, access.caller, {}};
  if (keeps) {
    Canonical digest;
    digest.Add("patchmill joined 1").Add(source.SerializeAsString());
    key.digest = digest.Digest();
    if (auto found = access.store->Find<JoinedBase>(key)) return found;
  }
  JoinedBase base;
  {
    PM_ASSIGN_OR_RETURN(LoadedNetwork loaded, LoadNetwork(source, at, run, access));
    base.checked = std::move(loaded.checked);
  }
  if (base.checked.faults.empty()) {
    PM_ASSIGN_OR_RETURN(base.joined, JoinNetwork(base.checked.network, run));
  }
  auto made = std::make_shared<const JoinedBase>(std::move(base));
  if (keeps) access.store->Put<JoinedBase>(key, made, MemoryOfBase(*made), source.model_sha256());
  return made;
}

}  // namespace patchmill
