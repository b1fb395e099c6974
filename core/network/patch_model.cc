#include "core/network/patch_model.h"

#include <span>

#include <fmt/format.h>

#include "core/network/control_points.h"

namespace patchmill {

Where WhereOf(const PatchModel& model, PatchId patch) {
  const Patch& p = model.patches[patch.index()];
  Where where;
  where.patch_id = p.id;
  where.patch_index = patch.value;
  if (p.face) where.face_id = model.faces[p.face->index()].id;
  return where;
}

std::string Title(const PatchModel& model, PatchId patch) {
  const Patch& p = model.patches[patch.index()];
  if (p.face) return "face " + Title(model.faces[p.face->index()]);
  return p.id.empty() ? fmt::format("patch {}", patch.value)
                      : fmt::format("patch {} ({})", patch.value, p.id);
}

Vec3 Place(const Placement& placement, const Vec3& p) {
  const Vec3 q = placement.scale * p;
  const Vec3& t = placement.translation;
  switch (placement.up) {
    case UpAxis::kZ:
      return t + q;
    case UpAxis::kY:
      return t + Vec3(q.x(), -q.z(), q.y());
    case UpAxis::kX:
      return t + Vec3(-q.z(), q.y(), q.x());
    case UpAxis::kNegZ:
      return t + Vec3(q.x(), -q.y(), -q.z());
    case UpAxis::kNegY:
      return t + Vec3(q.x(), q.z(), -q.y());
    case UpAxis::kNegX:
      return t + Vec3(q.z(), q.y(), -q.x());
  }
  return t + q;
}

Box3 Place(const Placement& placement, const Box3& box) {
  Box3 placed;  // axes go to axes, and rounding keeps their order
  if (box.Empty()) return placed;
  placed.Add(Place(placement, box.min));
  placed.Add(Place(placement, box.max));
  return placed;
}

PatchModel Place(const Placement& placement, PatchModel model) {
  for (Patch& patch : model.patches) {
    for (Vec3& p : ControlPoints(patch.shape)) p = Place(placement, p);
  }
  if (model.join_tolerance) *model.join_tolerance *= placement.scale;
  for (ModelFace& face : model.faces) face.radius *= placement.scale;
  return model;
}

Box3 ControlBox(const PatchModel& model) {
  Box3 box;
  for (const Patch& patch : model.patches) {
    for (const Vec3& p : ControlPoints(patch.shape)) box.Add(p);
  }
  return box;
}

}  // namespace patchmill
