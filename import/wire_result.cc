#include "import/wire_result.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <variant>

namespace patchmill {
namespace {

constexpr std::array<std::string_view, std::variant_size_v<BrepSurface>> kKinds = {
    "plane", "cylinder", "cone", "sphere", "torus", "spline"};

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
    wire.mutable_where()->set_patch_id(finding.where.patch_id);
  }
}

void AddPatch(const Patch& patch, v1::PatchModel& model) {
  const auto& bezier = std::get<BezierPatch>(patch.shape);
  v1::Patch& wire = *model.add_patches();
  wire.set_id(patch.id);
  v1::BezierPatch& shape = *wire.mutable_bezier();
  shape.set_degree_u(bezier.degree_u);
  shape.set_degree_v(bezier.degree_v);
  for (const Vec3& p : bezier.points) {
    for (const double x : p) shape.add_points(x);
  }
  shape.mutable_weights()->Add(bezier.weights.begin(), bezier.weights.end());
}

}  // namespace

v1::ImportResult ToWire(const BrepModel& part, const TrimmedModel& trimmed) {
  v1::ImportResult result;
  result.mutable_model()->set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  for (const Patch& patch : trimmed.model.patches) AddPatch(patch, *result.mutable_model());
  v1::ImportReport& report = *result.mutable_report();
  report.set_face_count(static_cast<int>(part.faces.size()));
  report.set_body_count(static_cast<int>(part.bodies.size()));
  report.set_solid_count(static_cast<int>(std::count_if(part.bodies.begin(), part.bodies.end(),
                                                        [](const BrepBody& body) { return body.solid; })));
  std::array<int, kKinds.size()> counts{};
  double surface_error = 0.0;
  for (const BrepFace& face : part.faces) {
    ++counts[face.surface.index()];
    surface_error = std::max(surface_error, face.surface_error);
  }
  for (std::size_t k = 0; k < kKinds.size(); ++k) {
    if (counts[k] == 0) continue;
    v1::ImportedKind& kind = *report.add_kinds();
    kind.set_kind(std::string(kKinds[k]));
    kind.set_face_count(counts[k]);
  }
  double area = 0.0;
  for (const TrimmedFace& face : trimmed.faces) area += face.area;
  report.set_area_mm2(area);
  report.set_largest_gap_mm(trimmed.largest_gap);
  report.set_border_error_mm(trimmed.border_error);
  report.set_surface_error_mm(surface_error);
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
