#include "server/convert/paths.h"

#include <utility>

#include "server/convert/enums.h"
#include "server/convert/setup.h"
#include "server/limits.h"

namespace patchmill {
namespace {

// What chunks and arcs say of a move in the same words.
void Describe(const Move& move, auto& proto) {
  proto.set_region_id(move.region.value);
  proto.set_pass_index(move.pass);
  proto.set_kind(ToProto(move.kind));
  proto.set_feed_mm_per_min(move.kind == MoveKind::kRapid ? 0.0 : move.feed);
}

v1::ArcMove ArcOf(const Move& move, const Vec3& from, const Vec3& tip_offset, const Vec3& zero) {
  v1::ArcMove proto;
  Describe(move, proto);
  const ArcPlane plane = move.arc->plane;
  proto.set_plane(ToProto(plane));
  proto.set_clockwise(move.arc->clockwise);
  const Vec3 center = FromPlane(plane, Lift(move.arc->center, ToPlane(plane, from).z()));
  *proto.mutable_center() = ToProto(Vec3(center - tip_offset));
  *proto.mutable_tip() = ToProto(Vec3(move.to - tip_offset));
  if (move.contact) *proto.mutable_contact() = ToProto(Vec3(move.contact->p - zero));
  proto.set_contact_patch_index(move.contact ? move.contact->patch.value : -1);
  return proto;
}

}  // namespace

bool EmitPaths(const Toolpath& toolpath, const Vec3& zero, const std::function<bool(PathEvent)>& emit) {
  const Vec3 tip_offset = zero + Vec3(0.0, 0.0, toolpath.ball_radius);
  v1::PathChunk chunk;
  const Move* first = nullptr;
  const auto flush = [&] {
    if (first == nullptr) return true;
    first = nullptr;
    return emit(std::exchange(chunk, {}));
  };
  Vec3 at = Vec3::Zero();
  for (const Move& move : toolpath.moves) {
    const Vec3 from = std::exchange(at, move.to);
    if (move.arc) {
      if (!flush() || !emit(ArcOf(move, from, tip_offset, zero))) return false;
      continue;
    }
    const bool same = first != nullptr && move.kind == first->kind && move.region == first->region &&
                      move.pass == first->pass && move.feed == first->feed &&
                      move.contact.has_value() == first->contact.has_value() &&
                      chunk.tip_mm_size() < static_cast<int>(3 * limits::kPathChunkPoints);
    if (!same) {
      if (!flush()) return false;
      first = &move;
      Describe(move, chunk);
    }
    for (int k = 0; k < 3; ++k) chunk.add_tip_mm(move.to[k] - tip_offset[k]);
    if (!move.contact) continue;
    for (int k = 0; k < 3; ++k) chunk.add_contact_mm(move.contact->p[k] - zero[k]);
    chunk.add_contact_patch_index(move.contact->patch.value);
  }
  return flush();
}

}  // namespace patchmill
