// CAD files are read by a process of their own, patchmill-import: the library that reads them may crash, hang
// or exhaust memory on a damaged file, and then only that process ends.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "patchmill/v1/import.pb.h"
#include "server/in_flight.h"

namespace patchmill {

// "step" or "iges" for a file name's ending in any case, without the point (stp, p21, igs too); else empty.
std::string_view CadFormat(std::string_view ending);

struct Imported {
  InFlight::Hold held;  // the memory that the message takes
  v1::ImportResult result;
};

// How a file is read.
struct ImportParams {
  std::string_view format;                      // "step" or "iges"
  std::vector<std::string> skipped = {};        // ids of faces that a box replaces
  std::optional<double> border_tolerance = {};  // mm; default that of TrimParams (core/trim/trim_model.h)
};

// Starts the importer, gives it the bytes of a file, and waits for its answer. It ends within 200 ms of a
// cancel or a deadline of `run`, to which the importer's progress goes. The importer is the program
// patchmill-import beside the running one. The answer is counted before it is parsed, as any message, and
// held in `in_flight` (may be null). Errors: those of `run`; INVALID_ARGUMENT MODEL_UNREADABLE for a file
// that cannot be read, or on which the importer died; RESOURCE_EXHAUSTED for limits of time and memory;
// UNIMPLEMENTED where there is no importer. A CodedError
// UNKNOWN_FACE for a skipped face that the file does not have; its message completes a path.
absl::StatusOr<Imported> ImportFile(std::string_view content, const ImportParams& params,
                                    const RunContext& run, InFlight* in_flight = nullptr);
// The same with another program as importer.
absl::StatusOr<Imported> ImportFileWith(const std::string& program, std::string_view content,
                                        const ImportParams& params, const RunContext& run,
                                        InFlight* in_flight = nullptr);
// Where the importer is looked for.
std::string ImporterPath();
// Changes when the importer is replaced by another version. Empty if there is none.
std::string ImporterStamp();

}  // namespace patchmill
