#include "core/joining/corner_normals.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/Eigenvalues>

#include "core/base/index.h"

namespace patchmill {
namespace {

// The direction in which a listed edge leaves one end, if the network gives it.
std::optional<Vec3> GivenDirection(const EdgeShape& shape, bool at_start) {
  if (const auto* tangents = std::get_if<TangentsEdge>(&shape))
    return at_start ? tangents->start : tangents->end;
  if (const auto* curve = std::get_if<CurveEdge>(&shape)) {
    const CurveJet jet = Evaluate(curve->curve, at_start ? 0.0 : 1.0);
    return at_start ? jet.d : Vec3(-jet.d);
  }
  return std::nullopt;
}

Vec3 FitNormal(const Vec3& mean, const std::vector<Vec3>& tangents) {
  if (tangents.empty()) return mean.normalized();
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (const Vec3& t : tangents) moment += t * t.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moment);
  Vec3 normal;
  if (solver.eigenvalues()[1] > 1e-6) {  // they span a plane
    normal = solver.eigenvectors().col(0);
  } else {
    const Vec3 t = solver.eigenvectors().col(2);
    normal = mean - t * t.dot(mean);
  }
  if (normal.dot(mean) < 0.0) normal = -normal;
  return normal.normalized();
}

}  // namespace

std::vector<std::array<CornerNormal, 4>> CornerNormals(const CurveNetwork& network, const EdgeTable& table) {
  const std::size_t faces = network.faces.size();
  std::vector<std::array<CornerNormal, 4>> normals(faces);
  std::vector<int> corners(At(table.group_count));
  std::vector<Vec3> mean(At(table.group_count), Vec3::Zero());
  std::vector<std::vector<Vec3>> tangents(At(table.group_count));
  for (std::size_t f = 0; f < faces; ++f) {
    const auto& loop = network.faces[f].vertices;
    const std::size_t n = loop.size();
    for (std::size_t s = 0; s < n; ++s) {
      const Vec3& p = network.vertices[At(loop[s])].position;
      const Vec3 a = network.vertices[At(loop[(s + 1) % n])].position - p;
      const Vec3 b = network.vertices[At(loop[(s + n - 1) % n])].position - p;
      const Vec3 cross = a.cross(b);
      const double length = cross.norm();
      const auto group = At(table.group[f][s]);
      ++corners[group];
      if (length > 0.0) mean[group] += table.sense[f] * std::atan2(length, a.dot(b)) / length * cross;
      for (const std::size_t side : {s, (s + n - 1) % n}) {
        const TableEdge& here = table.edges[At(table.face_edges[f][side])];
        const TableEdge& edge = here.part ? table.edges[At(here.part->whole)] : here;
        if (!edge.given || (edge.start != loop[s] && edge.end != loop[s])) continue;
        const auto d = GivenDirection(network.edges[At(*edge.given)].shape, edge.start == loop[s]);
        if (d && d->norm() > 0.0) tangents[group].push_back(d->normalized());
      }
    }
  }
  for (std::size_t f = 0; f < faces; ++f) {
    const auto& loop = network.faces[f].vertices;
    for (std::size_t s = 0; s < loop.size(); ++s) {
      const auto group = At(table.group[f][s]);
      const NetworkVertex::Normal* given = nullptr;
      for (const auto& normal : network.vertices[At(loop[s])].normals) {
        const bool listed = std::ranges::count(normal.faces, static_cast<int>(f)) > 0;
        if (listed || (normal.faces.empty() && given == nullptr)) given = &normal;
      }
      normals[f][s] = {
          given != nullptr ? given->direction.normalized() : FitNormal(mean[group], tangents[group]),
          given == nullptr && corners[group] == 1};
    }
  }
  return normals;
}

}  // namespace patchmill
