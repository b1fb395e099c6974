// Findings about untrusted input. Each has a code; all are reported at once, and never as a status.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

enum class Severity { kInfo, kWarning, kError };

// Where a finding is. All fields are optional; those that are set are printed.
struct Where {
  std::string patch_id = {};            // the client's own id
  std::optional<int> patch_index = {};  // 0-based, order of the model
  std::string face_id = {};             // ModelFace::id of the face that the patch is a part of
  std::optional<Vec2> uv = {};          // native parameters of that patch
  std::optional<Vec3> point = {};       // mm, frame of the stage that found it
  std::optional<int> region_id = {};
  std::optional<int> line = {};  // 1-based, of a file or program
  std::string field = {};        // path of a request field
};

struct Diagnostic {
  std::string code;  // UPPER_SNAKE_CASE, stable: clients switch on it
  Severity severity = Severity::kInfo;
  std::string message;  // one sentence with value and constraint
  Where where;
};

using Diagnostics = std::vector<Diagnostic>;

// MakeWarning("UNIT_ASSUMED", "the file states no unit", {.field = "source.unit"})
inline Diagnostic MakeDiagnostic(Severity severity, std::string_view code, std::string message,
                                 Where where = {}) {
  return {std::string(code), severity, std::move(message), std::move(where)};
}
inline Diagnostic MakeError(std::string_view code, std::string message, Where where = {}) {
  return MakeDiagnostic(Severity::kError, code, std::move(message), std::move(where));
}
inline Diagnostic MakeWarning(std::string_view code, std::string message, Where where = {}) {
  return MakeDiagnostic(Severity::kWarning, code, std::move(message), std::move(where));
}
inline Diagnostic MakeInfo(std::string_view code, std::string message, Where where = {}) {
  return MakeDiagnostic(Severity::kInfo, code, std::move(message), std::move(where));
}

}  // namespace patchmill
