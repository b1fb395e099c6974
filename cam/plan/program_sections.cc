#include "cam/plan/program_sections.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

namespace patchmill {
namespace {

constexpr double kRestartMinutes = 5.0;  // of motion at feed between restart points of one section

const char* NameOf(PassKind kind, std::size_t count) {
  const bool one = count == 1;
  switch (kind) {
    case PassKind::kZigzag:
      return one ? "line" : "lines";
    case PassKind::kContour:
      return one ? "contour" : "contours";
    case PassKind::kBorder:
      return one ? "border pass" : "border passes";
    case PassKind::kPencil:
      return one ? "pencil pass" : "pencil passes";
    case PassKind::kRest:
      return one ? "rest pass" : "rest passes";
  }
  return "";
}

// Moves between two passes, or before the first.
struct Gap {
  std::size_t first = 0, last = 0;  // the last move is before `last`
};

// The first rapid beside the retract that it follows, where the tool is clear of everything; absent if the
// tool stays down.
std::optional<std::size_t> AfterRetract(const std::vector<Move>& moves, const Gap& gap) {
  for (std::size_t k = std::max<std::size_t>(gap.first, 1); k < gap.last; ++k) {
    const bool up = moves[k - 1].kind == MoveKind::kRetract || moves[k - 1].kind == MoveKind::kRapid;
    if (moves[k].kind == MoveKind::kRapid && up && Xy(moves[k].to) != Xy(moves[k - 1].to)) return k;
  }
  return std::nullopt;
}

bool SameSection(const CutterPath& a, const CutterPath& b) {
  return a.region == b.region && a.kind == b.kind;
}

class SectionMaker {
 public:
  SectionMaker(const Toolpath& posted, const LinkResult& motion, const RegionMap& map, const Vec3& zero)
      : moves_(posted.moves), passes_(motion.passes), map_(map), zero_(zero), radius_(posted.ball_radius) {}

  std::vector<ProgramSection> Make() {
    double minutes = 0.0;  // since the last restart point
    int before = -1;       // pass
    Gap gap;
    for (std::size_t k = 0; k < moves_.size(); ++k) {
      const Move& move = moves_[k];
      if (k > 0 && move.kind != MoveKind::kRapid) minutes += Minutes(moves_[k - 1].to, move);
      if (move.pass < 0) continue;
      if (move.pass != before) {
        gap.last = k;
        if (Begin(before, move.pass, gap, minutes)) minutes = 0.0;
        before = move.pass;
      }
      gap.first = k + 1;
    }
    return std::move(sections_);
  }

 private:
  static double Minutes(const Vec3& from, const Move& move) {
    if (!(move.feed > 0.0)) return 0.0;
    return (move.arc ? ArcLength(*move.arc, {from, move.to}) : (move.to - from).norm()) / move.feed;
  }

  // Adds what begins with the pass `next`. Returns true if that is a restart point.
  bool Begin(int before, int next, const Gap& gap, double minutes) {
    const std::optional<std::size_t> above = AfterRetract(moves_, gap);
    const bool same = before >= 0 && SameSection(PassAt(before), PassAt(next));
    if (same && !(above && minutes >= kRestartMinutes)) return false;
    ProgramSection section;
    section.first_move = above.value_or(gap.first);
    section.restart = above.has_value();
    count_ += same ? 0 : 1;
    section.comment = fmt::format("section {}", count_);
    if (same) {
      section.comment += ", continued";
    } else {
      Describe(next, section);
    }
    section.first_pass = next;
    section.continued = same;
    sections_.push_back(std::move(section));
    return section.restart;
  }

  const CutterPath& PassAt(int index) const { return passes_[static_cast<std::size_t>(index)]; }

  std::string Name(const CutterPath& pass) const {
    if (pass.region == kNoRegion) return "no region";
    const Region& region = map_.regions[pass.region.index()];
    const char* what = region.slope == SlopeClass::kUnspecified ? patchmill::Name(region.kind)
                                                                : patchmill::Name(region.slope);
    return fmt::format("region {}, {}", pass.region.index(), what);
  }

  // Adds region, slope, kind and number of the passes to the comment, and the range of the tip.
  void Describe(int first, ProgramSection& section) const {
    std::size_t count = 0;
    double low = kInfinity, high = -kInfinity;
    for (std::size_t i = static_cast<std::size_t>(first); i < passes_.size(); ++i) {
      if (!SameSection(PassAt(first), passes_[i])) break;
      ++count;
      for (const CutterPoint& p : passes_[i].points) {
        low = std::min(low, p.center.z());
        high = std::max(high, p.center.z());
      }
    }
    const double shift = zero_.z() + radius_;
    section.comment +=
        fmt::format(", {}: {} {}", Name(PassAt(first)), count, NameOf(PassAt(first).kind, count));
    section.tip = {low - shift, high - shift};
  }

  const std::vector<Move>& moves_;
  const std::vector<CutterPath>& passes_;
  const RegionMap& map_;
  const Vec3 zero_;
  const double radius_;
  int count_ = 0;  // sections begun
  std::vector<ProgramSection> sections_;
};

}  // namespace

std::vector<ProgramSection> SectionsOf(const Toolpath& posted, const LinkResult& motion, const RegionMap& map,
                                       const Vec3& program_zero) {
  return SectionMaker(posted, motion, map, program_zero).Make();
}

}  // namespace patchmill
