#include "core/division/mesh_network.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/base/index.h"

namespace patchmill {
namespace {

Vec3 AreaOf(const PolygonMesh& mesh, const std::vector<int>& face) {
  Vec3 area = Vec3::Zero();
  for (std::size_t k = 1; k + 1 < face.size(); ++k) {
    const Vec3& origin = mesh.points[At(face[0])];
    area += 0.5 * (mesh.points[At(face[k])] - origin).cross(mesh.points[At(face[k + 1])] - origin);
  }
  return area;
}

}  // namespace

CurveNetwork MeshNetwork(const PolygonMesh& mesh, double crease_angle, Diagnostics& findings) {
  CurveNetwork network;
  std::vector<int> vertex(mesh.points.size(), -1);
  std::vector<Vec3> areas;
  std::map<std::pair<int, int>, std::vector<std::pair<int, bool>>>
      sides;  // face, and whether it runs upwards
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::vector<int>& corners = mesh.faces[f];
    const Vec3 area = AreaOf(mesh, corners);
    const std::set<int> distinct(corners.begin(), corners.end());
    if (distinct.size() < corners.size() || !(area.norm() > 0.0)) {
      findings.push_back(
          MakeWarning("DEGENERATE_FACE",
                      fmt::format("mesh face {} {} and is left out", f + 1,
                                  distinct.size() < corners.size() ? "names a point twice" : "has no area"),
                      {.point = mesh.points[At(corners[0])], .field = "mesh"}));
      continue;
    }
    NetworkFace& face = network.faces.emplace_back();
    face.id = fmt::format("f{}", f + 1);
    for (const int p : corners) {
      if (vertex[At(p)] < 0) {
        vertex[At(p)] = static_cast<int>(network.vertices.size());
        network.vertices.emplace_back().position = mesh.points[At(p)];
      }
      face.vertices.push_back(vertex[At(p)]);
    }
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const int a = face.vertices[k], b = face.vertices[(k + 1) % corners.size()];
      sides[std::minmax(a, b)].emplace_back(static_cast<int>(areas.size()), a < b);
    }
    areas.push_back(area.normalized());
  }
  for (const auto& [ends, faces] : sides) {
    if (faces.size() != 2) continue;
    // Polygons that run alike along their side have opposite senses.
    const Vec3 a = areas[At(faces[0].first)];
    const Vec3 b = (faces[0].second == faces[1].second ? -1.0 : 1.0) * areas[At(faces[1].first)];
    if (std::atan2(a.cross(b).norm(), a.dot(b)) <= crease_angle) continue;
    NetworkEdge& edge = network.edges.emplace_back();
    edge.start = ends.first, edge.end = ends.second;
    edge.crease = true;
  }
  return network;
}

}  // namespace patchmill
