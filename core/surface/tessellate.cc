#include "core/surface/tessellate.h"

#include <algorithm>
#include <cmath>

#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

// Largest second derivatives over a grid of parameters.
struct SecondDerivatives {
  double uu = 0.0, uv = 0.0, vv = 0.0;
};

SecondDerivatives SampleSecondDerivatives(const Piece& piece) {
  // A polynomial of degree n bends at most n - 2 times, so n + 2 samples see every bend.
  const int nu = piece.net.degree_u + 1, nv = piece.net.degree_v + 1;
  SecondDerivatives max;
  for (int i = 0; i <= nu; ++i) {
    for (int j = 0; j <= nv; ++j) {
      const SurfaceJet jet = Evaluate(piece, static_cast<double>(i) / nu, static_cast<double>(j) / nv);
      max.uu = std::max(max.uu, jet.duu.norm());
      max.uv = std::max(max.uv, jet.duv.norm());
      max.vv = std::max(max.vv, jet.dvv.norm());
    }
  }
  return max;
}

}  // namespace

// A triangle over a cell with sides a, b in parameters deviates by at most (a^2 |S_uu| + 2 a b |S_uv| + b^2
// |S_vv|) / 8. Each of the three terms gets a third of `chord`.
GridCells CellsWithin(const Piece& piece, double chord, int max_cells) {
  const SecondDerivatives d = SampleSecondDerivatives(piece);
  double u = std::max(1.0, std::sqrt(3.0 * d.uu / (8.0 * chord)));
  double v = std::max(1.0, std::sqrt(3.0 * d.vv / (8.0 * chord)));
  const double twist = 6.0 * d.uv / (8.0 * chord);  // at most u * v
  if (twist > u * v) {
    const double more = std::sqrt(twist / (u * v));
    u *= more;
    v *= more;
  }
  const auto whole = [&](double x) {
    return static_cast<int>(std::ceil(std::min(x, static_cast<double>(max_cells))));
  };
  return {whole(u), whole(v)};
}

Tessellation::PieceMesh TessellatePiece(const Surface& surface, PieceId id, double chord, int max_cells) {
  const Piece& piece = surface.piece(id);
  const GridCells cells = CellsWithin(piece, std::max(chord, 1e-12 * surface.scale), std::max(1, max_cells));
  Tessellation::PieceMesh mesh{id, cells.u, cells.v, {}};
  mesh.vertices.reserve(static_cast<std::size_t>((cells.u + 1) * (cells.v + 1)));
  for (int k = 0; k <= cells.u; ++k) {
    for (int l = 0; l <= cells.v; ++l) {
      const double u = static_cast<double>(k) / cells.u, v = static_cast<double>(l) / cells.v;
      const SurfaceJet jet = Evaluate(piece, u, v);
      mesh.vertices.push_back(
          {jet.p, UpwardNormal(jet).value_or(Vec3::Zero()), static_cast<float>(u), static_cast<float>(v)});
    }
  }
  return mesh;
}

Tessellation Tessellate(const Surface& surface, double chord, int max_cells) {
  Tessellation out;
  out.meshes.reserve(surface.pieces.size());
  for (std::size_t i = 0; i < surface.pieces.size(); ++i)
    out.meshes.push_back(TessellatePiece(surface, PieceId(i), chord, max_cells));
  return out;
}

}  // namespace patchmill
