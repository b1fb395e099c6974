#include "cam/region/reach_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include <fmt/format.h>

#include "cam/tool/reach_give.h"
#include "core/base/parallel.h"
#include "core/base/share_progress.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kVertical = 1e-6;    // docs/reach.md
constexpr double kProof = 0.02;       // of what the ball may give: how exactly "free" is decided
constexpr double kLargestCell = 0.5;  // of the smallest radius, mm
constexpr double kLeastCell = 0.03;   // of it
constexpr int kDeepest = 8;           // halvings of a piece
constexpr int kGrid = 1 << (kDeepest + 1);

absl::Status Check(const ReachTableParams& params) {
  if (params.radii.empty() || params.radii.size() > kMaxReachRadii) {
    return absl::InvalidArgumentError(
        fmt::format("radii: {} given; must be 1 to {}", params.radii.size(), kMaxReachRadii));
  }
  for (std::size_t i = 0; i < params.radii.size(); ++i) {
    const double least = i == 0 ? 0.0 : params.radii[i - 1];
    if (!(params.radii[i] > least && std::isfinite(params.radii[i]))) {
      return absl::InvalidArgumentError(
          fmt::format("radii[{}] = {:g}; must be finite and above {:g}", i, params.radii[i], least));
    }
  }
  if (!(params.tolerance > 0.0 && params.tolerance < 0.5 * params.radii[0])) {
    return absl::InvalidArgumentError(
        fmt::format("tolerance = {:g}; must be in (0, {:g})", params.tolerance, 0.5 * params.radii[0]));
  }
  return absl::OkStatus();
}

// Areas of one piece by the number of radii that reach it.
class PieceTable {
 public:
  PieceTable(const Surface& surface, const Piece& piece, const ReachTableParams& params,
             const RunContext& run, ShareProgress& progress)
      : surface_(surface),
        piece_(piece),
        params_(params),
        run_(run),
        progress_(progress),
        area_(params.radii.size() + 1, 0.0) {
    const double side = LongestSide();
    largest_ = LevelFor(side / (kLargestCell * params.radii[0]));
    deepest_ = LevelFor(side / (kLeastCell * params.radii[0]));
  }

  std::vector<double> Measure() {
    Cell(0, 0, 0);
    return std::move(area_);
  }

 private:
  struct Sample {
    std::size_t reached = 0;  // radii[0 .. reached) reach it
    double element = 0.0;     // |S_u x S_v|
  };

  double LongestSide() const {
    constexpr int n = 4;
    double side = 0.0;
    for (int i = 0; i <= n; ++i) {
      for (int k = 0; k < n; ++k) {
        const double s = double(i) / n, t = double(k) / n, t1 = double(k + 1) / n;
        side = std::max(side, n * (Position(piece_, s, t) - Position(piece_, s, t1)).norm());
        side = std::max(side, n * (Position(piece_, t, s) - Position(piece_, t1, s)).norm());
      }
    }
    return side;
  }
  static int LevelFor(double cells) {
    return std::clamp(static_cast<int>(std::ceil(std::log2(std::max(1.0, cells)))), 0, kDeepest);
  }

  bool Reaches(double radius, const SurfaceJet& jet, const Vec3& normal) const {
    const double give = ReachGive(params_.tolerance);
    if (jet.p.z() + radius * (normal.z() - 1.0) < params_.floor_z - give) return false;
    const auto free = [&](const Vec3& center) {
      return !AnythingNearUpwardRay(surface_, center, radius - give, kProof * give);
    };
    return free(jet.p + radius * normal) || (normal.z() < kVertical && free(jet.p - radius * normal));
  }

  const Sample& At(int i, int j) {
    const auto [it, fresh] = samples_.try_emplace(i * (kGrid + 1) + j);
    if (!fresh) return it->second;
    Sample& sample = it->second;
    const SurfaceJet jet = Evaluate(piece_, static_cast<double>(i) / kGrid, static_cast<double>(j) / kGrid);
    sample.element = jet.du.cross(jet.dv).norm();
    const auto normal = UpwardNormal(jet);
    std::size_t low = 0, high = normal ? params_.radii.size() : 0;
    while (low < high) {
      const std::size_t middle = (low + high + 1) / 2;
      if (Reaches(params_.radii[middle - 1], jet, *normal)) {
        low = middle;
      } else {
        high = middle - 1;
      }
    }
    sample.reached = normal ? low : params_.radii.size();
    return sample;
  }

  void Cell(int level, int i, int j) {
    if (run_.Cancelled()) return;
    const int step = kGrid >> level;
    // Middle and corners with the weights of verify's areas: exact for a cubic area element.
    const Sample samples[5] = {At(i * step, j * step), At(i * step, (j + 1) * step),
                               At((i + 1) * step, j * step), At((i + 1) * step, (j + 1) * step),
                               At(i * step + step / 2, j * step + step / 2)};
    bool differ = false;
    for (const Sample& s : samples) differ = differ || s.reached != samples[4].reached;
    if (level < largest_ || (differ && level < deepest_)) {
      for (int k = 0; k < 4; ++k) Cell(level + 1, 2 * i + k / 2, 2 * j + k % 2);
      return;
    }
    progress_.Add(2 * level);
    const double size = std::ldexp(1.0, -2 * level);
    for (int k = 0; k < 5; ++k)
      area_[samples[k].reached] += size * (k == 4 ? 2.0 / 3.0 : 1.0 / 12.0) * samples[k].element;
  }

  const Surface& surface_;
  const Piece& piece_;
  const ReachTableParams& params_;
  const RunContext& run_;
  ShareProgress& progress_;
  std::vector<double> area_;
  int largest_ = 0, deepest_ = 0;
  std::unordered_map<int, Sample> samples_;  // looked up, never walked
};

}  // namespace

absl::StatusOr<ReachTableResult> ReachTable(const Surface& surface, const ReachTableParams& params,
                                            const RunContext& run) {
  PM_RETURN_IF_ERROR(Check(params));
  std::vector<std::vector<double>> pieces(surface.pieces.size());
  ShareProgress progress(run, "reach", pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, pieces.size(), [&](std::size_t i) {
    pieces[i] = PieceTable(surface, surface.pieces[i], params, run, progress).Measure();
  }));
  std::vector<double> reached(params.radii.size() + 1, 0.0);  // by how many of the radii
  for (const std::vector<double>& piece : pieces) {
    for (std::size_t k = 0; k < reached.size(); ++k) reached[k] += piece[k];
  }
  ReachTableResult table;
  for (std::size_t k = 0; k < params.radii.size(); ++k) {
    table.area += reached[k];
    table.unreachable.push_back(table.area);
    table.largest.push_back(reached[k + 1]);
  }
  table.area += reached.back();
  return table;
}

}  // namespace patchmill
