#include "core/surface/surface_mesh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <unordered_map>

#include "core/base/error_details.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"
#include "core/surface/tessellate.h"

namespace patchmill {
namespace {

constexpr int kMostHalvings = 5;  // of a cell in which the label changes

// A square of the finest grid: its lower corner and its width, in steps of that grid.
struct Square {
  int i = 0, j = 0, width = 1;
};

// Makes the triangles of one piece. The grid of cells is divided by halves into a finest grid; vertices lie
// on that.
class PieceMesher {
 public:
  PieceMesher(const Surface& surface, PieceId id, const MeshParams& params)
      : piece_(surface.piece(id)), params_(params) {
    mesh_.piece = id;
    const GridCells cells = CellsWithin(piece_, params.chord, params.max_cells);
    cells_ = cells;
    if (params.label) {
      while (halvings_ < kMostHalvings && (std::max(cells.u, cells.v) << halvings_) < params.label_cells)
        ++halvings_;
    }
    width_ = 1 << halvings_;
    steps_u_ = cells.u * width_;
    steps_v_ = cells.v * width_;
  }

  PieceTriangles Make() {
    for (int i = 0; i < cells_.u; ++i) {
      for (int j = 0; j < cells_.v; ++j) Divide({i * width_, j * width_, width_});
    }
    for (const Square& square : squares_) AddCorners(square);
    for (const Square& square : squares_) AddTriangles(square);
    return std::move(mesh_);
  }

 private:
  double U(double i) const { return i / steps_u_; }
  double V(double j) const { return j / steps_v_; }

  // Whether all cells of the label grid whose centres lie in the square have the label of its middle.
  bool HasOneLabel(const Square& s) const {
    const int n = params_.label_cells;
    const auto first = [&](double share) { return static_cast<int>(std::ceil(share * n - 0.5)); };
    const auto end = [&](double share) { return static_cast<int>(std::floor(share * n - 0.5)) + 1; };
    const int middle = LabelAt(s.i + 0.5 * s.width, s.j + 0.5 * s.width);
    for (int k = std::max(0, first(U(s.i))); k < std::min(n, end(U(s.i + s.width))); ++k) {
      for (int l = std::max(0, first(V(s.j))); l < std::min(n, end(V(s.j + s.width))); ++l) {
        if (params_.label(mesh_.piece, (k + 0.5) / n, (l + 0.5) / n) != middle) return false;
      }
    }
    return true;
  }
  int LabelAt(double i, double j) const {
    return params_.label ? params_.label(mesh_.piece, U(i), V(j)) : -1;
  }

  void Divide(const Square& s) {
    if (s.width == 1 || !params_.label || HasOneLabel(s)) {
      squares_.push_back(s);
      return;
    }
    const int half = s.width / 2;
    for (const int i : {s.i, s.i + half}) {
      for (const int j : {s.j, s.j + half}) Divide({i, j, half});
    }
  }

  std::int64_t Key(int i, int j) const { return static_cast<std::int64_t>(i) * (steps_v_ + 1) + j; }

  std::uint32_t Add(double u, double v) {
    const SurfaceJet jet = Evaluate(piece_, u, v);
    MeshVertex vertex;
    vertex.at = {mesh_.piece, u, v, jet.p};
    if (const auto normal = UpwardNormal(jet)) {
      vertex.normal = *normal;
      vertex.slope = std::acos(std::clamp(normal->z(), -1.0, 1.0));
      const double curvature = ContourCurvature(jet, Forms(jet, *normal));
      if (std::isfinite(curvature)) vertex.contour_curvature = curvature;
    }
    mesh_.vertices.push_back(vertex);
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }

  void AddCorners(const Square& s) {
    for (const int i : {s.i, s.i + s.width}) {
      for (const int j : {s.j, s.j + s.width}) {
        const auto [place, added] = corners_.try_emplace(Key(i, j), 0u);
        if (added) place->second = Add(U(i), V(j));
      }
    }
  }

  // The corners on the border of the square, those of its neighbours included, counter-clockwise.
  std::vector<std::uint32_t> BorderOf(const Square& s) const {
    std::vector<std::uint32_t> border;
    constexpr int kSteps[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    int i = s.i, j = s.j;
    for (const auto& step : kSteps) {
      for (int k = 0; k < s.width; ++k, i += step[0], j += step[1]) {
        if (const auto at = corners_.find(Key(i, j)); at != corners_.end()) border.push_back(at->second);
      }
    }
    return border;
  }

  void AddTriangles(const Square& s) {
    const std::vector<std::uint32_t> border = BorderOf(s);
    if (border.size() == 4) {
      AddTriangle(border[0], border[1], border[2]);
      AddTriangle(border[0], border[2], border[3]);
      return;
    }
    const std::uint32_t middle = Add(U(s.i + 0.5 * s.width), V(s.j + 0.5 * s.width));
    for (std::size_t k = 0; k < border.size(); ++k)
      AddTriangle(border[k], border[(k + 1) % border.size()], middle);
  }

  // Triangles whose corners coincide, at a pole, are left out.
  void AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const SurfacePoint &p = mesh_.vertices[a].at, &q = mesh_.vertices[b].at, &r = mesh_.vertices[c].at;
    if (p.p == q.p || q.p == r.p || r.p == p.p) return;
    const double u = (p.u + q.u + r.u) / 3.0, v = (p.v + q.v + r.v) / 3.0;
    mesh_.triangles.push_back({{a, b, c}, params_.label ? params_.label(mesh_.piece, u, v) : -1});
  }

  const Piece& piece_;
  const MeshParams& params_;
  GridCells cells_;
  int halvings_ = 0, width_ = 1;  // of a cell, and its width in steps of the finest grid
  int steps_u_ = 1, steps_v_ = 1;
  std::vector<Square> squares_;
  std::unordered_map<std::int64_t, std::uint32_t> corners_;  // by Key: looked up only, never walked
  PieceTriangles mesh_;
};

}  // namespace

absl::StatusOr<std::vector<PieceTriangles>> MakeSurfaceMesh(const Surface& surface, const MeshParams& params,
                                                            const RunContext& run) {
  std::vector<PieceTriangles> pieces(surface.pieces.size());
  std::atomic<std::size_t> triangles{0};
  const auto too_many = [&] { return triangles.load() > params.most_triangles; };
  PM_RETURN_IF_ERROR(ParallelFor(run, "triangles", pieces.size(), [&](std::size_t k) {
    if (too_many()) return;
    pieces[k] = PieceMesher(surface, PieceId(k), params).Make();
    triangles += pieces[k].triangles.size();
  }));
  // How many were made until then depends on the threads, so the message leaves it out.
  if (too_many()) {
    const auto limit = static_cast<double>(params.most_triangles);
    return LimitPassedError({"triangles", limit, limit + 1.0}, "use a larger chord");
  }
  return pieces;
}

}  // namespace patchmill
