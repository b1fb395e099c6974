#include "core/network/patch_model.h"

#include <span>

#include <fmt/format.h>

#include "core/network/control_points.h"

namespace patchmill {

bool IsSkipped(const PatchModel& model, PatchId patch) {
  const std::optional<FaceId>& face = model.patches[patch.index()].face;
  return face && model.faces[face->index()].skipped;
}

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

const char* Name(UpAxis axis) {
  switch (axis) {
    case UpAxis::kZ:
      return "z";
    case UpAxis::kY:
      return "y";
    case UpAxis::kX:
      return "x";
    case UpAxis::kNegZ:
      return "-z";
    case UpAxis::kNegY:
      return "-y";
    case UpAxis::kNegX:
      return "-x";
  }
  return "";
}

namespace {

Vec3 TurnedUp(const Placement& placement, const Vec3& q) {
  if (placement.turn) {
    // Written out: the order of the sums must not depend on the machine.
    const Mat3& m = *placement.turn;
    const auto row = [&](int k) { return m(k, 0) * q.x() + m(k, 1) * q.y() + m(k, 2) * q.z(); };
    return {row(0), row(1), row(2)};
  }
  switch (placement.up) {
    case UpAxis::kZ:
      return q;
    case UpAxis::kY:
      return {q.x(), -q.z(), q.y()};
    case UpAxis::kX:
      return {-q.z(), q.y(), q.x()};
    case UpAxis::kNegZ:
      return {q.x(), -q.y(), -q.z()};
    case UpAxis::kNegY:
      return {q.x(), q.z(), -q.y()};
    case UpAxis::kNegX:
      return {q.z(), q.y(), -q.x()};
  }
  return q;
}

}  // namespace

Vec3 Place(const Placement& placement, const Vec3& p) {
  return placement.translation + TurnedUp(placement, placement.scale * p);
}

Box3 Place(const Placement& placement, const Box3& box) {
  Box3 placed;
  if (box.Empty()) return placed;
  for (int corner = 0; corner < 8; ++corner) {
    const auto of = [&](int k) { return (corner >> k) % 2 == 0 ? box.min[k] : box.max[k]; };
    placed.Add(Place(placement, Vec3(of(0), of(1), of(2))));
  }
  return placed;
}

PatchModel Place(const Placement& placement, PatchModel model) {
  Placement turn = placement;
  turn.translation.setZero();
  for (Patch& patch : model.patches) {
    for (Vec3& p : ControlPoints(patch.shape)) p = Place(placement, p);
    for (Bulge& b : Bulges(patch.shape)) b.by = Place(turn, b.by);
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
