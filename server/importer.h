// CAD files are read by a process of their own, patchmill-import: the library that reads them may crash, hang
// or exhaust memory on a damaged file, and then only that process ends.
#pragma once

#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "patchmill/v1/import.pb.h"

namespace patchmill {

// "step" or "iges" for a file name's ending in any case, without the point (stp, p21, igs too); else empty.
std::string_view CadFormat(std::string_view ending);

// Starts the importer, gives it the bytes of a file, and waits for its answer. It ends within 200 ms of a
// cancel or a deadline of `run`, to which the importer's progress goes. The importer is the program
// patchmill-import beside the running one. Errors: those of `run`; INVALID_ARGUMENT MODEL_UNREADABLE for a
// file that cannot be read, or on which the importer died; RESOURCE_EXHAUSTED for its limits of time and
// memory; UNIMPLEMENTED where there is no importer.
absl::StatusOr<v1::ImportResult> ImportFile(std::string_view content, std::string_view format,
                                            const RunContext& run);
// The same with another program as importer.
absl::StatusOr<v1::ImportResult> ImportFileWith(const std::string& program, std::string_view content,
                                                std::string_view format, const RunContext& run);
// Where the importer is looked for.
std::string ImporterPath();

}  // namespace patchmill
