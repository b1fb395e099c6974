#include "core/preview/curvature_comb.h"

namespace patchmill {

Vec3 CurvatureVector(const Vec3& first, const Vec3& second) {
  const double square = first.squaredNorm();
  if (!(square > 0.0)) return Vec3::Zero();
  return (second - first * (first.dot(second) / square)) / square;
}

std::vector<CombTooth> CombOf(const BezierChain& curve, int cells) {
  std::vector<CombTooth> comb;
  for (int k = 0; k <= cells; ++k) {
    const CurveJet jet = Evaluate(curve, static_cast<double>(k) / cells);
    comb.push_back({jet.p, CurvatureVector(jet.d, jet.dd)});
  }
  return comb;
}

std::vector<CombTooth> CombAlong(const PatchShape& quad, bool along_u, double at, int cells) {
  std::vector<CombTooth> comb;
  for (int k = 0; k <= cells; ++k) {
    const double t = static_cast<double>(k) / cells;
    const SurfaceJet jet = along_u ? Evaluate(quad, t, at) : Evaluate(quad, at, t);
    comb.push_back({jet.p, along_u ? CurvatureVector(jet.du, jet.duu) : CurvatureVector(jet.dv, jet.dvv)});
  }
  return comb;
}

}  // namespace patchmill
