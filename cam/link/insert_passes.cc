#include "cam/link/insert_passes.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/base/status.h"

namespace patchmill {
namespace {

// Largest number of passes that are tried, and of gaps for each of them.
constexpr std::size_t kMostPasses = 256, kGaps = 4;

const CutterPoint& StartOf(const CutterPath& pass) { return pass.points.front(); }
const CutterPoint& EndOf(const CutterPath& pass) {
  return pass.closed ? pass.points.front() : pass.points.back();
}

bool IsShort(const CutterPath& pass, double longest) {
  const bool is_rest_pass =
      pass.kind == PassKind::kBorder || pass.kind == PassKind::kPencil || pass.kind == PassKind::kRest;
  return is_rest_pass && !pass.closed && pass.traversal == Traversal::kAny && Length(pass) <= longest;
}

// The gap between the pass `after` and the next one.
struct Gap {
  std::size_t after = 0;
  bool reversed = false;
  double way = 0.0;  // mm; how much longer the two straight links are than the one that they replace
};

// The nearest gaps for a pass, nearest first.
std::vector<Gap> GapsFor(const std::vector<CutterPath>& passes, std::size_t which, double longest) {
  const CutterPath& pass = passes[which];
  const Vec3 start = StartOf(pass).center, end = EndOf(pass).center;
  std::vector<Gap> gaps;
  for (std::size_t i = 0; i + 1 < passes.size(); ++i) {
    if (i == which || i + 1 == which) continue;
    const CutterPath &a = passes[i], &b = passes[i + 1];
    if (a.kind == PassKind::kContour || b.kind == PassKind::kContour || b.traversal == Traversal::kOneWay)
      continue;
    const Vec3 &from = EndOf(a).center, &to = StartOf(b).center;
    const double straight = (to - from).norm();
    for (const bool reversed : {false, true}) {
      const double in = (from - (reversed ? end : start)).norm(),
                   out = (to - (reversed ? start : end)).norm();
      if (in <= longest && out <= longest) gaps.push_back({i, reversed, in + out - straight});
    }
  }
  const auto count = std::min(kGaps, gaps.size());
  std::partial_sort(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(count), gaps.end(),
                    [](const Gap& a, const Gap& b) {
                      return std::pair(a.way, std::pair(a.after, a.reversed)) <
                             std::pair(b.way, std::pair(b.after, b.reversed));
                    });
  gaps.resize(count);
  return gaps;
}

// Cost of the link from one pass to another, s.
double LinkCost(const LinkMaker& maker, const CutterPath& from, const CutterPath& to) {
  const PassEnd end = PassEnd::End(from);
  return CostOf(maker, end, LinkTo(maker, end, to));
}

}  // namespace

absl::StatusOr<std::vector<CutterPath>> InsertPasses(const LinkMaker& maker, std::vector<CutterPath> passes,
                                                     const LinkParams& params, const RunContext& run) {
  const double longest = MaxLinkLength(params);
  std::size_t tried = 0;
  for (std::size_t i = 1; i < passes.size() && tried < kMostPasses; ++i) {
    PM_RETURN_IF_ERROR(run.Check());
    if (!IsShort(passes[i], longest)) continue;
    const CutterPath& before = passes[i - 1];
    const PassEnd end = PassEnd::End(before);
    const Link in = LinkTo(maker, end, passes[i]);
    if (std::none_of(in.moves.begin(), in.moves.end(),
                     [](const Move& m) { return m.kind == MoveKind::kRapid; }))
      continue;
    ++tried;
    run.Progress("link: on the way", static_cast<double>(i) / static_cast<double>(passes.size()));
    // The cost that is saved if the pass is removed from its place, s.
    double least = CostOf(maker, end, in);
    if (i + 1 < passes.size())
      least += LinkCost(maker, passes[i], passes[i + 1]) - LinkCost(maker, before, passes[i + 1]);
    std::optional<Gap> best;
    CutterPath reversed = passes[i];
    Reverse(reversed);
    for (const Gap& gap : GapsFor(passes, i, longest)) {
      const CutterPath &pass = gap.reversed ? reversed : passes[i], &from = passes[gap.after],
                       &to = passes[gap.after + 1];
      const double cost = LinkCost(maker, from, pass) + LinkCost(maker, pass, to) - LinkCost(maker, from, to);
      if (!(cost < least)) continue;
      least = cost;
      best = gap;
    }
    if (!best) continue;
    if (best->reversed) passes[i] = std::move(reversed);
    const auto at = [&](std::size_t k) { return passes.begin() + static_cast<std::ptrdiff_t>(k); };
    if (best->after < i) {
      std::rotate(at(best->after + 1), at(i), at(i + 1));
    } else {
      std::rotate(at(i), at(i + 1), at(best->after + 1));
      --i;  // another pass is at this place now
    }
  }
  PM_RETURN_IF_ERROR(run.Check());
  return passes;
}

}  // namespace patchmill
