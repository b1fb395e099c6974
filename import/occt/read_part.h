// The bytes of a STEP or IGES file as a part with what the file says of itself.
#pragma once

#include <string_view>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "import/imported_part.h"

namespace patchmill {

// Reads the file with Open CASCADE and copies its numbers. `format`: "step" or "iges". Findings of the
// reader:
//   error    FACE_UNREADABLE, OFFSET_FOLDS, NEGATIVE_WEIGHT, FACE_UNTRIMMED, FACE_OVERLAPS, FACE_LOST
//   warning  EXTERNAL_REFERENCE, FACE_SHARED, INSIDE_OUT, HIDDEN_FACES
//   info     SKIPPED_ENTITIES, SEWN
// INVALID_ARGUMENT with a code: CAD_UNREADABLE, or TESSELLATED_ONLY for a file that holds triangles and no
// face.
absl::StatusOr<ImportedPart> ReadPart(std::string_view content, std::string_view format,
                                      const RunContext& run);

}  // namespace patchmill
