#include "cam/link/turn_passes.h"

#include <cstddef>
#include <utility>

#include "core/base/status.h"

namespace patchmill {
namespace {

bool MayTurn(const CutterPath& pass) {
  return !pass.closed && pass.traversal == Traversal::kAny && pass.kind != PassKind::kContour &&
         pass.points.size() > 1;
}

double Straight(const PassEnd& end, const PassEnd& start) { return (start.center() - end.center()).norm(); }

double LinkCost(const LinkMaker& maker, const PassEnd& end, const CutterPath& next) {
  return CostOf(maker, end, LinkTo(maker, end, next));
}

}  // namespace

absl::StatusOr<std::vector<CutterPath>> WithPassesTurned(const LinkMaker& maker,
                                                         std::vector<CutterPath> passes,
                                                         const RunContext& run) {
  for (std::size_t i = 1; i + 1 < passes.size(); ++i) {
    CutterPath& pass = passes[i];
    if (!MayTurn(pass)) continue;
    PM_RETURN_IF_ERROR(run.Check());
    const PassEnd before = PassEnd::End(passes[i - 1]);
    const CutterPath& next = passes[i + 1];
    const PassEnd start = PassEnd::Start(pass), end = PassEnd::End(pass), after = PassEnd::Start(next);
    if (Straight(before, end) + Straight(start, after) >= Straight(before, start) + Straight(end, after))
      continue;
    CutterPath turned = pass;
    Reverse(turned);
    const double cost = LinkCost(maker, before, pass) + LinkCost(maker, end, next);
    if (LinkCost(maker, before, turned) + LinkCost(maker, PassEnd::End(turned), next) < cost)
      pass = std::move(turned);
  }
  PM_RETURN_IF_ERROR(run.Check());
  return passes;
}

}  // namespace patchmill
