#include "cam/link/on_the_way.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "cam/link/order_passes.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr std::size_t kMostPasses = 64, kGaps = 4;

const CutterPoint& StartOf(const CutterPath& pass) { return pass.points.front(); }
const CutterPoint& EndOf(const CutterPath& pass) {
  return pass.closed ? pass.points.front() : pass.points.back();
}

bool IsShort(const CutterPath& pass, double longest) {
  const bool mends =
      pass.kind == PassKind::kBorder || pass.kind == PassKind::kCrease || pass.kind == PassKind::kRest;
  return mends && !pass.closed && !pass.one_way && !pass.spiral && Length(pass) <= longest;
}

// Between the pass `after` and the next one.
struct Gap {
  std::size_t after = 0;
  bool reversed = false;
  double way = 0.0;  // mm, straight: what the two links are longer than the one they replace
};

// The nearest ones, the nearest first.
std::vector<Gap> GapsFor(const std::vector<CutterPath>& passes, std::size_t which, double longest) {
  const CutterPath& pass = passes[which];
  const Vec3 start = StartOf(pass).center, end = EndOf(pass).center;
  std::vector<Gap> gaps;
  for (std::size_t i = 0; i + 1 < passes.size(); ++i) {
    if (i == which || i + 1 == which) continue;
    const CutterPath &a = passes[i], &b = passes[i + 1];
    if (a.kind == PassKind::kContour || b.kind == PassKind::kContour || b.one_way) continue;
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

class Improver {
 public:
  Improver(const LinkMaker& maker, std::vector<CutterPath>& passes) : maker_(maker), passes_(passes) {}

  bool FromOverTheTop(std::size_t i) const {
    const std::vector<Move> moves = Moves(i - 1, passes_[i]);
    return std::any_of(moves.begin(), moves.end(), [](const Move& m) { return m.kind == MoveKind::kRapid; });
  }
  // s: saved by taking pass `which` out.
  double Saved(std::size_t which) const {
    double saved = Time(which - 1, passes_[which]);
    if (which + 1 < passes_.size())
      saved += Time(which, passes_[which + 1]) - Time(which - 1, passes_[which + 1]);
    return saved;
  }
  // s: what putting `pass` there takes more.
  double Cost(const Gap& gap, const CutterPath& pass) const {
    const CutterPath& next = passes_[gap.after + 1];
    return Time(gap.after, pass) + TimeOf(EndOf(pass).center, LinkTo(maker_, EndOf(pass), next)) -
           Time(gap.after, next);
  }

 private:
  std::vector<Move> Moves(std::size_t from, const CutterPath& to) const {
    return LinkTo(maker_, EndOf(passes_[from]), to);
  }
  double Time(std::size_t from, const CutterPath& to) const {
    return TimeOf(EndOf(passes_[from]).center, Moves(from, to));
  }
  const LinkMaker& maker_;
  std::vector<CutterPath>& passes_;
};

}  // namespace

absl::StatusOr<std::vector<CutterPath>> PutOnTheWay(const LinkMaker& maker, std::vector<CutterPath> passes,
                                                    const LinkParams& params, const RunContext& run) {
  const double longest = MaxLinkLength(params);
  const Improver improver(maker, passes);
  std::size_t tried = 0;
  for (std::size_t i = 1; i < passes.size() && tried < kMostPasses; ++i) {
    PM_RETURN_IF_ERROR(run.Check());
    if (!IsShort(passes[i], longest) || !improver.FromOverTheTop(i)) continue;
    ++tried;
    run.Progress("link: on the way", static_cast<double>(i) / static_cast<double>(passes.size()));
    double least = improver.Saved(i);
    std::optional<Gap> best;
    CutterPath reversed = passes[i];
    Reverse(reversed);
    for (const Gap& gap : GapsFor(passes, i, longest)) {
      const double cost = improver.Cost(gap, gap.reversed ? reversed : passes[i]);
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
      --i;  // another one has come here
    }
  }
  PM_RETURN_IF_ERROR(run.Check());
  return passes;
}

}  // namespace patchmill
