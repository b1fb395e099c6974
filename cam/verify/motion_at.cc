#include "cam/verify/motion_at.h"

#include <algorithm>

#include "cam/toolpath/segment_tree.h"
#include "cam/verify/motion_sets.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {

absl::StatusOr<MotionAtPoints> MeasureAt(std::span<const Vec3> points, const BallMotion& ball,
                                         const RunContext& run) {
  const Vec3 offset = ball.program_zero + Vec3(0.0, 0.0, ball.ball_radius);
  const double radius = ball.ball_radius + ball.leave;
  const SegmentTree feeds(CollectMoves(*ball.motion, MotionSet::kCut, offset), Metric::kPath, radius, run);
  const SegmentTree swept(CollectMoves(*ball.motion, MotionSet::kSwept, offset), Metric::kSwept, radius, run);
  PM_RETURN_IF_ERROR(run.Check());
  Box3 box;
  for (const Vec3& p : points) box.Add(p);
  for (const ProgramMove& move : ball.motion->moves) {
    if (!move.to_above) box.Add(Vec3(move.to + offset));
  }
  const double most = box.Diagonal();
  MotionAtPoints at;
  at.leftover.assign(points.size(), most);
  at.gouge.assign(points.size(), 0.0);
  constexpr std::size_t kChunk = 256;  // points in one task
  const std::size_t chunks = (points.size() + kChunk - 1) / kChunk;
  PM_RETURN_IF_ERROR(ParallelFor(run, "leftover at vertices", chunks, [&](std::size_t chunk) {
    int feed_hint = -1, swept_hint = -1;
    const std::size_t end = std::min(points.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end && !run.Cancelled(); ++i) {
      const auto feed = feeds.FindNearest(points[i], kInfinity, feed_hint);
      if ((feed_hint = feed.segment) >= 0) at.leftover[i] = std::min(feed.distance - radius, most);
      const auto move = swept.FindNearest(points[i], radius, swept_hint);
      if ((swept_hint = move.segment) >= 0) at.gouge[i] = std::max(0.0, radius - move.distance);
    }
  }));
  return at;
}

}  // namespace patchmill
