#include "core/surface/surface_mesh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "core/base/error_details.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"
#include "core/surface/tessellate.h"

namespace patchmill {
namespace {

constexpr int kMostHalvings = 5;             // of a cell along one axis, where the label changes
constexpr int kMostCells = 1 << 15;          // along one axis of a piece, before labels divide them
constexpr int kBorderParts = 8;              // of a cell's side on the border of the piece, where it bends
constexpr double kBorderChord = 1.0 / 16.0;  // of the chord: neighbours meet there
constexpr double kUpright = 1e-6;            // z of a normal that may point to either side
constexpr double kBesideRim = 1e-3;          // of the way to the middle of the piece
constexpr double kBesidePole = 1e-6;         // the same

// The longest of three lines of the piece along an axis, mm.
double LengthAlong(const Piece& piece, bool along_u) {
  constexpr int kSteps = 8;
  double longest = 0.0;
  for (const double other : {0.0, 0.5, 1.0}) {
    const auto at = [&](double t) { return along_u ? Position(piece, t, other) : Position(piece, other, t); };
    double length = 0.0;
    for (int k = 0; k < kSteps; ++k) length += (at((k + 1.0) / kSteps) - at(double(k) / kSteps)).norm();
    longest = std::max(longest, length);
  }
  return longest;
}

GridCells CellsOf(const Piece& piece, const MeshParams& params) {
  GridCells cells = CellsWithin(piece, params.chord, kMostCells);
  if (params.longest_edge < kInfinity) {
    const auto enough = [&](bool along_u) {
      const double count = std::ceil(LengthAlong(piece, along_u) / params.longest_edge);
      return static_cast<int>(std::min(count, static_cast<double>(kMostCells)));
    };
    cells.u = std::max(cells.u, enough(true));
    cells.v = std::max(cells.v, enough(false));
  }
  return cells;
}

// A rectangle of the finest grid: its lower corner and its sides, in steps of that grid.
struct Rect {
  int i = 0, j = 0, wide = 1, high = 1;
};

// Makes the triangles of one piece. With `divide`, the cells are divided by halves into a finest grid;
// vertices lie on that.
class PieceMesher {
 public:
  PieceMesher(const Surface& surface, PieceId id, const MeshParams& params, bool divide,
              const RunContext& run)
      : piece_(surface.piece(id)),
        params_(params),
        run_(run),
        cells_(CellsOf(piece_, params)),
        label_parts_u_(divide ? Parts(cells_.u) : 1),
        label_parts_v_(divide ? Parts(cells_.v) : 1),
        wide_(divide ? std::max(kBorderParts, label_parts_u_) : 1),
        high_(divide ? std::max(kBorderParts, label_parts_v_) : 1),
        steps_u_(cells_.u * wide_),
        steps_v_(cells_.v * high_) {
    mesh_.piece = id;
  }

  PieceTriangles Make() {
    for (int i = 0; i < cells_.u && !run_.Cancelled(); ++i) {
      for (int j = 0; j < cells_.v; ++j) Divide({i * wide_, j * high_, wide_, high_});
    }
    for (std::size_t k = 0; k < rects_.size() && !Stopped(k); ++k) AddCorners(rects_[k]);
    for (int i = 0; i < cells_.u; ++i) {
      for (const int j : {0, steps_v_}) RefineBorder({i * wide_, j}, {(i + 1) * wide_, j});
    }
    for (int j = 0; j < cells_.v; ++j) {
      for (const int i : {0, steps_u_}) RefineBorder({i, j * high_}, {i, (j + 1) * high_});
    }
    for (std::size_t k = 0; k < rects_.size() && !Stopped(k); ++k) AddTriangles(rects_[k]);
    return std::move(mesh_);
  }

 private:
  bool Stopped(std::size_t k) const { return k % 1024 == 0 && run_.Cancelled(); }

  // Parts of a cell along an axis of so many cells, so that they are as fine as the labels.
  int Parts(int cells) const {
    int parts = 1;
    while (params_.label && parts < (1 << kMostHalvings) && cells * parts < params_.label_cells) parts *= 2;
    return parts;
  }
  double U(double i) const { return i / steps_u_; }
  double V(double j) const { return j / steps_v_; }

  // Whether all cells of the label grid whose centres lie in the rectangle have the label of its middle.
  bool HasOneLabel(const Rect& s) const {
    const int n = params_.label_cells;
    const auto first = [&](double share) { return static_cast<int>(std::ceil(share * n - 0.5)); };
    const auto end = [&](double share) { return static_cast<int>(std::floor(share * n - 0.5)) + 1; };
    const int middle = LabelAt(s.i + 0.5 * s.wide, s.j + 0.5 * s.high);
    for (int k = std::max(0, first(U(s.i))); k < std::min(n, end(U(s.i + s.wide))); ++k) {
      for (int l = std::max(0, first(V(s.j))); l < std::min(n, end(V(s.j + s.high))); ++l) {
        if (params_.label(mesh_.piece, (k + 0.5) / n, (l + 0.5) / n) != middle) return false;
      }
    }
    return true;
  }
  int LabelAt(double i, double j) const {
    return params_.label ? params_.label(mesh_.piece, U(i), V(j)) : -1;
  }

  void Divide(const Rect& s) {
    const int least_wide = wide_ / label_parts_u_, least_high = high_ / label_parts_v_;
    if ((s.wide == least_wide && s.high == least_high) || !params_.label || HasOneLabel(s)) {
      rects_.push_back(s);
      return;
    }
    const int wide = std::max(least_wide, s.wide / 2), high = std::max(least_high, s.high / 2);
    for (int i = s.i; i < s.i + s.wide; i += wide) {
      for (int j = s.j; j < s.j + s.high; j += high) Divide({i, j, wide, high});
    }
  }

  // A place of the finest grid.
  struct Step {
    int i = 0, j = 0;
  };

  // Adds corners on a stretch of the border until it is as close to their polyline as neighbours should be.
  void RefineBorder(const Step& a, const Step& b) {
    if (std::max(b.i - a.i, b.j - a.j) < 2) return;
    const Step middle{(a.i + b.i) / 2, (a.j + b.j) / 2};
    const Vec3 from = Position(piece_, U(a.i), V(a.j)), to = Position(piece_, U(b.i), V(b.j));
    const Vec3 way = to - from, at = Position(piece_, U(middle.i), V(middle.j)) - from;
    const double length2 = way.squaredNorm();
    const double t = length2 > 0.0 ? std::clamp(at.dot(way) / length2, 0.0, 1.0) : 0.0;
    if ((at - t * way).norm() <= kBorderChord * params_.chord) return;
    AddCorner(middle.i, middle.j);
    RefineBorder(a, middle);
    RefineBorder(middle, b);
  }

  std::int64_t Key(int i, int j) const { return static_cast<std::int64_t>(i) * (steps_v_ + 1) + j; }

  // The place a share of the way to the middle of the piece.
  SurfaceJet Beside(double u, double v, double share) const {
    return Evaluate(piece_, u + share * (0.5 - u), v + share * (0.5 - v));
  }

  // The upward normal; at a pole, where the parameters give none, that of the surface beside it; on a rim
  // where it may point to either side, to that of the surface beside it.
  std::optional<Vec3> NormalAt(double u, double v, const SurfaceJet& jet) const {
    const auto normal = UpwardNormal(jet);
    if (!normal) return UpwardNormal(Beside(u, v, kBesidePole));
    if (std::abs(normal->z()) > kUpright) return normal;
    const auto towards = UpwardNormal(Beside(u, v, kBesideRim));
    return towards && towards->dot(*normal) < 0.0 ? std::optional<Vec3>(-*normal) : normal;
  }

  std::uint32_t Add(double u, double v) {
    const SurfaceJet jet = Evaluate(piece_, u, v);
    MeshVertex vertex;
    vertex.at = {mesh_.piece, u, v, jet.p};
    if (const auto normal = NormalAt(u, v, jet)) {
      vertex.normal = *normal;
      vertex.slope = std::acos(std::clamp(normal->z(), -1.0, 1.0));
      const double curvature = ContourCurvature(jet, Forms(jet, *normal));
      if (std::isfinite(curvature)) vertex.contour_curvature = curvature;
    }
    mesh_.vertices.push_back(vertex);
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }

  void AddCorner(int i, int j) {
    const auto [place, added] = corners_.try_emplace(Key(i, j), 0u);
    if (added) place->second = Add(U(i), V(j));
  }
  void AddCorners(const Rect& s) {
    for (const int i : {s.i, s.i + s.wide}) {
      for (const int j : {s.j, s.j + s.high}) AddCorner(i, j);
    }
  }

  // The corners on the border of the rectangle, those of its neighbours included, counter-clockwise.
  std::vector<std::uint32_t> BorderOf(const Rect& s) const {
    std::vector<std::uint32_t> border;
    const std::array<std::array<int, 3>, 4> sides = {
        {{1, 0, s.wide}, {0, 1, s.high}, {-1, 0, s.wide}, {0, -1, s.high}}};
    int i = s.i, j = s.j;
    for (const auto& [di, dj, steps] : sides) {
      for (int k = 0; k < steps; ++k, i += di, j += dj) {
        if (const auto at = corners_.find(Key(i, j)); at != corners_.end()) border.push_back(at->second);
      }
    }
    return border;
  }

  void AddTriangles(const Rect& s) {
    const std::vector<std::uint32_t> border = BorderOf(s);
    if (border.size() == 4) {
      AddTriangle(border[0], border[1], border[2]);
      AddTriangle(border[0], border[2], border[3]);
      return;
    }
    const std::uint32_t middle = Add(U(s.i + 0.5 * s.wide), V(s.j + 0.5 * s.high));
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
  const RunContext& run_;
  const GridCells cells_;
  const int label_parts_u_, label_parts_v_;  // of a cell's sides, as far as labels divide it
  const int wide_, high_;                    // sides of a cell, in steps of the finest grid
  const int steps_u_, steps_v_;
  std::vector<Rect> rects_;
  std::unordered_map<std::int64_t, std::uint32_t> corners_;  // by Key: looked up only, never walked
  PieceTriangles mesh_;
};

// The triangles of all pieces; absent if there are more than `most_triangles`.
absl::StatusOr<std::optional<std::vector<PieceTriangles>>> MakeAll(const Surface& surface,
                                                                   const MeshParams& params, bool divide,
                                                                   const RunContext& run) {
  std::vector<PieceTriangles> pieces(surface.pieces.size());
  std::atomic<std::size_t> triangles{0};
  const auto too_many = [&] { return triangles.load() > params.most_triangles; };
  PM_RETURN_IF_ERROR(ParallelFor(run, "triangles", pieces.size(), [&](std::size_t k) {
    if (too_many()) return;
    pieces[k] = PieceMesher(surface, PieceId(k), params, divide, run).Make();
    triangles += pieces[k].triangles.size();
  }));
  if (too_many()) return std::nullopt;
  return pieces;
}

}  // namespace

absl::Status CheckTriangles(const Surface& surface, const MeshParams& params, const RunContext& run) {
  std::vector<double> counts(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, counts.size(), [&](std::size_t k) {
    const GridCells cells = CellsOf(surface.pieces[k], params);
    counts[k] = 2.0 * cells.u * cells.v;
  }));
  double count = 0.0;
  for (const double c : counts) count += c;
  const auto limit = static_cast<double>(params.most_triangles);
  if (count <= limit) return absl::OkStatus();
  return LimitPassedError({"triangles", limit, count}, "use a larger chord");
}

absl::StatusOr<std::vector<PieceTriangles>> MakeSurfaceMesh(const Surface& surface, const MeshParams& params,
                                                            const RunContext& run) {
  PM_RETURN_IF_ERROR(CheckTriangles(surface, params, run));
  PM_ASSIGN_OR_RETURN(auto fine, MakeAll(surface, params, true, run));
  if (fine) return *std::move(fine);
  // Undivided cells are as many as CheckTriangles has counted.
  PM_ASSIGN_OR_RETURN(auto coarse, MakeAll(surface, params, false, run));
  return *std::move(coarse);
}

}  // namespace patchmill
