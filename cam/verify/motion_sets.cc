#include "cam/verify/motion_sets.h"

#include <algorithm>

namespace patchmill {

namespace {

int Axes(const PathSegment& s) { return static_cast<int>((s.a.array() != s.b.array()).count()); }

void AddRapid(const ProgramMove& move, PathSegment s, double clear_z, std::vector<PathSegment>& out) {
  const bool straight_up = Xy(s.a) == Xy(s.b) && !move.from_above && (move.to_above || s.b.z() >= s.a.z());
  if (straight_up || std::min(s.a.z(), s.b.z()) >= clear_z) return;
  if (std::max(s.a.z(), s.b.z()) > clear_z) {
    const Vec3 crossing = s.a + (clear_z - s.a.z()) / (s.b.z() - s.a.z()) * (s.b - s.a);
    (s.a.z() > clear_z ? s.a : s.b) = crossing;
  }
  out.push_back(s);
}

}  // namespace

std::vector<PathSegment> CollectMoves(const ProgramMotion& motion, MotionSet set, const Vec3& offset,
                                      double clear_z) {
  std::vector<PathSegment> segments;
  for (std::size_t i = 0; i < motion.moves.size(); ++i) {
    const ProgramMove& move = motion.moves[i];
    if (move.from_above && move.to_above) continue;
    PathSegment s{move.from + offset, move.to + offset, static_cast<int>(i)};
    if (move.from_above) s.a.z() = s.b.z();
    if (move.to_above) s.b.z() = s.a.z();
    const bool rapid = move.kind == ProgramMove::Kind::kRapid;
    if (set == MotionSet::kSwept || (set == MotionSet::kSweptRapids && rapid)) {
      segments.push_back(s);
    } else if (set == MotionSet::kRapid && rapid) {
      AddRapid(move, s, clear_z, segments);
    } else if (set == MotionSet::kDogLegs && rapid) {
      if (Axes(s) > 1 && std::min(s.a.z(), s.b.z()) < clear_z) segments.push_back(s);
    } else if (set == MotionSet::kCut && !rapid) {
      if (move.from_above) s.a = s.b;
      if (move.to_above) s.b = s.a;
      segments.push_back(s);
    }
  }
  return segments;
}

double ChordError(const ProgramMotion& motion) {
  double most = 0.0;
  for (const ProgramMove& move : motion.moves) most = std::max(most, move.chord_error);
  return most;
}

}  // namespace patchmill
