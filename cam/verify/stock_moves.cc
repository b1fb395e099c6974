#include "cam/verify/stock_moves.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace patchmill {
namespace {

constexpr double kStep = 0.05;  // radii: how far apart places of a cut that is too deep are measured
constexpr std::size_t kMovesBetweenPolls = 1024;

// True if stock above the lower end of a shank stands within `room` (mm, in plan) of its axis, where the
// lower end moves from a up to b. The move is halved until a half is level or short.
bool ComesBesideStock(const StockSolid& stock, const Vec3& a, const Vec3& b, double room) {
  constexpr double kShort = 0.05;  // mm
  if (!stock.SegmentComesNearer(Lift(Xy(a), -kInfinity), Lift(Xy(b), -kInfinity), room)) return false;
  const double top = stock.TopNear(Xy(a), Xy(b), room);
  if (top <= a.z()) return false;
  if (top >= stock.top_z() && stock.has_one_top()) return true;
  if ((b - a).norm() < kShort) return true;
  const Vec3 middle = 0.5 * (a + b);
  return ComesBesideStock(stock, a, middle, room) || ComesBesideStock(stock, middle, b, room);
}

}  // namespace

DeepCuts FindDeepCuts(const StockSolid& stock, const std::vector<PathSegment>& feeds, double radius,
                      const StockDepth& limit, const RunContext& run) {
  DeepCuts cuts;
  const double allowed = limit.Least() + stock.accuracy(), step = kStep * radius;
  for (std::size_t k = 0; k < feeds.size(); ++k) {
    if (k % kMovesBetweenPolls == 0 && run.Cancelled()) return cuts;
    const PathSegment& feed = feeds[k];
    const double length = (feed.b - feed.a).norm();
    for (double gone = 0.0;;) {
      const Vec3 c = length > 0.0 ? Vec3(feed.a + gone / length * (feed.b - feed.a)) : feed.a;
      const double depth = radius - stock.Distance(c);
      const double here = depth > allowed ? stock.DepthAt(c, limit) : limit.Least();
      const bool deep = depth > here + stock.accuracy();
      if (deep && depth > cuts.deepest) {
        cuts.deepest = depth;
        cuts.limit = here;
        cuts.center = c;
        cuts.move = feed.move;
      }
      if (gone >= length) break;
      const double next = std::min(length, gone + std::max(step, allowed - depth));
      if (deep) cuts.length += next - gone;
      gone = next;
    }
  }
  return cuts;
}

int FirstInStock(const StockSolid& stock, const std::vector<PathSegment>& moves, double radius, bool any_way,
                 const RunContext& run) {
  for (std::size_t k = 0; k < moves.size(); ++k) {
    if (k % kMovesBetweenPolls == 0 && run.Cancelled()) return -1;
    const auto& [a, b, move] = moves[k];
    const double room = radius - stock.accuracy();
    if (!any_way) {
      if (stock.SegmentComesNearer(a, b, room)) return move;
      continue;
    }
    if (stock.RectangleComesNearer(Xy(a), Xy(b), std::min(a.z(), b.z()), room)) return move;
  }
  return -1;
}

int FirstShankInStock(const StockSolid& stock, const std::vector<PathSegment>& moves, double radius,
                      double limit, const RunContext& run) {
  const double room = radius - limit - stock.accuracy();
  for (std::size_t k = 0; k < moves.size(); ++k) {
    if (k % kMovesBetweenPolls == 0 && run.Cancelled()) return -1;
    auto [a, b, move] = moves[k];
    if (a.z() > b.z()) std::swap(a, b);
    if (a.z() >= stock.top_z()) continue;
    // The part of the move below the top, where the distance is that in plan.
    if (b.z() > stock.top_z()) b = a + (stock.top_z() - a.z()) / (b.z() - a.z()) * (b - a);
    if (ComesBesideStock(stock, a, b, room)) return move;
  }
  return -1;
}

}  // namespace patchmill
