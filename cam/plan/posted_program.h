// Checks that a program does what the post file owes to the job beside the path: the tool, the speed, the
// modes that a control would else keep from its last program, and the places where it may be started again.
#pragma once

#include <absl/status/statusor.h>

#include "cam/plan/job.h"
#include "cam/post/program_writer.h"
#include "cam/toolpath/toolpath.h"
#include "core/base/diagnostic.h"
#include "core/base/run_context.h"

namespace patchmill {

// Returns an error with its program line for each fault, at most one of a kind: - POST_OTHER_TOOL: the
// program calls another tool than the job's. - POST_OTHER_SPEED: a feed runs at another spindle speed than
// the job's. - POST_LEAVES_TO_CONTROL: the program has no word for the unit, the work offset, the length
// offset, the plane or another mode (AssumptionCodes), where it counts; or a coordinate has no decimal
// point on a control that may count
//   it in increments. A dialect without length offsets owes none.
// - RESTART_INCOMPLETE: from a restart point on, read as a program of its own, the tool does not first go
// up, or a
//   feed has another speed or coolant than in the whole program, or the modes are not all stated.
// `whole` is the text of `written` as the reader of programs has it. Cost O(text). CANCELLED and
// DEADLINE_EXCEEDED from `run`; a part that the reader refuses is RESTART_INCOMPLETE.
absl::StatusOr<Diagnostics> CheckPosted(const WrittenProgram& written, const ProgramMotion& whole,
                                        const Job& job, const RunContext& run);

}  // namespace patchmill
