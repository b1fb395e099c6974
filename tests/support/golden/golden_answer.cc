#include "tests/support/golden/golden_answer.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include "core/base/digest.h"
#include "tests/support/golden/canonical.h"

namespace patchmill::testing {
namespace {

std::string Hex(const std::string& bytes) {
  std::string hex;
  for (const char c : bytes) hex += fmt::format("{:02x}", static_cast<unsigned char>(c));
  return hex;
}

// OUTCOME_COMPLETE -> COMPLETE
std::string Word(const std::string& name) { return name.substr(name.find('_') + 1); }

std::string Codes(const v1::Report& report) {
  std::set<std::string> codes;
  for (const v1::Diagnostic& finding : report.diagnostics()) codes.insert(finding.code());
  return codes.empty() ? "-" : fmt::format("{}", fmt::join(codes, " "));
}

std::string Reasons(const v1::Report& report) {
  std::string reasons;
  for (const v1::UnreachablePart& part : report.unreachable()) {
    // UNREACHABLE_REASON_FLOOR -> FLOOR
    const std::string name = Word(Word(v1::UnreachableReason_Name(part.reason())));
    reasons += fmt::format("{}{} {:.1f}", reasons.empty() ? "" : ", ", name, part.area_mm2());
  }
  return reasons.empty() ? "-" : reasons;
}

std::string Json(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.preserve_proto_field_names = true;
  std::string json;
  (void)google::protobuf::util::MessageToJsonString(message, &json, options);
  return json;
}

}  // namespace

std::map<std::string, std::string> Hashes(const GoldenAnswer& answer) {
  const bool mapped = answer.regions.regions_size() > 0;
  return {
      {"motion", answer.program.empty() ? "-" : Hex(Sha256(MotionBlocks(answer.program)))},
      {"regions", mapped ? Hex(Sha256(CanonicalBytes(answer.regions))) : "-"},
      {"report", Hex(Sha256(CanonicalBytes(CanonicalReport(answer.report, answer.program))))},
  };
}

std::vector<std::string> FigureColumns() {
  return {"outcome",  "feed_mm",     "rapid_mm", "retracts",    "blocks",  "minutes",
          "gouge_mm", "leftover_mm", "regions",  "not_cut_mm2", "findings"};
}

std::vector<std::string> Figures(const GoldenAnswer& answer) {
  const v1::Report& report = answer.report;
  const std::string blocks = MotionBlocks(answer.program);
  return {Word(v1::Outcome_Name(report.outcome())),
          fmt::format("{:.3f}", report.cut_length_mm()),
          fmt::format("{:.3f}", report.rapid_length_mm()),
          fmt::format("{}", report.retract_count()),
          fmt::format("{}", std::count(blocks.begin(), blocks.end(), '\n')),
          fmt::format("{:.3f}", report.estimated_time_s() / 60.0),
          fmt::format("{:.6f}", report.max_gouge_mm()),
          fmt::format("{:.6f}", report.max_leftover_mm()),
          fmt::format("{}", report.regions_size()),
          Reasons(report),
          Codes(report)};
}

void WriteReadable(const GoldenAnswer& answer, const std::string& folder, const std::string& name) {
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* ending, const std::string& text) {
    std::ofstream(std::filesystem::path(folder) / (name + ending), std::ios::binary) << text;
  };
  write(".ngc", MotionBlocks(answer.program));
  write(".regions.json", Json(answer.regions));
  write(".report.json", Json(CanonicalReport(answer.report, answer.program)));
}

}  // namespace patchmill::testing
