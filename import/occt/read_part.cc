#include "import/occt/read_part.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/error_details.h"
#include "core/base/status.h"
#include "import/occt/brep_of_shape.h"
#include "import/occt/read_file.h"

namespace patchmill {
namespace {

constexpr std::size_t kMostNumbers = 10;  // listed in one message

std::string Listed(const std::map<std::string, int>& counts) {
  std::vector<std::string> parts;
  for (const auto& [kind, count] : counts) parts.push_back(fmt::format("{} {}", count, kind));
  return fmt::format("{}", fmt::join(parts, ", "));
}

Severity SeverityOfFinding(const std::string& code) {
  return code == "FACE_SHARED" || code == "INSIDE_OUT" ? Severity::kWarning : Severity::kError;
}

Diagnostics FileFindings(const CadFile& file) {
  Diagnostics findings;
  if (!file.skipped.empty()) {
    findings.push_back(MakeInfo(
        "SKIPPED_ENTITIES",
        fmt::format("the file also holds what is no face and is left out: {}", Listed(file.skipped))));
  }
  if (!file.external_files.empty()) {
    findings.push_back(MakeWarning("EXTERNAL_REFERENCE",
                                   fmt::format("the file refers to other files, which are not read: {}",
                                               fmt::join(file.external_files, ", "))));
  }
  if (!file.lost_faces.empty()) {
    const std::size_t shown = std::min(file.lost_faces.size(), kMostNumbers);
    const std::vector<std::int64_t> first(file.lost_faces.begin(),
                                          file.lost_faces.begin() + static_cast<std::ptrdiff_t>(shown));
    findings.push_back(MakeError(
        "FACE_LOST",
        fmt::format("the reader made nothing of {} faces of the file: entities {}{}", file.lost_faces.size(),
                    fmt::join(first, ", "), shown < file.lost_faces.size() ? ", ..." : "")));
  }
  if (file.skipped.contains("hidden faces")) {
    findings.push_back(MakeWarning(
        "HIDDEN_FACES",
        fmt::format("{} faces are hidden in the file and left out: nothing keeps the tool off them",
                    file.skipped.at("hidden faces"))));
  }
  if (file.sewing.tolerance > 0.0) {
    findings.push_back(MakeInfo(
        "SEWN",
        fmt::format("loose faces were joined within {:g} mm: {} free edges became {}", file.sewing.tolerance,
                    file.sewing.free_edges_before, file.sewing.free_edges_after)));
  }
  return findings;
}

}  // namespace

absl::StatusOr<ImportedPart> ReadPart(std::string_view content, std::string_view format,
                                      const RunContext& run) {
  run.Progress("read", 0.0);
  absl::StatusOr<CadFile> file = ReadCadFile(content, format);
  if (!file.ok()) {
    return CodedError(absl::IsResourceExhausted(file.status()) ? "IMPORT_LIMIT" : "CAD_UNREADABLE",
                      std::string(file.status().message()));
  }
  run.Progress("read", 0.7);
  absl::StatusOr<BrepOfShapeResult> brep = BrepOfShape(file->shape, file->labels);
  if (!brep.ok()) {
    const bool triangles = file->skipped.contains("tessellated faces");
    std::string why = std::string(brep.status().message());
    if (triangles) why = "it holds triangles and no face; export it as B-rep, or as a mesh";
    if (!file->skipped.empty()) why += fmt::format(" (left out: {})", Listed(file->skipped));
    return CodedError(triangles ? "TESSELLATED_ONLY" : "CAD_UNREADABLE", why);
  }
  if (brep->hidden_faces > 0) file->skipped["hidden faces"] += brep->hidden_faces;
  ImportedPart part;
  part.model = std::move(brep->model);
  part.facts = {file->schema, file->unit, file->written_by, FileFindings(*file)};
  for (const ShapeFinding& finding : brep->findings) {
    const std::string id = fmt::format("f{}", finding.face + 1);
    part.facts.findings.push_back(MakeDiagnostic(
        SeverityOfFinding(finding.code), finding.code,
        fmt::format("face {} (entity {}): {}", id, finding.entity, finding.reason), {.face_id = id}));
  }
  run.Progress("read", 1.0);
  return part;
}

}  // namespace patchmill
