#include "core/surface/concave_radius.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"
#include "core/surface/air_sides.h"

namespace patchmill {
namespace {

constexpr std::size_t kBlock = 256;  // leaves that one task samples

// The place's unit normal on the side of the air, if it counts.
using NormalAt = std::optional<Vec3> (*)(const Piece&, const SurfaceJet&);

std::optional<Vec3> NormalSeenFromAbove(const Piece&, const SurfaceJet& jet) {
  const std::optional<Facing> facing = FacingAt(jet);
  if (!facing || facing->both || (facing->overhangs && !facing->upright && facing->e.z() < 0.0))
    return std::nullopt;
  return facing->e;
}

// How far rounding may be off in a second derivative of the piece, mm. A form of degree n has second
// differences of n (n - 1) times its points. Points of trimmed faces are rounded to 2^-40 of the coordinates.
double SecondDerivativeRounding(const Piece& piece, double scale) {
  const double degree = std::max({piece.net.degree_u, piece.net.degree_v, 2});
  return 16.0 * degree * degree * scale * 0x1p-40;
}

// The largest normal curvature towards `normal`, 1/mm; 0 where it is not positive or not certain.
double Concavity(const SurfaceJet& jet, const Vec3& normal, double rounding) {
  const FundamentalForms forms = Forms(jet, normal);
  const double half_trace = 0.5 * (forms.E + forms.G);
  const double smallest =
      half_trace - std::hypot(0.5 * (forms.E - forms.G), forms.F);  // eigenvalue of the first form
  const double k = Principal(forms).k_max;
  constexpr double kCertainly = 100.0;
  return std::isfinite(k) && smallest > 0.0 && k * smallest > kCertainly * rounding ? k : 0.0;
}

struct Peak {
  double k = 0.0;  // 1/mm, 0: nowhere concave
  SurfacePoint at;
};

// Samples the leaf at 3 x 3 places. Then shrinks a search pattern around the best sample within the leaf.
Peak LeafPeak(const Surface& surface, const SurfaceLeaf& leaf, NormalAt normal_at) {
  const Piece& piece = surface.piece(leaf.piece);
  const double rounding = SecondDerivativeRounding(piece, surface.scale);
  Peak peak;
  const auto consider = [&](double u, double v) {
    const SurfaceJet jet = Evaluate(piece, u, v);
    const std::optional<Vec3> normal = normal_at(piece, jet);
    const double k = normal ? Concavity(jet, *normal, rounding) : 0.0;
    if (k > peak.k) peak = {k, {leaf.piece, u, v, jet.p}};
  };
  const double wu = leaf.u1 - leaf.u0, wv = leaf.v1 - leaf.v0;
  for (const double a : {0.02, 0.5, 0.98}) {
    for (const double b : {0.02, 0.5, 0.98}) consider(leaf.u0 + a * wu, leaf.v0 + b * wv);
  }
  if (!(peak.k > 0.0)) return peak;
  for (double step = 0.25; step > 0.02; step *= 0.5) {
    const SurfacePoint from = peak.at;
    for (const int du : {-1, 1})
      consider(std::clamp(from.u + du * step * wu, double{leaf.u0}, double{leaf.u1}), from.v);
    for (const int dv : {-1, 1})
      consider(from.u, std::clamp(from.v + dv * step * wv, double{leaf.v0}, double{leaf.v1}));
  }
  return peak;
}

ConcaveSpot SpotOf(const Peak& peak) {
  return peak.k > 0.0 ? ConcaveSpot{1.0 / peak.k, peak.at} : ConcaveSpot{};
}

// The peak of each leaf.
absl::StatusOr<std::vector<Peak>> LeafPeaks(const Surface& surface, NormalAt normal_at,
                                            const RunContext& run) {
  std::vector<Peak> peaks(surface.leaves.size());
  const std::size_t blocks = (peaks.size() + kBlock - 1) / kBlock;
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, blocks, [&](std::size_t b) {
    for (std::size_t i = b * kBlock; i < std::min(peaks.size(), (b + 1) * kBlock); ++i)
      peaks[i] = LeafPeak(surface, surface.leaves[i], normal_at);
  }));
  return peaks;
}

}  // namespace

absl::StatusOr<ConcaveSpot> SmallestConcaveRadius(const Surface& surface, const RunContext& run) {
  PM_ASSIGN_OR_RETURN(const std::vector<Peak> peaks, LeafPeaks(surface, NormalSeenFromAbove, run));
  Peak best;
  for (const Peak& peak : peaks) {
    if (peak.k > best.k) best = peak;
  }
  return SpotOf(best);
}

absl::StatusOr<std::vector<ConcaveSpot>> ConcaveRadiiOfFaces(const Surface& surface, const RunContext& run) {
  PM_ASSIGN_OR_RETURN(const std::vector<Peak> peaks, LeafPeaks(surface, NormalOfPatch, run));
  const PatchModel& model = surface.network.model;
  std::vector<Peak> best(model.faces.size());
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    const PatchId patch = surface.piece(surface.leaves[i].piece).patch;
    const std::optional<FaceId>& face = model.patches[patch.index()].face;
    if (face && peaks[i].k > best[face->index()].k) best[face->index()] = peaks[i];
  }
  std::vector<ConcaveSpot> spots(best.size());
  std::transform(best.begin(), best.end(), spots.begin(), SpotOf);
  return spots;
}

}  // namespace patchmill
