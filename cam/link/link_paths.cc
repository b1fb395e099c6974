#include "cam/link/link_paths.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "cam/link/insert_passes.h"
#include "cam/link/link_moves.h"
#include "cam/link/order_passes.h"
#include "cam/link/surface_heights.h"
#include "cam/link/turn_passes.h"
#include "cam/toolpath/motion_time.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

void AppendPass(const CutterPath& pass, int index, const MoveCheck& check, std::vector<Move>& moves) {
  const Surface& surface = check.locator().surface();
  const std::size_t count = pass.points.size() + (pass.closed ? 1 : 0);
  for (std::size_t i = 1; i < count; ++i) {
    const CutterPoint& from = pass.points[i - 1];
    const CutterPoint& to = pass.points[i % pass.points.size()];
    Move move = check.Feed(MoveKind::kCut, from.center, to.center);
    move.region = pass.region;
    move.pass = index;
    if (to.contact) move.contact = {to.contact->p, surface.piece(to.contact->piece).patch};
    moves.push_back(move);
  }
}

LinkStats Measure(const std::vector<Move>& moves) {
  LinkStats stats;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    const Vec3 d = moves[i].to - moves[i - 1].to;
    const double length = d.norm();
    stats.time += EstimatedTime(moves[i], length);
    if (moves[i].kind == MoveKind::kRapid) {
      if (moves[i - 1].kind != MoveKind::kRapid) ++stats.retract_count;
      stats.rapid_length += length;
      continue;
    }
    (moves[i].kind == MoveKind::kCut ? stats.cut_length : stats.link_length) += length;
    if (d.z() < 0.0)
      stats.steepest_descent = std::max(stats.steepest_descent, std::atan2(-d.z(), Xy(d).norm()));
  }
  return stats;
}

}  // namespace

absl::StatusOr<LinkResult> LinkPaths(const Locator& locator, const RegionMap& regions,
                                     std::vector<CutterPath> paths, const LinkParams& params,
                                     const RunContext& run) {
  std::erase_if(paths, [](const CutterPath& p) { return p.points.empty(); });
  if (params.contour_direction == CutDirection::kConventional) {
    for (CutterPath& path : paths) {
      if (path.kind == PassKind::kContour && path.traversal != Traversal::kSpiral) Reverse(path);
    }
  }
  std::optional<SurfaceHeights> heights;
  const double clear = params.radius + params.allowance.walls + params.approach_gap;
  if (params.low_rapids) heights.emplace(locator.surface(), clear);
  const double leads = 2.0 * (params.allowance.Most() + params.approach_gap);
  const auto travel = [&](const Vec3& a, const Vec3& b) {
    const double length = (b - a).norm();
    double top = params.clearance_z + params.radius;
    if (heights)
      top = std::min(top, std::max({a.z(), b.z(),
                                    heights->HighestOver(Xy(a), Xy(b)) + clear + params.allowance.Rise()}));
    const double over = std::max(0.0, 2.0 * top - a.z() - b.z());
    const double time = leads / params.feed + (over + Xy(b - a).norm()) / kAssumedRapid;
    return 60.0 * (length <= MaxLinkLength(params) ? std::min(time, length / params.feed) : time);
  };
  LinkResult result;
  result.toolpath.ball_radius = params.radius;
  PM_ASSIGN_OR_RETURN(result.passes,
                      OrderPasses(regions, std::move(paths),
                                  {.neighbor_distance = params.radius,
                                   .at_hand = MaxLinkLength(params),  // as far as a stay-down link may lead
                                   .reversible_contours = params.contour_direction == CutDirection::kEither,
                                   .travel = travel},
                                  run));
  const Locator stock_locator(locator.surface(), clear);
  const LinkMaker maker(locator, stock_locator, params, run);
  PM_ASSIGN_OR_RETURN(result.passes, InsertPasses(maker, std::move(result.passes), params, run));
  PM_ASSIGN_OR_RETURN(result.passes, WithPassesTurned(maker, std::move(result.passes), run));
  std::vector<Move>& moves = result.toolpath.moves;

  double saved = 0.0;  // mm
  const auto add = [&](Link link) {
    for (Move& move : link.moves) moves.push_back(std::move(move));
    result.leads.insert(result.leads.end(), link.leads.begin(), link.leads.end());
    saved += link.saved_by_low_rapids;
  };
  for (std::size_t i = 0; i < result.passes.size(); ++i) {
    PM_RETURN_IF_ERROR(run.Check());
    const CutterPath& pass = result.passes[i];
    add(i == 0 ? maker.Approach(PassEnd::Start(pass))
               : LinkTo(maker, PassEnd::End(result.passes[i - 1]), pass));
    AppendPass(pass, static_cast<int>(i), maker.check(), moves);
    run.Progress("link", static_cast<double>(i + 1) / static_cast<double>(result.passes.size()));
  }
  if (!result.passes.empty()) add(maker.Retract(PassEnd::End(result.passes.back())));
  PM_RETURN_IF_ERROR(run.Check());
  result.stats = Measure(moves);
  result.stats.saved_by_low_rapids = saved;
  return result;
}

}  // namespace patchmill
