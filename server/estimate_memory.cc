#include "server/estimate_memory.h"

#include <algorithm>
#include <cmath>
#include <variant>

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

constexpr double kStockColumns = 800.0, kCoveredCells = 1500.0;  // squares along the longer side
constexpr double kBytesPerPatch = 12e3, kBytesPerControlPoint = 400.0;

// Patches with their control points, in bytes.
double BytesOfPatches(const PatchModel& model) {
  double controls = 0.0;
  for (const Patch& patch : model.patches) {
    const auto bulges = static_cast<double>(Bulges(patch.shape).size());
    controls += static_cast<double>(ControlPoints(patch.shape).size()) + 64.0 * bulges * (bulges + 2.0);
  }
  return kBytesPerPatch * static_cast<double>(model.patches.size()) + kBytesPerControlPoint * controls;
}

// Squares along both sides of a plan of this size, if the longer side has `cells` of them.
double Squares(const Vec2& size, double cells) {
  const double longer = size.maxCoeff();
  return longer > 0.0 ? cells * std::max(1.0, cells * size.minCoeff() / longer) : 0.0;
}

// The stock: a model with its columns (cam/limits/stock_columns), and the squares that the part covers, where
// it has been roughed (cam/limits/stock_solid).
double BytesOfStock(const Setup& setup) {
  constexpr double kBytesPerColumn = 24.0, kBytesPerCoveredSquare = 24.0;
  double bytes = 0.0;
  if (const auto* stock = std::get_if<ModelStock>(&setup.stock_body); stock != nullptr && stock->surface) {
    const Surface& surface = *stock->surface;
    const Vec2 size = Xy(surface.box.max) - Xy(surface.box.min);
    bytes += BytesOfPatches(surface.network.model) + kBytesPerColumn * Squares(size, kStockColumns);
  } else if (!std::holds_alternative<NoStockBody>(setup.stock_body) && setup.allowance_stated) {
    bytes += kBytesPerCoveredSquare * kCoveredCells * kCoveredCells;  // of a part as wide as long
  }
  return bytes;
}

}  // namespace

std::int64_t EstimateMemory(const PatchModel& model, const Job& job) {
  constexpr double kProgramBytes = 24e6;
  constexpr double kBytesPerPoint = 600.0, kPointSpacing = 0.4;  // mm along a pass
  double area = 0.0;
  for (const Patch& patch : model.patches) area += AreaOfBox(patch.shape);
  const double scale = job.setup.placement.scale;
  const double radius = BallRadius(job.operation.tool);
  const double scallop = std::min(job.operation.scallop, radius);
  const double step = 2.0 * std::sqrt(std::max(scallop * (2.0 * radius - scallop), 1e-12));
  const double points = std::min(area * scale * scale / (step * kPointSpacing), limits::kMaxPathPoints);
  const double bytes =
      kProgramBytes + BytesOfPatches(model) + BytesOfStock(job.setup) + kBytesPerPoint * points;
  return static_cast<std::int64_t>(bytes);
}

}  // namespace patchmill
