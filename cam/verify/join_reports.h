// Joins the verdicts on one program that is judged in several parts.
#pragma once

#include <string>
#include <vector>

#include "cam/verify/verify.h"

namespace patchmill {

struct PartReport {
  std::string name;  // of the part, as findings state it: "tool 2", "with the lines of / skipped"
  VerifyReport report;
};

// What the parts of a program are.
enum class PartsOfProgram {
  kTools,  // each by its own moves. The finish is that of the tool that leaves least: other cuts only help it
  kWays    // of running it, one of which happens. The finish is that of the way that leaves most
};

// Gouge and motion must hold for every part. Figures of the finish, areas among them, are those of one part.
// Heights and angles are the most extreme of all parts; lengths are summed for tools, and are the largest of
// the ways. A finding that not all parts have says in whose it occurs. Of tools only the one whose finish
// counts has findings LEFTOVER, and the info FINISH_OF_TOOL names it. `parts` is not empty; a single part is
// returned as it is.
VerifyReport JoinReports(std::vector<PartReport> parts, PartsOfProgram kind);

}  // namespace patchmill
