// Findings of a job as a whole, in words: what it assumes, and why it ends without a program.
#pragma once

#include <string_view>
#include <vector>

#include "cam/plan/job.h"
#include "cam/plan/resolve.h"
#include "cam/verify/stock_moves.h"

namespace patchmill {

// Findings on all that the program takes for granted, to be read before the start
// ([machining M1, M5, M9, M14]).
Diagnostics Assumptions(const Job& job, const Resolved& r);

// True for the codes of those assumptions that stand for what nobody has given: check them before the start.
bool IsToCheckBeforeStart(std::string_view code);

// NOTHING_TO_CUT. It names what forbids most of what is wanted, and what to look at first. `limited`:
// limits of the operation count. `reached`: mm2, too little to be cut (VerifyReport::NothingToFinish); 0:
// there are no passes at all.
Diagnostic NothingToCut(const JobReport& report, const Resolved& resolved, bool limited, double reached);

// NEEDS_ROUGHING, with the place of the deepest cut. The area is the length of the cuts that are too deep
// times the step-over of a plane.
Diagnostic NeedsRoughing(const DeepCuts& deep, const Job& job, const Resolved& resolved);

// The share of what looks up and is wanted into which the ball does not fit, 0 to 1, by areas as seen from
// above: the reasons CONCAVE, SHANK and HOLDER, and FLOOR where the operation states no floor. All else is
// what the operation itself leaves out, or does not look up. Upright walls count nothing.
double UnreachedShare(const VerifyReport& report, const Operation& op);

// TOO_MUCH_UNREACHED, with the share of each reason. `share` is UnreachedShare, above 0.
Diagnostic TooMuchUnreached(const VerifyReport& report, const Operation& op, double share);

// STEEP_LEAD for each lead onto a pass that is steeper against it than a ramp, for the first 20 of them.
Diagnostics SteepLeads(const std::vector<LeadFigure>& leads, const Resolved& resolved);

}  // namespace patchmill
