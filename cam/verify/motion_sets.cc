#include "cam/verify/motion_sets.h"

#include <algorithm>

namespace patchmill {

MotionSets CollectMotion(const ProgramMotion& motion, const Vec3& offset, double clear_z) {
  MotionSets sets;
  for (std::size_t i = 0; i < motion.moves.size(); ++i) {
    const ProgramMove& move = motion.moves[i];
    if (move.from_above && move.to_above) continue;
    Vec3 a = move.from + offset, b = move.to + offset;
    if (move.from_above) a.z() = b.z();
    if (move.to_above) b.z() = a.z();
    const bool rapid = move.kind == ProgramMove::Kind::kRapid;
    const auto index = static_cast<int>(i);
    sets.swept.push_back({a, b, index});
    sets.chord_error = std::max(sets.chord_error, move.chord_error);
    if (!rapid) {
      // From or to machine zero: only the lower end is known to be cut.
      if (move.from_above) {
        sets.cut.push_back({b, b, index});
      } else {
        sets.cut.push_back({a, move.to_above ? a : b, index});
      }
      continue;
    }
    const bool straight_up =
        Plan(a) == Plan(b) && !move.from_above && (move.to_above || move.to.z() >= move.from.z());
    if (straight_up || std::min(a.z(), b.z()) >= clear_z) continue;
    if (std::max(a.z(), b.z()) > clear_z) {
      const Vec3 crossing = a + (clear_z - a.z()) / (b.z() - a.z()) * (b - a);
      (a.z() > clear_z ? a : b) = crossing;
    }
    sets.rapid.push_back({a, b, index});
  }
  return sets;
}

}  // namespace patchmill
