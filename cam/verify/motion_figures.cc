#include "cam/verify/motion_figures.h"

#include <algorithm>
#include <cmath>

namespace patchmill {

namespace {

constexpr double kRounding = 2e-3;  // mm: shorter moves have no direction to speak of
constexpr double kSteep = Radians(30.0), kSteepSlack = Radians(0.5);
constexpr int kGrid = 256;

// Largest material height over squares of the plan; -infinity where there is none.
class HeightGrid {
 public:
  HeightGrid(const Surface& surface, double allowance, double top) {
    low_ = Plan(surface.box.min);
    const Vec2 size = Plan(surface.box.max) - low_;
    step_ = std::max(size.maxCoeff() / kGrid, 1e-9);
    nx_ = static_cast<int>(size.x() / step_) + 1;
    ny_ = static_cast<int>(size.y() / step_) + 1;
    height_.assign(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_), -kInfinity);
    for (const SurfaceNode& node : surface.nodes) {
      if (node.leaf < 0) continue;
      const double z = std::min(node.box.max.z() + allowance, top);
      ForEach(Plan(node.box.min).array() - allowance, Plan(node.box.max).array() + allowance,
              [&](double& h) { h = std::max(h, z); });
    }
  }
  // Every square becomes the highest within `radius`, in two passes over rows and columns.
  void Dilate(double radius) {
    const int reach = static_cast<int>(std::ceil(radius / step_)) + 1;
    const std::vector<double> before = height_;
    Slide(before, height_, nx_, ny_, 1, nx_, reach);
    const std::vector<double> rows = height_;
    Slide(rows, height_, ny_, nx_, nx_, 1, reach);
  }
  // Highest over the rectangle; also from outside of the grid, within `radius` of its border.
  double Highest(const Vec2& a, const Vec2& b, double radius) {
    double highest = -kInfinity;
    const Vec2 lo = a.cwiseMin(b), hi = a.cwiseMax(b);
    if ((hi - low_).minCoeff() < -radius || lo.x() > low_.x() + nx_ * step_ + radius ||
        lo.y() > low_.y() + ny_ * step_ + radius) {
      return highest;
    }
    ForEach(lo, hi, [&](double& h) { highest = std::max(highest, h); });
    return highest;
  }

 private:
  template <class F>
  void ForEach(const Vec2& lo, const Vec2& hi, F&& f) {
    const auto index = [&](double x, double origin, int n) {
      return static_cast<int>(std::clamp(std::floor((x - origin) / step_), 0.0, static_cast<double>(n - 1)));
    };
    const int i0 = index(lo.x(), low_.x(), nx_), i1 = index(hi.x(), low_.x(), nx_);
    const int j0 = index(lo.y(), low_.y(), ny_), j1 = index(hi.y(), low_.y(), ny_);
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) f(height_[static_cast<std::size_t>(j * nx_ + i)]);
    }
  }
  // out = largest of in within +- reach along lines of n values `stride` apart.
  static void Slide(const std::vector<double>& in, std::vector<double>& out, int n, int lines, int stride,
                    int line_stride, int reach) {
    for (int line = 0; line < lines; ++line) {
      const auto at = [&](int i) { return static_cast<std::size_t>(line * line_stride + i * stride); };
      for (int i = 0; i < n; ++i) {
        double most = -kInfinity;
        for (int k = std::max(0, i - reach); k <= std::min(n - 1, i + reach); ++k)
          most = std::max(most, in[at(k)]);
        out[at(i)] = most;
      }
    }
  }

  Vec2 low_;
  double step_ = 1.0;
  int nx_ = 0, ny_ = 0;
  std::vector<double> height_;
};

}  // namespace

MotionFigures MeasureMotion(const ProgramMotion& motion, const Tool& tool) {
  MotionFigures figures;
  for (std::size_t i = 0; i < motion.moves.size(); ++i) {
    const ProgramMove& move = motion.moves[i];
    if (!move.from_above) figures.tip_box.Add(move.from);
    if (!move.to_above) figures.tip_box.Add(move.to);
    if (move.from_above || move.to_above) continue;
    const Vec3 d = move.to - move.from;
    const bool rapid = move.kind == ProgramMove::Kind::kRapid;
    (rapid ? figures.rapid_length : figures.cut_length) += d.norm();
    if (rapid || d.norm() < kRounding) continue;
    const double descent = std::atan2(-d.z(), Plan(d).norm());
    figures.steepest_descent = std::max(figures.steepest_descent, descent);
    if (figures.steep_move < 0 && tool.plunge_feed > 0.0 && descent > kSteep + kSteepSlack &&
        -d.z() > 5.0 * kRounding && move.feed > tool.plunge_feed * (1.0 + 1e-6)) {
      figures.steep_move = static_cast<int>(i);
    }
  }
  return figures;
}

double RequiredStickout(const Surface& surface, const Tool& tool, const ProgramMotion& motion,
                        const VerifyParams& params) {
  if (surface.nodes.empty()) return 0.0;
  const double radius =
      std::max(BallRadius(tool), 0.5 * tool.shank_diameter.value_or(0.0)) + params.allowance;
  HeightGrid grid(surface, params.allowance, std::max(params.stock_top_z, surface.box.max.z()));
  grid.Dilate(radius);
  double stickout = 0.0;
  for (const ProgramMove& move : motion.moves) {
    if (move.from_above && move.to_above) continue;
    Vec3 a = move.from + params.program_zero, b = move.to + params.program_zero;
    if (move.from_above) a.z() = b.z();
    if (move.to_above) b.z() = a.z();
    const double low = std::min(a.z(), b.z());
    if (params.stock_top_z - low <= stickout && surface.box.max.z() - low <= stickout) continue;
    stickout = std::max(stickout, grid.Highest(Plan(a), Plan(b), radius) - low);
  }
  return stickout;
}

}  // namespace patchmill
