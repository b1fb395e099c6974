#include "server/convert/faces.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/base/enum_array.h"
#include "server/convert/setup.h"
#include "server/errors.h"
#include "server/limits.h"

namespace patchmill {
namespace {

constexpr EnumArray<SurfaceKind, v1::SurfaceKind> kKinds = {
    {v1::SURFACE_KIND_UNSPECIFIED, v1::SURFACE_KIND_PLANE, v1::SURFACE_KIND_CYLINDER, v1::SURFACE_KIND_CONE,
     v1::SURFACE_KIND_SPHERE, v1::SURFACE_KIND_TORUS, v1::SURFACE_KIND_SPLINE}};
constexpr EnumArray<HoleEnd, v1::HoleEnd> kEnds = {
    {v1::HOLE_END_OPEN, v1::HOLE_END_FLOOR, v1::HOLE_END_STEP}};

}  // namespace

ModelFace FromProto(const v1::Face& proto, int index, Diagnostics& faults) {
  const auto fault = [&](std::string_view field, std::string_view text) {
    std::string path = fmt::format("faces[{}].{}", index, field);
    std::string message = fmt::format("{} {}", path, text);
    faults.push_back(MakeError("INVALID_FACE", std::move(message), {.field = std::move(path)}));
  };
  const std::pair<const char*, const std::string&> texts[] = {
      {"id", proto.id()}, {"name", proto.name()}, {"body", proto.body()}, {"layer", proto.layer()}};
  for (const auto& [field, text] : texts) {
    if (text.size() > limits::kMaxIdBytes)
      fault(field, fmt::format("has {} bytes; must have at most {}", text.size(), limits::kMaxIdBytes));
  }
  ModelFace face;
  face.id = proto.id();
  face.name = proto.name();
  face.body = proto.body();
  face.layer = proto.layer();
  if (proto.has_rgb()) {
    if (proto.rgb() < 0 || proto.rgb() > 0xFFFFFF)
      fault("rgb", fmt::format("= {}; must be in [0, 0xffffff]", proto.rgb()));
    face.rgb = static_cast<std::uint32_t>(proto.rgb());
  }
  bool known = false;
  for (const SurfaceKind kind : Enumerators<SurfaceKind>()) {
    if (kKinds[kind] != proto.kind()) continue;
    face.kind = kind;
    known = true;
  }
  if (!known) {
    fault("kind", fmt::format("= {}; this server does not know that value", static_cast<int>(proto.kind())));
  }
  face.radius = proto.radius_mm();
  face.hollow = proto.hollow();
  face.entity = proto.entity();
  face.skipped = proto.skipped();
  return face;
}

v1::Face ToProto(const ModelFace& face) {
  v1::Face proto;
  proto.set_id(Utf8(face.id));
  proto.set_name(Utf8(face.name));
  proto.set_body(Utf8(face.body));
  proto.set_layer(Utf8(face.layer));
  if (face.rgb) proto.set_rgb(static_cast<int>(*face.rgb));
  proto.set_kind(kKinds[face.kind]);
  proto.set_radius_mm(face.radius);
  proto.set_hollow(face.hollow);
  proto.set_entity(face.entity);
  proto.set_skipped(face.skipped);
  return proto;
}

v1::Hole ToProto(const Hole& hole, const PatchModel& model, const Vec3& zero) {
  v1::Hole proto;
  for (const FaceId face : hole.faces) proto.add_face_ids(Utf8(model.faces[face.index()].id));
  proto.set_diameter_mm(hole.diameter);
  proto.set_depth_mm(hole.depth);
  *proto.mutable_mouth() = ToProto(Vec3(hole.mouth - zero));
  for (const double component : hole.direction) proto.add_direction(component);
  proto.set_first_end(kEnds[hole.ends[0]]);
  proto.set_second_end(kEnds[hole.ends[1]]);
  return proto;
}

v1::ConcaveFaces ToProto(const ConcaveFaces& group, const PatchModel& model) {
  v1::ConcaveFaces proto;
  proto.set_kind(kKinds[group.kind]);
  proto.set_min_radius_mm(group.radius);
  proto.set_max_tool_diameter_mm(2.0 * group.radius);
  for (const FaceId face : group.faces) proto.add_face_ids(Utf8(model.faces[face.index()].id));
  proto.set_area_mm2(group.area);
  return proto;
}

}  // namespace patchmill
