#include "import/wire_result.h"

#include <algorithm>
#include <string>
#include <variant>

#include "core/base/enum_array.h"

namespace patchmill {
namespace {

v1::Severity SeverityOf(Severity severity) {
  switch (severity) {
    case Severity::kInfo:
      return v1::SEVERITY_INFO;
    case Severity::kWarning:
      return v1::SEVERITY_WARNING;
    case Severity::kError:
      break;
  }
  return v1::SEVERITY_ERROR;
}

void AddFindings(const Diagnostics& findings, v1::ImportReport& report) {
  for (const Diagnostic& finding : findings) {
    v1::Diagnostic& wire = *report.add_findings();
    wire.set_code(finding.code);
    wire.set_severity(SeverityOf(finding.severity));
    wire.set_message(finding.message);
    wire.mutable_where()->set_face_id(finding.where.face_id);
  }
}

void AddPatch(const Patch& patch, v1::PatchModel& model) {
  const auto& bezier = std::get<BezierPatch>(patch.shape);
  v1::Patch& wire = *model.add_patches();
  wire.set_id(patch.id);
  if (patch.face) wire.set_face_index(patch.face->value);
  v1::BezierPatch& shape = *wire.mutable_bezier();
  shape.set_degree_u(bezier.degree_u);
  shape.set_degree_v(bezier.degree_v);
  for (const Vec3& p : bezier.points) {
    for (const double x : p) shape.add_points(x);
  }
  shape.mutable_weights()->Add(bezier.weights.begin(), bezier.weights.end());
}

// Names from files are of any length.
std::string Short(const std::string& text) {
  constexpr std::size_t kMost = 200;  // bytes, the limit of the message
  std::size_t end = std::min(text.size(), kMost);
  while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end);
}

void AddFace(const ModelFace& face, v1::PatchModel& model) {
  v1::Face& wire = *model.add_faces();
  wire.set_id(face.id);
  wire.set_name(Short(face.name));
  wire.set_body(Short(face.body));
  wire.set_layer(Short(face.layer));
  if (face.rgb) wire.set_rgb(static_cast<int>(*face.rgb & 0xFFFFFF));
  static_assert(v1::SURFACE_KIND_PLANE == static_cast<int>(SurfaceKind::kPlane) &&
                v1::SURFACE_KIND_SPLINE == static_cast<int>(SurfaceKind::kSpline));
  wire.set_kind(static_cast<v1::SurfaceKind>(face.kind));
  wire.set_radius_mm(face.radius);
  wire.set_hollow(face.hollow);
  wire.set_entity(face.entity);
  wire.set_skipped(face.skipped);
}

}  // namespace

v1::ImportResult ToWire(const BrepModel& part, const TrimmedModel& trimmed) {
  v1::ImportResult result;
  result.mutable_model()->set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  if (trimmed.model.join_tolerance)
    result.mutable_model()->set_join_tolerance_mm(*trimmed.model.join_tolerance);
  for (const Patch& patch : trimmed.model.patches) AddPatch(patch, *result.mutable_model());
  for (const ModelFace& face : trimmed.model.faces) AddFace(face, *result.mutable_model());
  v1::ImportReport& report = *result.mutable_report();
  report.set_face_count(static_cast<int>(part.faces.size()));
  report.set_body_count(static_cast<int>(part.bodies.size()));
  report.set_solid_count(static_cast<int>(std::count_if(part.bodies.begin(), part.bodies.end(),
                                                        [](const BrepBody& body) { return body.solid; })));
  EnumArray<SurfaceKind, int> counts{};
  for (const ModelFace& face : trimmed.model.faces) ++counts[face.kind];
  for (const SurfaceKind kind : Enumerators<SurfaceKind>()) {
    if (counts[kind] == 0) continue;
    v1::ImportedKind& wire = *report.add_kinds();
    wire.set_kind(Name(kind));
    wire.set_face_count(counts[kind]);
  }
  double area = 0.0;
  for (const TrimmedFace& face : trimmed.faces) area += face.area;
  report.set_area_mm2(area);
  report.set_largest_gap_mm(trimmed.largest_gap);
  report.set_border_error_mm(trimmed.border_error);
  report.set_surface_error_mm(trimmed.surface_error);
  AddFindings(trimmed.findings, report);
  return result;
}

void AddFileFacts(const FileFacts& facts, v1::ImportReport& report) {
  report.set_schema(facts.schema);
  report.set_length_unit(facts.length_unit);
  report.set_written_by(facts.written_by);
  AddFindings(facts.findings, report);
}

}  // namespace patchmill
