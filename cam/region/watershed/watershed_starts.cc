#include "cam/region/watershed/watershed_starts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kStart = 0.01;      // of the spacing: distance from the saddle at which a line begins
constexpr double kNearSaddle = 2.0;  // times the longest side at a pass: how far away its saddle may lie
constexpr double kLevel = 1e-7;      // length of FlowGradient below which the surface counts as level
constexpr std::size_t kAhead = 64;   // steps of a flow that are computed in advance

// Finds where the lines from passes begin, on meshes before they are cut.
class StartFinder {
 public:
  StartFinder(const SplitSurface& split, const std::vector<Box3>& boxes, const FlowParams& flow, double sign)
      : surface_(*split.surface), flow_(flow), sign_(sign), meshes_(split.meshes), boxes_(boxes) {}

  std::vector<WatershedStart> At(const MeshVertex& pass) const {
    std::vector<WatershedStart> starts;
    const MeshVertex from = SaddleNear(pass);
    for (const Vec3& direction : Directions(from)) {
      const double start = kStart * flow_.spacing;
      const auto first =
          ClosestToPoint(surface_, PointOf(from) + start * direction, 0.5 * start, 1e-3 * start);
      if (!first) continue;
      starts.push_back(
          {from, first->at.piece,
           FlowTrack(surface_, flow_, -sign_,
                     PlaceOn({surface_, flow_, -sign_}, first->at.piece, first->at.u, first->at.v), start)});
    }
    return starts;
  }

 private:
  const Vec3& PointOf(const MeshVertex& v) const {
    return meshes_[static_cast<std::size_t>(v.piece)].vertices[static_cast<std::size_t>(v.vertex)].p;
  }
  SurfaceJet JetAt(const MeshVertex& v) const {
    const ZeroVertex& vertex =
        meshes_[static_cast<std::size_t>(v.piece)].vertices[static_cast<std::size_t>(v.vertex)];
    return Evaluate(surface_.pieces[static_cast<std::size_t>(v.piece)], vertex.u, vertex.v);
  }
  // The vertices that are joined to v by a side.
  std::vector<int> Around(const MeshVertex& v) const {
    std::vector<int> found;
    for (const SplitTriangle& t : meshes_[static_cast<std::size_t>(v.piece)].triangles) {
      if (std::find(t.vertex.begin(), t.vertex.end(), v.vertex) == t.vertex.end()) continue;
      for (const int n : t.vertex) {
        if (n != v.vertex && std::find(found.begin(), found.end(), n) == found.end()) found.push_back(n);
      }
    }
    return found;
  }

  // From the second derivatives of the height in the tangent plane, at a place where it has no gradient.
  struct Bend {
    Vec3 along = Vec3::Zero();  // direction in which the surface falls most (rises most, for pits)
    bool saddle = false;
  };
  std::optional<Bend> BendAt(const SurfaceJet& jet) const {
    const double e = jet.du.squaredNorm(), f = jet.du.dot(jet.dv), g = jet.dv.squaredNorm();
    const double w = std::sqrt(e * g - f * f);
    if (!(w > 0.0) || !(FlowGradient(jet, flow_).norm() < kLevel)) return std::nullopt;
    // x = du / |du|, and y is square to it.
    Eigen::Matrix2d to;  // columns: x and y in (u, v)
    to << 1.0 / std::sqrt(e), -f / (std::sqrt(e) * w), 0.0, std::sqrt(e) / w;
    Eigen::Matrix2d second;
    second << jet.duu.z(), jet.duv.z(), jet.duv.z(), jet.dvv.z();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(sign_ * to.transpose() * second * to);
    const Vec2 uv = to * solver.eigenvectors().col(0);
    Bend bend;
    bend.along = (uv.x() * jet.du + uv.y() * jet.dv).normalized();
    bend.saddle = solver.eigenvalues()[0] < 0.0 && solver.eigenvalues()[1] > 0.0;
    return bend;
  }

  // The saddle of the surface next to a pass of the mesh; the pass itself if there is none. Saddles are
  // vertices, because they are nodes of the split. A pass lies within a cell of its saddle.
  MeshVertex SaddleNear(const MeshVertex& pass) const {
    const Vec3 p = PointOf(pass);
    double reach = 0.0;
    for (const int n : Around(pass))
      reach = std::max(reach, kNearSaddle * (PointOf({pass.piece, n}) - p).norm());
    MeshVertex best = pass;
    double nearest = reach;
    for (std::size_t piece = 0; piece < meshes_.size(); ++piece) {
      const Box3& box = boxes_[piece];
      if ((p - p.cwiseMax(box.min).cwiseMin(box.max)).norm() >= nearest) continue;
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

  // Directions in which lines leave a pass: both ways along the axis of a saddle, else down the steepest
  // sides of triangles.
  std::vector<Vec3> Directions(const MeshVertex& from) const {
    const auto bend = BendAt(JetAt(from));
    if (bend && bend->saddle) return {bend->along, -bend->along};
    std::vector<Vec3> found;
    const Vec3 p = PointOf(from);
    for (int round = 0; round < 2; ++round) {
      double steepest = 0.0;
      std::optional<Vec3> best;
      for (const int n : Around(from)) {
        const Vec3 d = PointOf({from.piece, n}) - p;
        if (round == 1 && Xy(d).dot(Xy(found.front())) > 0.0) continue;
        const double slope = -sign_ * d.z() / d.norm();
        if (!(slope > steepest)) continue;
        steepest = slope;
        best = d.normalized();
      }
      if (!best) break;
      found.push_back(*best);
    }
    return found;
  }

  const Surface& surface_;
  const FlowParams& flow_;
  const double sign_;
  const std::vector<SplitMesh>& meshes_;
  const std::vector<Box3>& boxes_;
};

}  // namespace

const FlowTrack::Step* FlowTrack::At(std::size_t k) {
  while (steps_.size() <= k && !ended_) Extend();
  return k < steps_.size() ? &steps_[k] : nullptr;
}

void FlowTrack::GoAhead(const RunContext& run) {
  for (std::size_t k = 0; start_ && k < kAhead && !run.Cancelled(); ++k) {
    if (At(k) == nullptr) return;
  }
}

void FlowTrack::Extend() {
  const FlowPlace& from = steps_.empty()            ? *start_
                          : steps_.back().at_border ? *steps_.back().beyond
                                                    : steps_.back().place;
  const auto flow = Advance({*surface_, *params_, sign_}, from, &length_);
  ended_ = !flow;
  if (!flow) return;
  Step step{flow->place, flow->at_border};
  if (flow->at_border) {
    step.beyond = CrossBorder({*surface_, *params_, sign_}, flow->place);
    ended_ = !step.beyond;
  }
  steps_.push_back(std::move(step));
}

std::vector<WatershedStart> FindStarts(const SplitSurface& split, const std::vector<Box3>& boxes,
                                       const FlowParams& flow, double sign, const MeshVertex& pass) {
  return StartFinder(split, boxes, flow, sign).At(pass);
}

}  // namespace patchmill
