#include "cam/post/drilling_cycle.h"

namespace patchmill {

std::vector<CycleMove> ExpandCycle(const DrillingCycle& cycle) {
  std::vector<CycleMove> moves;
  Vec3 at = cycle.from;
  bool above = cycle.from_above;
  const auto go = [&](ProgramMove::Kind kind, const Vec3& to, bool to_above) {
    if (above == to_above && (to == at || (above && Xy(to) == Xy(at)))) return;
    moves.push_back({kind, to, to_above});
    at = to;
    above = to_above;
  };
  constexpr auto kRapid = ProgramMove::Kind::kRapid;
  const auto over_hole = [&](double z) { return Lift(cycle.hole, z); };
  if (!above && at.z() < cycle.retract_z) go(kRapid, Lift(Xy(at), cycle.retract_z), false);
  go(kRapid, over_hole(at.z()), above);
  go(kRapid, over_hole(cycle.retract_z), false);
  go(ProgramMove::Kind::kFeed, over_hole(cycle.bottom_z), false);
  go(kRapid, over_hole(cycle.ends_above ? cycle.bottom_z : cycle.end_z), cycle.ends_above);
  return moves;
}

}  // namespace patchmill
