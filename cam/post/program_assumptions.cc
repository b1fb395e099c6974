#include "cam/post/program_assumptions.h"

#include <algorithm>
#include <string_view>

namespace patchmill {

std::vector<std::string> AssumptionCodes(const Diagnostics& findings) {
  constexpr std::string_view kSuffix = "_ASSUMED";
  constexpr std::string_view kOthers[] = {"LENGTH_OFFSET_OF_OTHER_TOOL", "SPINDLE_REVERSED",
                                          "WORD_EXPLAINED"};
  std::vector<std::string> codes;
  for (const Diagnostic& finding : findings) {
    const std::string_view code = finding.code;
    const bool assumes = code.ends_with(kSuffix) ||
                         std::find(std::begin(kOthers), std::end(kOthers), code) != std::end(kOthers);
    if (assumes && std::find(codes.begin(), codes.end(), code) == codes.end()) codes.emplace_back(code);
  }
  return codes;
}

}  // namespace patchmill
