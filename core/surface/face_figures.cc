#include "core/surface/face_figures.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/patch/patch_figures.h"

namespace patchmill {
namespace {

constexpr double kSurely = 1e-7;  // share of the derivatives' squares that a normal has, at least
constexpr int kSteps = 16;        // places of a piece along each parameter, less one

void AddPiece(const Surface& surface, PieceId id, FaceFigures& figures) {
  const Piece& piece = surface.piece(id);
  const auto jet_at = [&piece](double u, double v) { return Evaluate(piece, u, v); };
  figures.area += FiguresOf(jet_at, surface.box.Center()).area;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const SurfaceJet jet = jet_at(static_cast<double>(i) / kSteps, static_cast<double>(j) / kSteps);
      figures.box.Add(jet.p);
      const Vec3 normal = jet.du.cross(jet.dv);
      const double length = normal.norm();
      // At a pole, and along a needle no wider than rounding, nothing is left of the normal.
      if (!(length > kSurely * std::max(jet.du.squaredNorm(), jet.dv.squaredNorm()))) continue;
      const double tilt = std::acos(std::clamp(normal.z() / length, -1.0, 1.0));
      figures.tilt_min = std::min(figures.tilt_min, tilt);
      figures.tilt_max = std::max(figures.tilt_max, tilt);
    }
  }
}

}  // namespace

std::vector<std::vector<PieceId>> PiecesOfFaces(const Surface& surface) {
  const PatchModel& model = surface.network.model;
  std::vector<std::vector<PieceId>> pieces(model.faces.size());
  for (std::size_t k = 0; k < surface.pieces.size(); ++k) {
    const auto& face = model.patches[surface.pieces[k].patch.index()].face;
    if (face) pieces[face->index()].push_back(PieceId(k));
  }
  return pieces;
}

absl::StatusOr<std::vector<FaceFigures>> MeasureFaces(const Surface& surface, const RunContext& run) {
  const PatchModel& model = surface.network.model;
  const std::vector<std::vector<PieceId>> pieces = PiecesOfFaces(surface);
  std::vector<FaceFigures> figures(model.faces.size());
  for (std::size_t k = 0; k < model.patches.size(); ++k) {
    if (const auto& face = model.patches[k].face) ++figures[face->index()].patch_count;
  }
  PM_RETURN_IF_ERROR(ParallelFor(run, "faces", figures.size(), [&](std::size_t f) {
    if (pieces[f].empty()) return;
    figures[f].tilt_min = kPi;
    for (const PieceId id : pieces[f]) AddPiece(surface, id, figures[f]);
    figures[f].tilt_min = std::min(figures[f].tilt_min, figures[f].tilt_max);
  }));
  return figures;
}

}  // namespace patchmill
