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

// Returns an error with its program line for each fault, at most one of a kind:
//
// POST_OTHER_TOOL: the program calls another tool than the job's.
//
// POST_OTHER_SPEED: a feed runs at another spindle speed than the job's.
//
// POST_OTHER_OFFSET: it chooses another work offset than the job's, or the length offset of another tool.
//
// POST_OTHER_COOLANT: at its last feed the coolant is on, and the job's is off, or the other way about.
//
// POST_LEAVES_TO_CONTROL: where it counts, the program has no word for the unit, the work offset, the length
// offset, the plane or another mode (AssumptionCodes); or an RS274 program has no G94, G40 or G80 before its
// first feed; or a coordinate has no decimal point on a control that may count it in increments. A dialect
// without length offsets owes none.
//
// RESTART_INCOMPLETE: from a restart point on, read as a program of its own, the tool does not first go up,
// or one of the faults above is in it.
//
// `whole` is the text of `written` as the reader of programs has it. Cost O(text). CANCELLED and
// DEADLINE_EXCEEDED from `run`; a part that the reader refuses is RESTART_INCOMPLETE.
absl::StatusOr<Diagnostics> CheckPosted(const WrittenProgram& written, const ProgramMotion& whole,
                                        const Job& job, const RunContext& run);

}  // namespace patchmill
