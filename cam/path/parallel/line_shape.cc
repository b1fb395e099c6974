#include "cam/path/parallel/line_shape.h"

#include <algorithm>
#include <cmath>

#include "core/base/status.h"

namespace patchmill {
namespace {

// Returns the index of the stretch in which t lies: 0 is the first between two knots, -1 lies before it, and
// the last knot's index stands for all beyond it.
int StretchOf(const LineShape& line, double t) {
  const double k = std::floor((t - line.begin) / line.spacing);
  return static_cast<int>(std::clamp(k, -1.0, static_cast<double>(line.y.size() - 1)));
}

}  // namespace

double LineShape::At(double t) const {
  const int k = StretchOf(*this, t);
  if (k < 0) return y.front();
  const auto i = static_cast<std::size_t>(k);
  if (i + 1 >= y.size()) return y.back();
  return y[i] + (y[i + 1] - y[i]) * ((t - begin) / spacing - k);
}

double LineShape::SlopeAt(double t) const {
  const int k = StretchOf(*this, t);
  const auto i = static_cast<std::size_t>(k);
  return k < 0 || i + 1 >= y.size() ? 0.0 : (y[i + 1] - y[i]) / spacing;
}

LineShape Between(const LineShape& a, const LineShape& b, double share) {
  PM_CHECK(a.straight() || b.straight() || a.y.size() == b.y.size());
  LineShape line = a.straight() ? b : a;
  for (std::size_t k = 0; k < line.y.size(); ++k) {
    const double from = a.straight() ? a.y.front() : a.y[k], to = b.straight() ? b.y.front() : b.y[k];
    line.y[k] = from + (to - from) * share;
  }
  return line;
}

std::vector<double> CornersOf(const LineShape& line, double t0, double t1) {
  // dy/dt: smaller turns are no corners.
  constexpr double kTurn = 1e-6;
  std::vector<double> corners = {t0};
  for (std::size_t k = 0; !line.straight() && k < line.y.size(); ++k) {
    const double t = line.begin + line.spacing * static_cast<double>(k);
    if (t <= t0 || t >= t1) continue;
    const double before = k > 0 ? line.y[k] - line.y[k - 1] : 0.0;
    const double after = k + 1 < line.y.size() ? line.y[k + 1] - line.y[k] : 0.0;
    if (std::abs(after - before) > kTurn * line.spacing) corners.push_back(t);
  }
  corners.push_back(t1);
  return corners;
}

}  // namespace patchmill
