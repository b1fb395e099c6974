#include "server/wire_limits.h"

#include <string_view>
#include <unordered_map>

#include "server/limits.h"

namespace patchmill {
namespace {

// Limit of a list that is not named below.
constexpr std::size_t kMaxElements = 100'000;

// Lists with their own limits, by the full name of the field. Each limit is for the whole message together.
const std::unordered_map<std::string_view, std::size_t>& LongLists() {
  static const auto* const kLists = new std::unordered_map<std::string_view, std::size_t>{
      {"patchmill.v1.PatchModel.patches", limits::kMaxPatches},
      {"patchmill.v1.HosakaPatch.breaks", limits::kMaxKnots},
      {"patchmill.v1.CurveNetwork.vertices", limits::kMaxNetworkVertices},
      {"patchmill.v1.CurveNetwork.edges", limits::kMaxNetworkEdges},
      {"patchmill.v1.CurveNetwork.faces", limits::kMaxPatches},
      {"patchmill.v1.CurveNetwork.lines", limits::kMaxNetworkEdges},
      {"patchmill.v1.CurveNetwork.controls", limits::kMaxNetworkEdges},
      {"patchmill.v1.NetworkVertex.normals", limits::kMaxNetworkReferences},
      {"patchmill.v1.NetworkEdge.controls", limits::kMaxNetworkReferences},
      {"patchmill.v1.NetworkFace.more_pushes", limits::kMaxNetworkReferences},
      {"patchmill.v1.NetworkFace.twists", limits::kMaxNetworkReferences},
      {"patchmill.v1.NetworkFace.cuts", limits::kMaxNetworkReferences},
      {"patchmill.v1.NetworkFace.bulges", limits::kMaxNetworkReferences},
      {"patchmill.v1.Patch.bulges", limits::kMaxNetworkReferences},
      {"patchmill.v1.GuideRow.edges", limits::kMaxNetworkEdges},
  };
  return *kLists;
}

}  // namespace

WireLimits ListLimits(std::size_t memory_bytes) {
  WireLimits most;
  most.elements = [](const google::protobuf::FieldDescriptor& field) {
    const auto found = LongLists().find(field.full_name());
    return found == LongLists().end() ? kMaxElements : found->second;
  };
  most.numbers = limits::kMaxRequestNumbers;
  most.memory_bytes = memory_bytes;
  return most;
}

}  // namespace patchmill
