#include "server/estimate_memory.h"

#include <algorithm>
#include <cmath>

#include "core/network/control_points.h"
#include "server/limits.h"

namespace patchmill {
namespace {

// Half the surface of the box around the control points: the sum of its projections on three planes. The area
// of a patch is at most that where each projection of the patch is one to one.
double AreaOfBox(const PatchShape& shape) {
  Box3 box;
  for (const Vec3& p : ControlPoints(shape)) box.Add(p);
  if (box.Empty()) return 0.0;
  const Vec3 size = box.max - box.min;
  return size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
}

}  // namespace

std::int64_t EstimateMemory(const PatchModel& model, const Job& job) {
  constexpr double kProgramBytes = 24e6, kBytesPerPatch = 12e3, kBytesPerControlPoint = 400.0;
  constexpr double kBytesPerPoint = 600.0, kPointSpacing = 0.4;  // mm along a pass
  double area = 0.0, controls = 0.0;
  for (const Patch& patch : model.patches) {
    area += AreaOfBox(patch.shape);
    const auto bulges = static_cast<double>(Bulges(patch.shape).size());
    controls += static_cast<double>(ControlPoints(patch.shape).size()) + 64.0 * bulges * (bulges + 2.0);
  }
  const double scale = job.setup.placement.scale;
  const double radius = BallRadius(job.operation.tool);
  const double scallop = std::min(job.operation.scallop, radius);
  const double step = 2.0 * std::sqrt(std::max(scallop * (2.0 * radius - scallop), 1e-12));
  const double points = std::min(area * scale * scale / (step * kPointSpacing), limits::kMaxPathPoints);
  const double bytes = kProgramBytes + kBytesPerPatch * static_cast<double>(model.patches.size()) +
                       kBytesPerControlPoint * controls + kBytesPerPoint * points;
  return static_cast<std::int64_t>(bytes);
}

}  // namespace patchmill
