#include "server/convert/preview.h"

#include <set>

#include "core/base/index.h"
#include "core/editing/section_points.h"
#include "core/network/control_points.h"
#include "core/preview/curvature_comb.h"
#include "core/preview/patch_mesh.h"

namespace patchmill {
namespace {

void PutPlace(const Vec3& v, google::protobuf::RepeatedField<double>* to) {
  for (const double x : {v.x(), v.y(), v.z()}) to->Add(x);
}

void WriteComb(const std::vector<CombTooth>& comb, v1::CurvatureComb* to) {
  for (const CombTooth& tooth : comb) {
    PutPlace(tooth.place, to->mutable_points_mm());
    PutPlace(tooth.curvature, to->mutable_curvature_per_mm());
  }
}

v1::PreviewEdgeKind KindOfEdge(const JoinedEdge& edge) {
  switch (edge.kind) {
    case EdgeKind::kCrease:
      return v1::PREVIEW_EDGE_KIND_CREASE;
    case EdgeKind::kFree:
      return v1::PREVIEW_EDGE_KIND_FREE;
    case EdgeKind::kSmooth:
    case EdgeKind::kLeading:
    case EdgeKind::kFollowing:
      break;
  }
  return edge.equal_curvature ? v1::PREVIEW_EDGE_KIND_EQUAL_CURVATURE : v1::PREVIEW_EDGE_KIND_SMOOTH;
}

}  // namespace

v1::PreviewPatch ToPreview(const JoinedNetwork& joined, int patch, const PreviewDetail& detail) {
  constexpr double kMiddle = 0.5;
  const PatchShape& shape = joined.model.patches[At(patch)].shape;
  v1::PreviewPatch made;
  made.set_patch_index(patch);
  made.set_face(joined.face_of[At(patch)]);
  const PatchMesh mesh = MeshOf(shape, detail.cells);
  for (const Vec3& place : mesh.places) PutPlace(place, made.mutable_position_mm());
  for (const Vec3& normal : mesh.normals) {
    for (const double x : {normal.x(), normal.y(), normal.z()}) made.add_normal(static_cast<float>(x));
  }
  for (const auto& corners : mesh.corners) made.mutable_corners()->Add(corners.begin(), corners.end());
  if (detail.controls) {
    for (const Vec3& point : ControlPoints(shape)) PutPlace(point, made.mutable_control_points_mm());
  }
  if (detail.combs && !IsTriangle(shape)) {
    for (const bool along_u : {false, true}) {
      WriteComb(CombAlong(shape, along_u, kMiddle, detail.cells), made.add_combs());
    }
  }
  return made;
}

v1::PreviewEdge ToPreview(const JoinedNetwork& joined, const JoinedEdge& edge, const PreviewDetail& detail) {
  v1::PreviewEdge made;
  made.set_start(edge.topology.start);
  made.set_end(edge.topology.end);
  made.set_kind(KindOfEdge(edge));
  std::set<int> faces;
  for (const FaceSide& side : edge.topology.faces) faces.insert(joined.face_of[At(side.face)]);
  made.mutable_faces()->Add(faces.begin(), faces.end());
  const std::vector<CombTooth> comb = CombOf(edge.curve, detail.cells);
  for (const CombTooth& tooth : comb) PutPlace(tooth.place, made.mutable_points_mm());
  if (detail.combs) WriteComb(comb, made.mutable_comb());
  return made;
}

v1::MiddleControl ToMiddle(const PatchShape& quad, int side, const JoinedEdge& edge) {
  const MiddleCross cross = AcrossMiddle(quad, side);
  const SectionPoints points = SectionPointsOf(cross);
  v1::MiddleControl made;
  made.set_start(edge.topology.start);
  made.set_end(edge.topology.end);
  PutPlace(points.q0, made.mutable_q0_mm());
  PutPlace(points.q1, made.mutable_q1_mm());
  PutPlace(points.q2, made.mutable_q2_mm());
  PutPlace(cross.first, made.mutable_first_derivative_mm());
  PutPlace(cross.second, made.mutable_second_derivative_mm());
  return made;
}

}  // namespace patchmill
