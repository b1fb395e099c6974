#include "cam/region/watershed_lines.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/Eigenvalues>

#include "cam/region/mesh_cutter.h"
#include "core/base/status.h"
#include "core/lines/flow_step.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kStart = 0.01;           // of the spacing: how far from the saddle a line begins
constexpr double kNearSaddle = 2.0;       // of the longest side at a pass: where its saddle may lie
constexpr double kLevel = 1e-7;           // of the gradient: none
constexpr int kMostVertices = 5'000;      // of a line
constexpr int kMostStuck = 100;           // of a line: sides of triangles where the flow had no direction
constexpr int kMostBorders = 10;          // with less than a whole step in between: a line that makes no way
constexpr std::size_t kMostPlaces = 500;  // among the triangles around one vertex: the same

class Cutter {
 public:
  Cutter(const Surface& surface, const WatershedParams& params, const RunContext& run,
         std::vector<SplitMesh>& meshes)
      : surface_(surface),
        params_(params),
        run_(run),
        meshes_(meshes),
        join_(std::max(2.0 * surface.network.join_tolerance, 1e-7)) {
    flow_.spacing = params.spacing;
    flow_.tolerance = params.tolerance;
  }

  absl::StatusOr<bool> Run(const std::vector<MeshVertex>& passes) {
    for (const MeshVertex& pass : passes) {
      PM_RETURN_IF_ERROR(run_.Check());
      const MeshVertex from = SaddleNear(pass);
      for (const Vec3& direction : Directions(from)) Trace(from, direction);
    }
    PM_RETURN_IF_ERROR(run_.Check());
    for (auto& [piece, cutter] : cutters_) cutter.Finish(params_.steep_angle);
    return !cutters_.empty();
  }

 private:
  const Vec3& PointOf(const MeshVertex& v) const {
    return meshes_[static_cast<std::size_t>(v.piece)].vertices[static_cast<std::size_t>(v.vertex)].p;
  }
  double Height(const MeshVertex& v) const { return params_.sign * PointOf(v).z(); }
  SurfaceJet JetAt(const MeshVertex& v) const {
    const ZeroVertex& vertex =
        meshes_[static_cast<std::size_t>(v.piece)].vertices[static_cast<std::size_t>(v.vertex)];
    return Evaluate(surface_.pieces[static_cast<std::size_t>(v.piece)], vertex.u, vertex.v);
  }
  MeshCutter& CutterOf(int piece) {
    const auto k = static_cast<std::size_t>(piece);
    return cutters_
        .try_emplace(piece, surface_.pieces[k], meshes_[k], params_.sign > 0.0, params_.fields,
                     params_.tolerance)
        .first->second;
  }

  // Second derivatives of the height where it has no gradient, in an orthonormal frame of the tangent plane.
  struct Bend {
    Vec3 along = Vec3::Zero();  // where it falls most (rises, for pits)
    bool saddle = false;
  };
  std::optional<Bend> BendAt(const SurfaceJet& jet) const {
    const double e = jet.du.squaredNorm(), f = jet.du.dot(jet.dv), g = jet.dv.squaredNorm();
    const double w = std::sqrt(e * g - f * f);
    if (!(w > 0.0) || !(FlowGradient(jet, flow_).norm() < kLevel)) return std::nullopt;
    // x = du / |du|, y at right angles to it.
    Eigen::Matrix2d to;  // columns: x and y in (u, v)
    to << 1.0 / std::sqrt(e), -f / (std::sqrt(e) * w), 0.0, std::sqrt(e) / w;
    Eigen::Matrix2d second;
    second << jet.duu.z(), jet.duv.z(), jet.duv.z(), jet.dvv.z();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(params_.sign * to.transpose() * second * to);
    const Vec2 uv = to * solver.eigenvectors().col(0);
    Bend bend;
    bend.along = (uv.x() * jet.du + uv.y() * jet.dv).normalized();
    bend.saddle = solver.eigenvalues()[0] < 0.0 && solver.eigenvalues()[1] > 0.0;
    return bend;
  }

  // Nodes of the split are saddles of the surface; the pass of the mesh lies within a cell of its own.
  MeshVertex SaddleNear(const MeshVertex& pass) {
    const Vec3 p = PointOf(pass);
    double reach = 0.0;
    for (const int n : CutterOf(pass.piece).Around(pass.vertex))
      reach = std::max(reach, kNearSaddle * (PointOf({pass.piece, n}) - p).norm());
    MeshVertex best = pass;
    double nearest = reach;
    for (std::size_t piece = 0; piece < meshes_.size(); ++piece) {
      if (BoxGap(piece, p) >= nearest) continue;
      const SplitMesh& mesh = meshes_[piece];
      for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
        const double d = (mesh.vertices[k].p - p).norm();
        const MeshVertex v{static_cast<int>(piece), static_cast<int>(k)};
        if (d >= nearest) continue;
        const auto bend = BendAt(JetAt(v));
        if (!bend || !bend->saddle) continue;
        nearest = d;
        best = v;
      }
    }
    return best;
  }

  double BoxGap(std::size_t piece, const Vec3& p) {
    if (boxes_.empty()) {
      boxes_.resize(meshes_.size());
      for (std::size_t k = 0; k < meshes_.size(); ++k) {
        for (const ZeroVertex& v : meshes_[k].vertices) boxes_[k].Add(v.p);
      }
    }
    return (p - p.cwiseMax(boxes_[piece].min).cwiseMin(boxes_[piece].max)).norm();
  }

  // Where lines leave a pass: both ways along the axis of a saddle, else down its steepest sides.
  std::vector<Vec3> Directions(const MeshVertex& from) {
    const auto bend = BendAt(JetAt(from));
    if (bend && bend->saddle) return {bend->along, -bend->along};
    std::vector<Vec3> found;
    const Vec3 p = PointOf(from);
    for (int round = 0; round < 2; ++round) {
      double steepest = 0.0;
      std::optional<Vec3> best;
      for (const int n : CutterOf(from.piece).Around(from.vertex)) {
        const Vec3 d = PointOf({from.piece, n}) - p;
        if (round == 1 && Plan(d).dot(Plan(found.front())) > 0.0) continue;
        const double slope = -params_.sign * d.z() / d.norm();
        if (!(slope > steepest)) continue;
        steepest = slope;
        best = d.normalized();
      }
      if (!best) break;
      found.push_back(*best);
    }
    return found;
  }

  // The place and the vertex where a line through p goes on at `at`, maybe in another piece.
  std::optional<MeshVertex> EnterAt(PieceId piece, const MeshVertex& from) {
    if (piece.value == from.piece) return from;
    const auto vertex = CutterOf(piece.value).OnBorder(PointOf(from), join_ + params_.tolerance);
    if (!vertex) return std::nullopt;
    return MeshVertex{piece.value, *vertex};
  }

  // How a stretch of flow ended.
  enum class End { kDone, kStuck };

  void Trace(const MeshVertex& from, const Vec3& direction) {
    const double start = kStart * params_.spacing;
    const auto first = ClosestToPoint(surface_, PointOf(from) + start * direction, 0.5 * start, 1e-3 * start);
    if (!first) return;
    const auto at = EnterAt(first->at.piece, from);
    if (!at) return;
    MeshVertex here = *at;
    auto place = PlaceOn(surface_, flow_, first->at.piece, first->at.u, first->at.v, -params_.sign);
    int vertices = 0;
    for (int stuck = 0; stuck < kMostStuck && vertices < kMostVertices && !run_.Cancelled(); ++stuck) {
      if (place && Follow(here, *place, vertices) == End::kDone) return;
      // No way on: down the steepest side, and on from there.
      const auto next = SteepestSide(here);
      if (!next) return;
      MeshCutter& cutter = CutterOf(here.piece);
      const bool met = cutter.OnLine(*next);
      cutter.Mark(here.vertex, *next, {});
      here.vertex = *next;
      ++vertices;
      if (met) return;
      const ZeroVertex& v =
          meshes_[static_cast<std::size_t>(here.piece)].vertices[static_cast<std::size_t>(here.vertex)];
      place =
          PlaceOn(surface_, flow_, PieceId(static_cast<std::size_t>(here.piece)), v.u, v.v, -params_.sign);
    }
  }

  std::optional<int> SteepestSide(const MeshVertex& at) {
    std::optional<int> best;
    double steepest = 0.0;
    for (const int n : CutterOf(at.piece).Around(at.vertex)) {
      const MeshVertex next{at.piece, n};
      const double run = (PointOf(next) - PointOf(at)).norm();
      const double slope = run > 0.0 ? (Height(at) - Height(next)) / run : 0.0;
      if (slope > steepest) {
        steepest = slope;
        best = n;
      }
    }
    return best;
  }

  // Follows the flow from a place among the triangles around the vertex `here`, which goes along.
  End Follow(MeshVertex& here, FlowPlace place, int& vertices) {
    std::vector<Vec2> places{{place.at.u, place.at.v}};
    std::size_t known = 0;
    double length = kStart * params_.spacing;
    // Nothing while the line goes on among the same triangles.
    const auto walk = [&] {
      while (const auto next = CutterOf(here.piece).Advance(here.vertex, places, known)) {
        here.vertex = next->vertex;
        if (++vertices > kMostVertices || next->met) return true;
      }
      return false;
    };
    int borders = 0;  // met one after the other
    while (!run_.Cancelled()) {
      if (walk()) return End::kDone;
      if (places.size() > kMostPlaces || borders > kMostBorders) return End::kStuck;
      const auto flow = Advance(surface_, flow_, place, -params_.sign, &length);
      if (!flow) return End::kStuck;
      place = flow->place;
      places.emplace_back(place.at.u, place.at.v);
      borders = flow->at_border ? borders + 1 : 0;
      if (!flow->at_border) continue;
      if (walk()) return End::kDone;
      MeshCutter& cutter = CutterOf(here.piece);
      const auto rim = cutter.OnBorder(place.at.p, params_.tolerance);
      if (!rim) return End::kStuck;
      if (*rim != here.vertex) {
        const std::vector<int> around = cutter.Around(here.vertex);
        if (std::find(around.begin(), around.end(), *rim) == around.end()) return End::kStuck;
        const bool met = cutter.OnLine(*rim);
        places.pop_back();
        cutter.Mark(here.vertex, *rim, std::move(places));
        here.vertex = *rim;
        if (met) return End::kDone;
      }
      const auto other = CrossBorder(surface_, flow_, place, -params_.sign);
      if (!other) {
        const double beyond = 10.0 * join_;
        const auto on =
            ClosestToPoint(surface_, place.at.p + beyond * place.tangent, 0.5 * beyond, 0.1 * beyond);
        return on ? End::kStuck : End::kDone;
      }
      const auto entered = EnterAt(other->at.piece, here);
      if (!entered) return End::kStuck;
      const bool moved = entered->piece != here.piece;
      here = *entered;
      if (moved && CutterOf(here.piece).OnLine(here.vertex)) return End::kDone;
      place = *other;
      places = {{place.at.u, place.at.v}};
      known = 0;
    }
    return End::kDone;
  }

  const Surface& surface_;
  const WatershedParams& params_;
  const RunContext& run_;
  std::vector<SplitMesh>& meshes_;
  const double join_;
  FlowParams flow_;
  std::vector<Box3> boxes_;
  std::map<int, MeshCutter> cutters_;  // of the pieces that were asked for
};

}  // namespace

absl::StatusOr<bool> CutWatersheds(const Surface& surface, const std::vector<MeshVertex>& passes,
                                   const WatershedParams& params, const RunContext& run,
                                   std::vector<SplitMesh>& meshes) {
  return Cutter(surface, params, run, meshes).Run(passes);
}

}  // namespace patchmill
