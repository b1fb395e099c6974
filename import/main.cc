// patchmill-import: reads the bytes of a STEP or IGES file from its standard input and answers on its
// standard output with frames (core/base/frames.h). The server starts one for each file.
#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <exception>
#include <iostream>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "core/base/error_details.h"
#include "core/base/frames.h"
#include "core/base/run_context.h"
#include "core/trim/trim_model.h"
#include "import/occt/read_part.h"
#include "import/process_limits.h"
#include "import/system_calls.h"
#include "import/wire_result.h"

namespace patchmill {
namespace {

std::string ReadInput() {
  std::string bytes;
  std::array<char, 1 << 16> block;
  while (true) {
    const ssize_t got = read(STDIN_FILENO, block.data(), block.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return bytes;
    bytes.append(block.data(), static_cast<std::size_t>(got));
  }
}

class Answers {
 public:
  explicit Answers(int fd) : fd_(fd) {}
  void Send(FrameKind kind, std::string_view content) const {
    Write(FrameHead(kind, static_cast<std::uint32_t>(content.size())));
    Write(content);
  }
  void Error(std::string_view code, std::string_view sentence) const {
    Send(FrameKind::kError, fmt::format("{} {}", code, sentence));
  }

 private:
  void Write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t wrote = write(fd_, bytes.data(), bytes.size());
      if (wrote < 0 && errno == EINTR) continue;
      if (wrote <= 0) _exit(3);  // nobody listens any more
      bytes.remove_prefix(static_cast<std::size_t>(wrote));
    }
  }
  int fd_;
};

// What the command line asks for.
struct ImportOrder {
  std::string format;
  std::vector<std::string> skipped;  // ids of faces
  TrimParams trim;
};

std::optional<ImportOrder> ReadOrder(const std::vector<std::string_view>& arguments) {
  ImportOrder order;
  if (arguments.size() % 2 != 0) return std::nullopt;
  for (std::size_t k = 0; k < arguments.size(); k += 2) {
    const std::string_view option = arguments[k], value = arguments[k + 1];
    if (option == "--format" && (value == "step" || value == "iges")) {
      order.format = value;
    } else if (option == "--border-tolerance") {
      const char* end = value.data() + value.size();
      if (std::from_chars(value.data(), end, order.trim.border_tolerance).ptr != end) return std::nullopt;
      if (!(order.trim.border_tolerance >= 1e-7 && order.trim.border_tolerance <= 1.0)) return std::nullopt;
    } else if (option == "--skip-face") {
      order.skipped.emplace_back(value);
    } else {
      return std::nullopt;
    }
  }
  if (order.format.empty()) return std::nullopt;
  return order;
}

// The faces of these ids. NOT_FOUND with a sentence for an id that no face has.
absl::StatusOr<std::vector<FaceId>> FindFaces(const std::vector<std::string>& ids, std::size_t count) {
  std::vector<FaceId> faces;
  for (const std::string& id : ids) {
    std::size_t number = 0;
    const bool read = id.starts_with('f') &&
                      std::from_chars(id.data() + 1, id.data() + id.size(), number).ec == std::errc();
    if (!read || number < 1 || number > count || id != fmt::format("f{}", number)) {
      return absl::NotFoundError(
          fmt::format("= \"{}\"; must be a face of the file, which has the faces f1 to f{}", id, count));
    }
    faces.emplace_back(number - 1);
  }
  return faces;
}

// Faults of a skipped face do not stop the import: a box stands in its place. FACE_UNTRIMMED does: what a
// lost loop surrounds may lie outside the box.
Diagnostics Forgiven(Diagnostics findings, const std::vector<std::string>& skipped) {
  for (Diagnostic& finding : findings) {
    const bool named = std::find(skipped.begin(), skipped.end(), finding.where.face_id) != skipped.end();
    if (named && finding.severity == Severity::kError && finding.code != "FACE_UNTRIMMED")
      finding.severity = Severity::kWarning;
  }
  return findings;
}

int Import(const ImportOrder& order, const Answers& answers) {
  RunContext run;
  run.set_progress([&answers](std::string_view stage, double fraction) {
    // Reading takes the first half of the way, trimming the rest.
    const double from =
        stage == "read" ? 0.0 : (stage == "trim.trace" ? 0.5 : (stage == "trim.fit" ? 0.65 : 0.8));
    const double to =
        stage == "read" ? 0.5 : (stage == "trim.trace" ? 0.65 : (stage == "trim.fit" ? 0.8 : 1.0));
    const double all = from + fraction * (to - from);
    answers.Send(FrameKind::kProgress, fmt::format("{:.3f} {}", all, stage));
  });
  run.set_threads(1);
  absl::StatusOr<ImportedPart> part = ReadPart(ReadInput(), order.format, run);
  if (!part.ok()) {
    const std::string code = CodeOf(part.status());
    answers.Error(code.empty() ? "CAD_UNREADABLE" : code, std::string(part.status().message()));
    return 1;
  }
  TrimParams params = order.trim;
  absl::StatusOr<std::vector<FaceId>> skipped = FindFaces(order.skipped, part->model.faces.size());
  if (!skipped.ok()) {
    answers.Error("UNKNOWN_FACE", std::string(skipped.status().message()));
    return 1;
  }
  params.skipped = *std::move(skipped);
  part->facts.findings = Forgiven(std::move(part->facts.findings), order.skipped);
  const absl::StatusOr<TrimmedModel> trimmed = TrimFaces(part->model, params, run);
  if (!trimmed.ok()) {
    // Why the reader took no face says more than that none is left.
    const Diagnostics& findings = part->facts.findings;
    const auto fault = std::find_if(findings.begin(), findings.end(), [](const Diagnostic& finding) {
      return finding.severity == Severity::kError;
    });
    const std::string why = fault == findings.end() ? "" : ": " + fault->message;
    answers.Error("NO_FACE", std::string(trimmed.status().message()) + why);
    return 1;
  }
  v1::ImportResult result = ToWire(part->model, *trimmed);
  AddFileFacts(part->facts, *result.mutable_report());
  answers.Send(FrameKind::kResult, result.SerializeAsString());
  return 0;
}

}  // namespace
}  // namespace patchmill

int main(int argc, char** argv) {
  using namespace patchmill;
  const std::optional<ImportOrder> order = ReadOrder({argv + 1, argv + argc});
  if (!order) {
    std::cerr
        << "usage: patchmill-import --format step|iges [--border-tolerance MM] [--skip-face ID]... < FILE\n"
           "patchmill and patchmilld start it for each CAD file; its answer is not text.\n";
    return 2;
  }
  // The reader writes to its standard output: the answers get a descriptor of their own.
  const int fd = dup(STDOUT_FILENO);
  if (fd < 0 || dup2(STDERR_FILENO, STDOUT_FILENO) < 0) return 2;
  const Answers answers(fd);
  if (!LimitThisProcess({}) || LimitSystemCalls() == SystemCalls::kFailed) {
    answers.Error("IMPORT_LIMIT", "the importer's limits could not be set");
    return 2;
  }
  std::set_new_handler([] { throw std::bad_alloc(); });
  try {
    return Import(*order, answers);
  } catch (const std::bad_alloc&) {
    answers.Error("IMPORT_LIMIT", "the CAD file needs more than 2 GiB of memory to be read");
    return 1;
  } catch (const std::exception& failure) {
    answers.Error("CAD_UNREADABLE", fmt::format("the reader failed on this file: {}", failure.what()));
    return 1;
  }
}
