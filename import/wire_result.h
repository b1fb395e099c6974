// A trimmed part as the message that the importer sends.
#pragma once

#include "core/brep/brep_model.h"
#include "core/trim/trim_model.h"
#include "import/imported_part.h"
#include "patchmill/v1/import.pb.h"

namespace patchmill {

// The patches, and the report but for what only the reader of the file knows. `part`: what was trimmed.
v1::ImportResult ToWire(const BrepModel& part, const TrimmedModel& trimmed);

void AddFileFacts(const FileFacts& facts, v1::ImportReport& report);

}  // namespace patchmill
