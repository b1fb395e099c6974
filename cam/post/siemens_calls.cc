#include "cam/post/siemens_calls.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cam/post/siemens_line.h"

namespace patchmill {
namespace {

absl::Status CycleFault(const std::string& message) { return absl::InvalidArgumentError(message); }

// Whether the kind of CYCLE832 is a kind of machining: its last digit, or its name.
absl::StatusOr<bool> IsKind(std::string_view kind) {
  if (kind.empty() || kind == "_OFF" || kind == "_ORI_OFF") return false;
  for (const char* const name :
       {"_FINISH", "_SEMIFIN", "_ROUGH", "_PRECISION", "_TOP_SURFACE_SMOOTH_OFF+_FINISH"}) {
    if (kind == name || kind == std::string("_ORI") + name) return true;
  }
  const std::optional<double> number = SiemensNumber(kind);
  if (!number || !(*number >= 0.0 && *number < 1e9) || *number != std::floor(*number)) {
    return CycleFault(
        fmt::format("CYCLE832: its second value {} must be a number or one of _OFF, _FINISH, _SEMIFIN, "
                    "_ROUGH, _PRECISION",
                    kind));
  }
  const int units = static_cast<int>(*number) % 10;
  return units >= 1 && units <= 4;
}

}  // namespace

absl::StatusOr<BlockModes> ReadCycle832(std::string_view arguments) {
  BlockModes modes;
  modes.word = DialectWord{.tolerance_letter = 'E'};
  const std::vector<std::string_view> values = SiemensArguments(arguments);
  if (values.empty()) return modes;
  const std::optional<double> tolerance = values[0].empty() ? 0.0 : SiemensNumber(values[0]);
  if (!tolerance || !(*tolerance >= 0.0)) {
    return CycleFault(fmt::format("CYCLE832: the tolerance {} is not a number of 0 or more", values[0]));
  }
  const absl::StatusOr<bool> kind = IsKind(values.size() > 1 ? values[1] : "");
  if (!kind.ok()) return kind.status();
  if (*tolerance > 0.0 && *kind) modes.value['E' - 'A'] = *tolerance;
  return modes;
}

absl::StatusOr<BlockModes> ReadCycle800(std::string_view arguments) {
  BlockModes modes;
  modes.without_effect = {"CYCLE800"};
  const std::vector<std::string_view> values = SiemensArguments(arguments);
  constexpr std::size_t kMode = 3, kFirst = 4, kLast = 12;  // X0 to Z1
  for (std::size_t k = kFirst; k <= kLast && k < values.size(); ++k) {
    if (values[k].empty() || SiemensNumber(values[k]) == 0.0) continue;
    return CycleFault(
        fmt::format("CYCLE800: its value {} is {}: planes that are shifted or turned are not judged; "
                    "post the program in the frame of the part",
                    k + 1, values[k]));
  }
  if (values.empty()) return modes;
  if (values.size() > kMode) modes.rotary = true;
  const std::string_view retraction = values[0];
  if (retraction.empty() || retraction == "0") return modes;
  if (retraction != "1") {
    return CycleFault(fmt::format(
        "CYCLE800: the retraction {} goes to places that the program does not say; 0 and 1 are read",
        retraction));
  }
  modes.once = 530;
  modes.value['Z' - 'A'] = 0.0;
  return modes;
}

}  // namespace patchmill
