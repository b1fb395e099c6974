#include "cam/post/block_use.h"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "core/base/status.h"

namespace patchmill {
namespace {

absl::Status Bad(const std::string& message) { return absl::InvalidArgumentError(message); }

absl::Status CheckCycle(const BlockModes& block, const Dialect& dialect, bool cycle) {
  if (!cycle) return block['L'] ? Bad("L without G73, G81, G82 or G83") : absl::OkStatus();
  if (dialect.syntax != Syntax::kRs274) return Bad("canned cycles of RS274 in this dialect");
  if (block['I'] || block['J'] || block['K']) return Bad("I, J or K in a canned cycle");
  return absl::OkStatus();
}

}  // namespace

absl::Status CheckUse(const BlockModes& block, int motion_code, const Dialect& dialect) {
  const bool dwell = block.once == 40;
  const bool smooth = block.path == 640;
  const int mode = block.motion.value_or(motion_code);
  const bool moves = !block.once || dwell;
  const bool arc = IsArc(mode) && moves, cycle = IsCycle(mode) && moves;
  const bool own = block.word.has_value();
  PM_RETURN_IF_ERROR(CheckCycle(block, dialect, cycle && !dwell));
  // The second to fourth reference point.
  const bool numbered = block.once == 300 && block['P'] && *block['P'] >= 2.0 && *block['P'] <= 4.0 &&
                        *block['P'] == std::floor(*block['P']);
  if (block['P'] && !dwell && !smooth && !own && !cycle && !(arc && dialect.arc_turns) && !numbered)
    return Bad("P without G4 or G64");
  if (block['Q'] && !smooth && !own && !cycle) return Bad("Q without G64, G73 or G83");
  if (own && (HasAxis(block) || HasCenter(block) || block.once))
    return Bad("coordinates beside a word of the dialect's own");
  if (own && block.word->tolerance_letter != '\0' && block[block.word->tolerance_letter].value_or(0.0) < 0.0)
    return Bad(fmt::format("{} is negative", block.word->tolerance_letter));
  if (block['H'] && block.tool_length != 430) return Bad("H without G43");
  if (block['D'] && block.compensation.value_or(400) == 400) return Bad("D without G41 or G42");
  if (dwell && (!block['P'] || smooth || HasAxis(block))) return Bad("G4 needs P and no coordinates");
  if (HasCenter(block) && !IsArc(mode) && !cycle) return Bad("I, J, K or R without G2 or G3");
  if (HasAxis(block) && mode == 800 && !IsReference(block))
    return Bad("coordinates while no motion is in force");
  for (const char letter : {'F', 'P', 'Q', 'H', 'S', 'T', 'D', 'L'}) {
    if (block[letter] && *block[letter] < 0.0) return Bad(fmt::format("{} is negative", letter));
  }
  return absl::OkStatus();
}

}  // namespace patchmill
