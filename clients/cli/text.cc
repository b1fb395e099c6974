#include "clients/cli/text.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

namespace patchmill::cli {
namespace {

std::string Without(const std::string& name, std::string_view prefix) {
  return name.rfind(prefix, 0) == 0 ? name.substr(prefix.size()) : name;
}

}  // namespace

std::string Short(v1::Outcome value) { return Without(v1::Outcome_Name(value), "OUTCOME_"); }
std::string Short(v1::UnreachableReason value) {
  return Without(v1::UnreachableReason_Name(value), "UNREACHABLE_REASON_");
}
std::string Short(v1::CheckState value) { return Without(v1::CheckState_Name(value), "CHECK_STATE_"); }

std::string Line(const v1::Point3& p) {
  return fmt::format("X {:.3f} Y {:.3f} Z {:.3f}", p.x_mm(), p.y_mm(), p.z_mm());
}

std::string Line(const v1::Place& place) {
  std::string text = Line(place.point());
  if (!place.patch_id().empty()) {
    text += fmt::format(", patch {}", place.patch_id());
  } else if (place.patch_index() >= 0) {
    text += fmt::format(", patch {}", place.patch_index());
  }
  if (place.line() > 0) text += fmt::format(", line {}", place.line());
  return text;
}

std::string Line(const v1::Diagnostic& finding) {
  const v1::Where& where = finding.where();
  std::string text = Without(v1::Severity_Name(finding.severity()), "SEVERITY_") + " " + finding.code();
  if (!where.patch_id().empty()) {
    text += " patch " + where.patch_id();
  } else if (where.has_patch_index()) {
    text += fmt::format(" patch {}", where.patch_index());
  }
  const bool line_said = finding.message().rfind("line ", 0) == 0;
  if (where.has_line() && !line_said) text += fmt::format(" line {}", where.line());
  text += ": " + finding.message();
  const bool place_said = finding.message().find(" at X") != std::string::npos;
  if (where.has_point() && !place_said) text += " (at " + Line(where.point()) + ")";
  return text;
}

std::string UnreachableLine(const v1::Report& report) {
  std::string text;
  for (const v1::UnreachablePart& part : report.unreachable()) {
    text += fmt::format("{}{} {:.2f} mm2 (up to {:.3f} mm stays)", text.empty() ? "" : ", ",
                        Short(part.reason()), part.area_mm2(), part.deepest_leftover_mm());
  }
  return text;
}

std::string Json(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string text;
  const auto status = google::protobuf::util::MessageToJsonString(message, &text, options);
  return status.ok() ? text : fmt::format("{{\"error\": \"{}\"}}\n", std::string(status.message()));
}

}  // namespace patchmill::cli
