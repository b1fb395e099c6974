#include "core/joining/network_checks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/joining/t_vertices.h"
#include "core/network/corner_vertices.h"
#include "core/network/patch_model.h"

namespace patchmill {
namespace {

bool CheckPlace(const Vec3& p, std::string_view what, const NetworkWriter& findings, Where where) {
  if (!p.allFinite()) {
    findings.Error("NOT_FINITE", std::move(where), fmt::format("{} has a number that is not finite", what));
  } else if (!(p.cwiseAbs().maxCoeff() <= kMaxCoordinate)) {
    findings.Error("TOO_LARGE", std::move(where),
                   fmt::format("{} has {:g}; must be in [-{:g}, {:g}]", what, p.cwiseAbs().maxCoeff(),
                               kMaxCoordinate, kMaxCoordinate));
  } else {
    return true;
  }
  return false;
}

// The edges that could be inserted into a face of any number of sides but three and four [joining, section
// 2]. Which one suits is the designer's choice, because it becomes a line of the surface.
std::string CutsOf(const std::vector<int>& loop) {
  const std::size_t n = loop.size();
  if (n < 3) return "give three or four vertices";
  std::string cuts;
  if (n == 5 || n == 6) {  // 5: a triangle and a quad; 6: two quads
    const std::size_t across = n - 3, count = n == 5 ? 5 : 3;
    for (std::size_t k = 0; k < count; ++k) {
      cuts += fmt::format("{}{}-{}",
                          k == 0          ? ""
                          : k + 1 < count ? ", "
                                          : " or ",
                          loop[k], loop[(k + across) % n]);
    }
    return fmt::format(
        "insert one edge, between vertices {}, and give two faces{}, or name it as a cut of this one", cuts,
        n == 5 ? ", a triangle and a quad" : " of four sides");
  }
  for (std::size_t k = 3; k + 1 < n; k += 2)
    cuts += fmt::format("{}{}-{}", k == 3 ? "" : ", ", loop[0], loop[k]);
  return fmt::format(
      "insert edges, for instance between vertices {}, that leave faces of three or four sides (or name them "
      "as its "
      "cuts), or a vertex inside with an edge to every other corner",
      cuts.size() < 200 ? cuts : cuts.substr(0, cuts.rfind(',', 200)) + ", ...");
}

}  // namespace

bool CheckVertices(const CurveNetwork& network, const NetworkWriter& findings) {
  std::vector<bool> used(network.vertices.size());
  for (const NetworkFace& face : network.faces) {
    for (const int v : face.vertices) used[At(v)] = true;
  }
  Box3 box;
  std::vector<int> placed;  // vertices with a position of their own
  std::vector<Vec3> places;
  bool sound = true;
  for (std::size_t i = 0; i < network.vertices.size(); ++i) {
    const NetworkVertex& vertex = network.vertices[i];
    const Where where = findings.AtVertex(static_cast<int>(i));
    if (!vertex.on_edge) sound = CheckPlace(vertex.position, "position", findings, where) && sound;
    for (const NetworkVertex::Normal& normal : vertex.normals) {
      if (!normal.direction.allFinite() || !(normal.direction.norm() > 1e-12)) {
        findings.Error("INVALID_NORMAL", where, "has a normal without direction");
      }
    }
    if (!used[i]) findings.Error("UNUSED_VERTEX", where, "belongs to no face; leave it out");
    if (vertex.on_edge) continue;
    placed.push_back(static_cast<int>(i));
    places.push_back(vertex.position);
    box.Add(vertex.position);
  }
  if (!sound) return true;
  if (network.join_tolerance && !(*network.join_tolerance > 0.0 && std::isfinite(*network.join_tolerance))) {
    Where where;
    where.field = "network.join_tolerance";
    findings.Error("INVALID_JOIN_TOLERANCE", where,
                   fmt::format("= {:g}; must be > 0", *network.join_tolerance));
    return true;
  }
  const double tolerance = network.join_tolerance.value_or(kDefaultJoinTolerance * box.Diagonal());
  if (!(tolerance > 0.0)) return true;
  const CornerVertices merged = MergeCorners(places, tolerance);
  std::map<int, int> first;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [it, fresh] = first.emplace(merged.vertex_of[i], placed[i]);
    if (!fresh) {
      findings.Error(
          "DUPLICATE_VERTEX", findings.AtVertex(placed[i]),
          fmt::format("lies within {:g} of vertices[{}]; faces that meet there must name one vertex",
                      tolerance, it->second));
    }
  }
  return first.size() == places.size();
}

bool CheckReferences(const CurveNetwork& network, const NetworkWriter& findings) {
  bool sound = CheckTReferences(network, findings);
  const int vertices = static_cast<int>(network.vertices.size()),
            faces = static_cast<int>(network.faces.size());
  const auto check = [&](int index, int count, std::string_view what, Where where) {
    if (index >= 0 && index < count) return;
    sound = false;
    findings.Error("INVALID_REFERENCE", std::move(where),
                   fmt::format("names {} {}; must be in [0, {}]", what, index, count - 1));
  };
  for (int i = 0; i < vertices; ++i) {
    for (const auto& normal : network.vertices[At(i)].normals) {
      for (const int f : normal.faces) {
        check(f, faces, "face", findings.AtVertex(i));
        if (f >= 0 && f < faces && std::ranges::count(network.faces[At(f)].vertices, i) == 0) {
          findings.Error("INVALID_REFERENCE", findings.AtVertex(i),
                         fmt::format("has a normal for faces[{}], which does not touch it", f));
        }
      }
    }
  }
  for (int e = 0; e < static_cast<int>(network.edges.size()); ++e) {
    check(network.edges[At(e)].start, vertices, "vertex", findings.AtEdge(e));
    check(network.edges[At(e)].end, vertices, "vertex", findings.AtEdge(e));
  }
  for (int f = 0; f < faces; ++f) {
    const auto& loop = network.faces[At(f)].vertices;
    for (const int v : loop) check(v, vertices, "vertex", findings.AtFace(f));
    if (loop.size() < 3 || loop.size() > 4) {
      sound = false;
      if (!network.faces[At(f)].cuts.empty()) continue;  // WithCutFaces reports it
      findings.Error("FACE_SIDES", findings.AtFace(f),
                     fmt::format("has {} sides; {}", loop.size(), CutsOf(loop)));
    } else if (std::set<int>(loop.begin(), loop.end()).size() != loop.size()) {
      sound = false;
      findings.Error("ZERO_LENGTH_EDGE", findings.AtFace(f), "names a vertex twice");
    }
  }
  return sound;
}

}  // namespace patchmill
