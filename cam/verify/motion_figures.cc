#include "cam/verify/motion_figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cam/limits/upper_cylinders.h"
#include "core/base/status.h"

namespace patchmill {

namespace {

constexpr double kRounding = 2e-3;        // mm; rounding dominates the direction of shorter moves
constexpr double kTraceable = 0.02;       // mm; rounding to 1e-4 mm turns this length by up to 0.25 degrees
constexpr double kTraceableTicks = 20.0;  // the same where the last digit is worth more
constexpr double kSteepSlack = Radians(0.5);  // added to kSteepDescent because of rounding
constexpr int kGrid = 256;                    // squares along the longer side of the plan

// Largest height of material over each square of the plan; -infinity if there is none.
class HeightGrid {
 public:
  HeightGrid(const Surface& surface, const StockDepth& allowance, double top, const RunContext& run) {
    low_ = Xy(surface.box.min);
    const Vec2 size = Xy(surface.box.max) - low_;
    step_ = std::max(size.maxCoeff() / kGrid, 1e-9);
    nx_ = static_cast<int>(size.x() / step_) + 1;
    ny_ = static_cast<int>(size.y() / step_) + 1;
    height_.assign(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_), -kInfinity);
    for (const SurfaceNode& node : surface.nodes) {
      if (run.Cancelled()) return;
      if (node.leaf < 0) continue;
      const double z = std::min(node.box.max.z() + allowance.floors, top);
      ForEach(Xy(node.box.min).array() - allowance.walls, Xy(node.box.max).array() + allowance.walls,
              [&](double& h) { h = std::max(h, z); });
    }
  }
  // Sets each square to the largest height within `radius`, in two passes over rows and columns.
  void Dilate(double radius) {
    const double squares = std::min(std::ceil(radius / step_), static_cast<double>(std::max(nx_, ny_)));
    const int reach = static_cast<int>(squares) + 1;
    const std::vector<double> before = height_;
    Slide(before, height_, {nx_, ny_, 1, nx_}, reach);
    const std::vector<double> rows = height_;
    Slide(rows, height_, {ny_, nx_, nx_, 1}, reach);
  }
  // The largest height in the rectangle with corners a and b and sides along x and y. If the rectangle lies
  // outside of the grid, but within `radius` of it, the outermost squares count.
  double HighestIn(const Vec2& a, const Vec2& b, double radius) {
    const Vec2 lo = a.cwiseMin(b), hi = a.cwiseMax(b), high = low_ + step_ * Vec2(nx_, ny_);
    double highest = -kInfinity;
    if ((lo.array() > high.array() + radius).any() || (hi.array() < low_.array() - radius).any())
      return highest;
    ForEach(lo, hi, [&](double& h) { highest = std::max(highest, h); });
    return highest;
  }
  // The largest height near the line from a to b: over the squares that it touches and some next to its
  // corners. Parts outside of the grid, but within `radius` of it, count as its border. Cost: a few squares
  // for each row or column that the line crosses.
  double Highest(const Vec2& a, const Vec2& b, double radius) {
    constexpr double kMostParts = 1024.0;  // of one line
    double highest = -kInfinity, begin = 0.0, end = 1.0;
    const Vec2 d = b - a, margin = Vec2::Constant(radius);
    const Vec2 low = low_ - margin, high = low_ + step_ * Vec2(nx_, ny_) + margin;
    for (const int k : {0, 1}) {
      if (d[k] == 0.0) {
        if (a[k] < low[k] || a[k] > high[k]) return highest;
        continue;
      }
      const double s = (low[k] - a[k]) / d[k], t = (high[k] - a[k]) / d[k];
      begin = std::max(begin, std::min(s, t));
      end = std::min(end, std::max(s, t));
    }
    if (begin > end) return highest;
    const Vec2 part = (end - begin) * d;
    const double parts = std::clamp(std::ceil(part.cwiseAbs().maxCoeff() / step_), 1.0, kMostParts);
    Vec2 from = a + begin * d;
    for (double i = 1.0; i <= parts; i += 1.0) {
      const Vec2 to = a + begin * d + i / parts * part;
      ForEach(from.cwiseMin(to), from.cwiseMax(to), [&](double& h) { highest = std::max(highest, h); });
      from = to;
    }
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
  // How the rows or the columns lie in memory: `lines` lines of n values each. The values are `stride` apart
  // and the lines `line_stride`.
  struct Lines {
    int n, lines, stride, line_stride;
  };
  // Sets each value of `out` to the largest value of `in` within +- reach places along its line.
  static void Slide(const std::vector<double>& in, std::vector<double>& out, const Lines& along, int reach) {
    for (int line = 0; line < along.lines; ++line) {
      const auto at = [&](int i) {
        return static_cast<std::size_t>(line * along.line_stride + i * along.stride);
      };
      for (int i = 0; i < along.n; ++i) {
        double most = -kInfinity;
        for (int k = std::max(0, i - reach); k <= std::min(along.n - 1, i + reach); ++k)
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

constexpr double kFeedDigits = 5e-5;  // mm/min, rounding of F words to four decimals

// Finds steep descents that are faster than plunge feed, even if they are divided into tiny moves: moves are
// added up until rounding no longer dominates their direction. The lengths in plan are added up, too, so a
// helix is as steep as its moves.
class DescentWatch {
 public:
  // `tick`: what the last digit of the program's coordinates is worth, mm.
  DescentWatch(double plunge_feed, double tick)
      : plunge_feed_(plunge_feed), traceable_(std::max(kTraceable, kTraceableTicks * tick)), tick_(tick) {}

  // Adds the move with this index. Returns how many moves, this one last, are a descent that is steeper than
  // allowed; 0 if none is.
  int Add(const ProgramMove& move) {
    const bool watched = plunge_feed_ > 0.0 && move.kind == ProgramMove::Kind::kFeed && !move.from_above &&
                         !move.to_above && move.feed > plunge_feed_ * (1.0 + 1e-6) + kFeedDigits;
    if (!watched) {
      Restart();
      return 0;
    }
    const Vec3 d = move.to - move.from;
    drop_ -= d.z();
    along_ += Xy(d).norm();
    ++count_;
    const double length = std::hypot(drop_, along_);
    if (length < traceable_) return 0;
    // Both ends are off by half of the last digit at most, down and in plan.
    const double slack = std::max(kSteepSlack, std::numbers::sqrt2 * tick_ / length);
    const int steep = std::atan2(drop_, along_) > kSteepDescent + slack ? count_ : 0;
    Restart();
    return steep;
  }

 private:
  void Restart() {
    drop_ = along_ = 0.0;
    count_ = 0;
  }

  double plunge_feed_, traceable_, tick_;
  int count_ = 0;                    // moves since the last test
  double drop_ = 0.0, along_ = 0.0;  // mm, down and in plan, since the last test
};

// The step of the last digit of the program's coordinates, mm: the largest of the usual steps that the
// ends of all lines are multiples of. Places along an arc are none.
double LastDigit(const ProgramMotion& motion) {
  constexpr double kInch = 25.4, kSmallest = 1e-4, kSame = 1e-7;  // mm
  for (const double tick : {1e-3 * kInch, 1e-2, 1e-4 * kInch, 1e-3, 1e-5 * kInch}) {
    bool all = true;
    for (std::size_t k = 0; k < motion.moves.size() && all; ++k) {
      const ProgramMove& move = motion.moves[k];
      if (move.to_above || move.from_anywhere) continue;
      if (k + 1 < motion.moves.size() && motion.moves[k + 1].line == move.line) continue;
      for (int c = 0; c < 3; ++c) {
        const double x = move.to[c];
        all = all && std::abs(x - tick * std::round(x / tick)) <= kSame;
      }
    }
    if (all) return tick;
  }
  return kSmallest;
}

}  // namespace

MotionFigures MeasureMotion(const ProgramMotion& motion, const Tool& tool) {
  MotionFigures figures;
  DescentWatch watch(tool.plunge_feed, LastDigit(motion));
  int line = 0;  // of the last feed move
  for (std::size_t i = 0; i < motion.moves.size(); ++i) {
    const ProgramMove& move = motion.moves[i];
    for (int k = watch.Add(move); k-- > 0;) figures.steep_moves.push_back(static_cast<int>(i) - k);
    if (!move.from_above) figures.tip_box.Add(move.from);
    if (!move.to_above) figures.tip_box.Add(move.to);
    if (move.from_above || move.to_above) continue;
    const Vec3 d = move.to - move.from;
    const bool rapid = move.kind == ProgramMove::Kind::kRapid;
    (rapid ? figures.rapid_length : figures.cut_length) += d.norm();
    if (!rapid && move.line != line) {
      line = move.line;
      ++figures.feed_blocks;
      if (move.chord_error > 0.0) ++figures.arc_blocks;
    }
    if (rapid || d.norm() < kRounding) continue;
    figures.steepest_descent = std::max(figures.steepest_descent, std::atan2(-d.z(), Xy(d).norm()));
  }
  return figures;
}

absl::StatusOr<double> RequiredStickout(const Surface& surface, const Tool& tool, const ProgramMotion& motion,
                                        const VerifyParams& params, const RunContext& run) {
  constexpr std::size_t kMovesBetweenPolls = 1024;
  if (surface.nodes.empty()) return 0.0;
  const double radius = WidestRadius(tool) + params.allowance.walls;
  HeightGrid grid(surface, params.allowance, std::max(params.stock_top_z, surface.box.max.z()), run);
  grid.Dilate(radius);
  double stickout = 0.0;
  for (std::size_t i = 0; i < motion.moves.size(); ++i) {
    if (i % kMovesBetweenPolls == 0) PM_RETURN_IF_ERROR(run.Check());
    const ProgramMove& move = motion.moves[i];
    if (move.from_above && move.to_above) continue;
    Vec3 a = move.from + params.program_zero, b = move.to + params.program_zero;
    if (move.from_above) a.z() = b.z();
    if (move.to_above) b.z() = a.z();
    const double low = std::min(a.z(), b.z());
    if (params.stock != nullptr && params.stock_top_z - low > stickout &&
        params.stock->SegmentComesNearer(Lift(Xy(a), -kInfinity), Lift(Xy(b), -kInfinity),
                                         WidestRadius(tool)))
      stickout = params.stock_top_z - low;
    if (params.stock_top_z - low <= stickout && surface.box.max.z() - low <= stickout) continue;
    stickout = std::max(stickout, grid.Highest(Xy(a), Xy(b), radius) - low);
    if (move.kind == ProgramMove::Kind::kRapid)
      stickout = std::max(stickout, grid.HighestIn(Xy(a), Xy(b), radius) - low);
  }
  return stickout;
}

}  // namespace patchmill
