#include "cam/link/link_paths.h"

#include <algorithm>
#include <cmath>

#include "cam/link/link_moves.h"
#include "cam/link/order_passes.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

// mm/min; only the time estimate uses it, machines differ.
constexpr double kAssumedRapid = 5000.0;

void AppendPass(const CutterPath& pass, int index, const LinkMaker& maker, const Surface& surface,
                std::vector<Move>& moves) {
  const std::size_t count = pass.points.size() + (pass.closed ? 1 : 0);
  for (std::size_t i = 1; i < count; ++i) {
    const CutterPoint& from = pass.points[i - 1];
    const CutterPoint& to = pass.points[i % pass.points.size()];
    Move move = maker.Feed(MoveKind::kCut, from.center, to.center);
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
    if (moves[i].kind == MoveKind::kRapid) {
      stats.rapid_length += length;
      stats.time += 60.0 * length / kAssumedRapid;
      continue;
    }
    if (moves[i].kind == MoveKind::kRetract) ++stats.retract_count;
    (moves[i].kind == MoveKind::kCut ? stats.cut_length : stats.link_length) += length;
    stats.time += 60.0 * length / moves[i].feed;
    if (d.z() < 0.0)
      stats.steepest_descent = std::max(stats.steepest_descent, std::atan2(-d.z(), Plan(d).norm()));
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
      if (path.kind == PassKind::kContour) Reverse(path);
    }
  }
  LinkResult result;
  result.toolpath.ball_radius = params.radius;
  PM_ASSIGN_OR_RETURN(result.passes,
                      OrderPasses(regions, std::move(paths),
                                  {.neighbor_distance = params.radius,
                                   .reversible_contours = params.contour_direction == CutDirection::kEither},
                                  run));
  const Locator stock_locator(locator.surface(), params.radius + params.allowance + params.approach_gap);
  const LinkMaker maker(locator, stock_locator, params, run);
  std::vector<Move>& moves = result.toolpath.moves;

  const CutterPoint* end = nullptr;  // where the last pass ended
  for (std::size_t i = 0; i < result.passes.size(); ++i) {
    PM_RETURN_IF_ERROR(run.Check());
    const CutterPath& pass = result.passes[i];
    const CutterPoint& start = pass.points.front();
    std::optional<std::vector<Move>> link;
    if (end != nullptr && !pass.one_way) link = maker.StayDown(end->center, start.center);
    if (link) {
      for (Move& move : *link) moves.push_back(move);
    } else {
      if (end != nullptr) maker.Retract(*end, moves);
      maker.Approach(start, moves);
    }
    AppendPass(pass, static_cast<int>(i), maker, locator.surface(), moves);
    end = pass.closed ? &pass.points.front() : &pass.points.back();
    run.Progress("link", static_cast<double>(i + 1) / static_cast<double>(result.passes.size()));
  }
  if (end != nullptr) maker.Retract(*end, moves);
  PM_RETURN_IF_ERROR(run.Check());
  result.stats = Measure(moves);
  return result;
}

}  // namespace patchmill
