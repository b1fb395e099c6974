#include "clients/cli/text.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include <absl/strings/ascii.h>
#include <fmt/format.h>
#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/type_resolver_util.h>

#include "clients/cli/option_names.h"

namespace patchmill::cli {
namespace {

std::string Without(const std::string& name, std::string_view prefix) {
  return name.rfind(prefix, 0) == 0 ? name.substr(prefix.size()) : name;
}

}  // namespace

std::string Printable(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    out += byte < 0x20 || byte == 0x7F ? fmt::format("\\x{:02x}", byte) : std::string(1, c);
  }
  return out;
}

std::string Short(v1::Outcome value) { return Without(v1::Outcome_Name(value), "OUTCOME_"); }
std::string Short(v1::UnreachableReason value) {
  return Without(v1::UnreachableReason_Name(value), "UNREACHABLE_REASON_");
}
std::string Short(v1::LineKind value) { return Without(v1::LineKind_Name(value), "LINE_KIND_"); }
std::string Short(v1::BorderKind value) { return Without(v1::BorderKind_Name(value), "BORDER_KIND_"); }
std::string Short(v1::RegionKind value) { return Without(v1::RegionKind_Name(value), "REGION_KIND_"); }
std::string Short(v1::Slope value) { return Without(v1::Slope_Name(value), "SLOPE_"); }
std::string Short(v1::Strategy value) { return Without(v1::Strategy_Name(value), "STRATEGY_"); }
std::string Short(v1::SurfaceKind value) {
  std::string name = Without(v1::SurfaceKind_Name(value), "SURFACE_KIND_");
  return value == v1::SURFACE_KIND_UNSPECIFIED ? "unknown" : absl::AsciiStrToLower(name);
}
std::string Short(v1::UpAxis value) {
  const std::string name = absl::AsciiStrToLower(Without(v1::UpAxis_Name(value), "UP_AXIS_"));
  return name.rfind("neg_", 0) == 0 ? fmt::format("-{}", name.substr(4)) : name;
}
std::string Short(v1::CheckState value) { return Without(v1::CheckState_Name(value), "CHECK_STATE_"); }

std::string Line(const v1::Point3& p) {
  return fmt::format("X {:.3f} Y {:.3f} Z {:.3f}", p.x_mm(), p.y_mm(), p.z_mm());
}

std::string Line(const v1::Place& place) {
  std::string text = Line(place.point());
  if (!place.face_id().empty()) {
    text += fmt::format(", face {}", Printable(place.face_id()));
  } else if (!place.patch_id().empty()) {
    text += fmt::format(", patch {}", Printable(place.patch_id()));
  } else if (place.patch_index() >= 0) {
    text += fmt::format(", patch {}", place.patch_index());
  }
  if (place.line() > 0) text += fmt::format(", line {}", place.line());
  return text;
}

std::string Line(const v1::Diagnostic& finding) {
  const v1::Where& where = finding.where();
  std::string text = Without(v1::Severity_Name(finding.severity()), "SEVERITY_") + " " + finding.code();
  if (!where.face_id().empty()) {
    text += " face " + Printable(where.face_id());
  } else if (!where.patch_id().empty()) {
    text += " patch " + Printable(where.patch_id());
  } else if (where.has_patch_index()) {
    text += fmt::format(" patch {}", where.patch_index());
  }
  const bool line_said = finding.message().rfind("line ", 0) == 0;
  if (where.has_line() && !line_said) text += fmt::format(" line {}", where.line());
  const char* option = OptionOf(where.field());
  if (option != nullptr && finding.code() == "SETTING_WITHOUT_EFFECT") text += fmt::format(": {}", option);
  text += ": " + Printable(finding.message());
  const bool place_said = finding.message().find(" at X") != std::string::npos;
  if (where.has_point() && !place_said) text += " (at " + Line(where.point()) + ")";
  return text;
}

std::vector<std::string> FindingLines(const google::protobuf::RepeatedPtrField<v1::Diagnostic>& findings,
                                      bool all) {
  constexpr int kMany = 5, kShown = 3;
  std::map<std::string, int> of_code, shown;
  for (const v1::Diagnostic& finding : findings) ++of_code[finding.code()];
  std::vector<std::string> lines;
  for (const v1::Severity severity : {v1::SEVERITY_ERROR, v1::SEVERITY_WARNING, v1::SEVERITY_INFO}) {
    for (const v1::Diagnostic& finding : findings) {
      if (finding.severity() != severity) continue;
      const int count = of_code[finding.code()];
      const bool folded = !all && severity != v1::SEVERITY_ERROR && count > kMany;
      const int number = ++shown[finding.code()];
      if (!folded || number <= kShown) lines.push_back(Line(finding));
      if (folded && number == kShown) {
        lines.push_back(fmt::format("{} {}: {} more; --all-findings lists them",
                                    severity == v1::SEVERITY_WARNING ? "WARNING" : "INFO", finding.code(),
                                    count - kShown));
      }
    }
  }
  return lines;
}

int CountErrors(const google::protobuf::RepeatedPtrField<v1::Diagnostic>& findings) {
  return static_cast<int>(std::count_if(findings.begin(), findings.end(), [](const v1::Diagnostic& finding) {
    return finding.severity() == v1::SEVERITY_ERROR;
  }));
}

std::string UncutShare(const v1::Report& report) {
  const double total = report.total_area_mm2();
  if (report.unreachable().empty() || !(total > 0.0)) return "nothing";
  const auto share = [&](double area_mm2) {
    constexpr double kLeast = 0.1;  // %
    const double percent = 100.0 * area_mm2 / total;
    return percent < kLeast ? fmt::format("less than {} %", kLeast) : fmt::format("{:.1f} %", percent);
  };
  std::string reasons;
  for (const v1::UnreachablePart& part : report.unreachable()) {
    reasons +=
        fmt::format("{}{} {}", reasons.empty() ? "" : ", ", Short(part.reason()), share(part.area_mm2()));
  }
  return fmt::format("{} of the area ({})", share(report.unreachable_area_mm2()), reasons);
}

std::string UnreachableLine(const v1::Report& report) {
  std::string text;
  for (const v1::UnreachablePart& part : report.unreachable()) {
    text += fmt::format("{}{} {:.2f} mm2 (up to {:.3f} mm stays", text.empty() ? "" : ", ",
                        Short(part.reason()), part.area_mm2(), part.deepest_leftover_mm());
    if (part.has_finishing_floor_z_mm()) {
      text += fmt::format("; --floor {:.3f} finishes it, as far as other limits allow",
                          part.finishing_floor_z_mm());
    }
    if (part.has_finishing_flute_length_mm()) {
      text += fmt::format("; --flute-length {:.3f} finishes it", part.finishing_flute_length_mm());
    }
    if (part.has_finishing_stickout_mm())
      text += fmt::format("; --stickout {:.3f} finishes it", part.finishing_stickout_mm());
    text += ")";
  }
  return text;
}

std::string SpreadLine(const v1::Report& report) {
  std::string shares, edges;
  for (const v1::LeftoverClass& part : report.leftover_classes()) {
    shares += fmt::format("{}{:.0f}", shares.empty() ? "" : " / ", 100.0 * part.fraction());
    edges += edges.empty() ? "" : " / ";
    edges += part.has_up_to_scallops() ? fmt::format("{:g}", part.up_to_scallops()) : "more";
  }
  return shares.empty() ? shares
                        : fmt::format("{} % of the surface with up to {} scallops left", shares, edges);
}

std::string SkippedLine(const v1::Report& report) {
  std::string text;
  for (const v1::Region& region : report.regions()) {
    if (!region.skipped()) continue;
    text += fmt::format("{} {} ({:.2f} mm2)", text.empty() ? "regions" : ",", region.id(), region.area_mm2());
  }
  return text;
}

std::string WireText(std::string_view text, std::size_t most) {
  // Length of the character at the start of `s`; 0 if there is no valid one.
  const auto length = [](std::string_view s) -> std::size_t {
    const auto byte = [&](std::size_t k) { return k < s.size() ? static_cast<unsigned char>(s[k]) : 0u; };
    const unsigned lead = byte(0), next = byte(1);
    const std::size_t n = lead < 0x80   ? 1
                          : lead < 0xC2 ? 0
                          : lead < 0xE0 ? 2
                          : lead < 0xF0 ? 3
                          : lead < 0xF5 ? 4
                                        : 0;
    for (std::size_t k = 1; k < n; ++k) {
      if ((byte(k) & 0xC0) != 0x80) return 0;
    }
    // Not valid: overlong forms, surrogates and values above U+10FFFF.
    const bool bad = (lead == 0xE0 && next < 0xA0) || (lead == 0xED && next > 0x9F) ||
                     (lead == 0xF0 && next < 0x90) || (lead == 0xF4 && next > 0x8F);
    return bad ? 0 : n;
  };
  std::string out;
  while (!text.empty()) {
    const std::size_t n = length(text);
    const std::string_view character = n == 0 ? std::string_view("?") : text.substr(0, n);
    if (out.size() + character.size() > most) break;
    out += character;
    text.remove_prefix(std::max<std::size_t>(n, 1));
  }
  return out;
}

namespace {

std::string Print(const google::protobuf::Message& message, bool whole) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = whole;
  options.always_print_primitive_fields = whole;
  options.preserve_proto_field_names = true;
  std::string text;
  const auto status = google::protobuf::util::MessageToJsonString(message, &text, options);
  return status.ok() ? text : fmt::format("{{\"error\": \"{}\"}}\n", std::string(status.message()));
}

}  // namespace

double LengthOf(const v1::BorderLine& line) {
  const auto& p = line.points_mm();
  double sum = 0.0;
  const int count = p.size() / 3;
  for (int i = line.closed() ? 0 : 1; i < count; ++i) {
    const int a = 3 * ((i + count - 1) % count), b = 3 * i;
    sum += std::hypot(p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]);
  }
  return sum;
}

std::string Json(const google::protobuf::Message& message) { return Print(message, true); }
std::string ShortJson(const google::protobuf::Message& message) { return Print(message, false); }

std::string SortedJson(const google::protobuf::Struct& object) {
  // Members of a Struct have no order of their own, but in deterministic bytes they are sorted.
  std::string bytes, text;
  {
    google::protobuf::io::StringOutputStream stream(&bytes);
    google::protobuf::io::CodedOutputStream coded(&stream);
    coded.SetSerializationDeterministic(true);
    object.SerializeToCodedStream(&coded);
  }
  const std::unique_ptr<google::protobuf::util::TypeResolver> types(
      google::protobuf::util::NewTypeResolverForDescriptorPool(
          "type.googleapis.com", google::protobuf::DescriptorPool::generated_pool()));
  const auto status = google::protobuf::util::BinaryToJsonString(
      types.get(), "type.googleapis.com/google.protobuf.Struct", bytes, &text);
  return status.ok() ? text : std::string();
}

}  // namespace patchmill::cli
