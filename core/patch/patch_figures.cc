#include "core/patch/patch_figures.h"

#include <cmath>

#include "core/math/gauss_rule.h"

namespace patchmill {
namespace {

constexpr double kSettled = 1e-9;
constexpr int kMostSquares = 16;  // along each parameter

PatchFigures OnSquares(const JetFunction& jet_at, const Vec3& origin, int squares) {
  PatchFigures sum;
  const double step = 1.0 / squares;
  for (int i = 0; i < squares; ++i) {
    for (int j = 0; j < squares; ++j) {
      for (const GaussPoint& u : kGauss8) {
        for (const GaussPoint& v : kGauss8) {
          const SurfaceJet jet = jet_at((i + u.at) * step, (j + v.at) * step);
          const Vec3 normal = jet.du.cross(jet.dv) * (u.weight * v.weight * step * step);
          sum.area += normal.norm();
          sum.volume += (jet.p - origin).dot(normal) / 3.0;
        }
      }
    }
  }
  return sum;
}

}  // namespace

PatchFigures FiguresOf(const JetFunction& jet, const Vec3& origin) {
  PatchFigures figures = OnSquares(jet, origin, 1);
  for (int squares = 2; squares <= kMostSquares; squares *= 2) {
    const PatchFigures finer = OnSquares(jet, origin, squares);
    const bool settled = std::abs(finer.area - figures.area) <= kSettled * finer.area;
    figures = finer;
    if (settled) break;
  }
  return figures;
}

}  // namespace patchmill
