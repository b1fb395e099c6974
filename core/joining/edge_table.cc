#include "core/joining/edge_table.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/base/union_find.h"
#include "core/joining/edge_checks.h"
#include "core/joining/face_push.h"
#include "core/joining/network_findings.h"
#include "core/network/corner_vertices.h"
#include "core/network/patch_model.h"

namespace patchmill {
namespace {

std::size_t At(int i) { return static_cast<std::size_t>(i); }

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

void CheckVertices(const CurveNetwork& network, const NetworkWriter& findings) {
  std::vector<bool> used(network.vertices.size());
  for (const NetworkFace& face : network.faces) {
    for (const int v : face.vertices) used[At(v)] = true;
  }
  Box3 box;
  std::vector<Vec3> places;
  bool sound = true;
  for (std::size_t i = 0; i < network.vertices.size(); ++i) {
    const NetworkVertex& vertex = network.vertices[i];
    const Where where = findings.AtVertex(static_cast<int>(i));
    sound = CheckPlace(vertex.position, "position", findings, where) && sound;
    for (const NetworkVertex::Normal& normal : vertex.normals) {
      if (!normal.direction.allFinite() || !(normal.direction.norm() > 1e-12)) {
        findings.Error("INVALID_NORMAL", where, "has a normal without direction");
      }
    }
    if (!used[i]) findings.Error("UNUSED_VERTEX", where, "belongs to no face; leave it out");
    places.push_back(vertex.position);
    box.Add(vertex.position);
  }
  if (!sound) return;
  if (network.join_tolerance && !(*network.join_tolerance > 0.0 && std::isfinite(*network.join_tolerance))) {
    Where where;
    where.field = "network.join_tolerance";
    findings.Error("INVALID_JOIN_TOLERANCE", where,
                   fmt::format("= {:g}; must be > 0", *network.join_tolerance));
    return;
  }
  const double tolerance = network.join_tolerance.value_or(kDefaultJoinTolerance * box.Diagonal());
  if (!(tolerance > 0.0)) return;
  const CornerVertices merged = MergeCorners(places, tolerance);
  std::map<int, int> first;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [it, fresh] = first.emplace(merged.vertex_of[i], static_cast<int>(i));
    if (!fresh) {
      findings.Error(
          "DUPLICATE_VERTEX", findings.AtVertex(static_cast<int>(i)),
          fmt::format("lies within {:g} of vertices[{}]; faces that meet there must name one vertex",
                      tolerance, it->second));
    }
  }
}

bool CheckReferences(const CurveNetwork& network, const NetworkWriter& findings) {
  bool sound = true;
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
      std::string advice = "give three or four vertices";
      if (loop.size() == 5)
        advice = fmt::format("insert an edge from vertex {} to {} or another diagonal, and give two faces",
                             loop[0], loop[2]);
      if (loop.size() > 5)
        advice = "insert edges that leave three or four sides, and give the parts as faces";
      findings.Error("FACE_SIDES", findings.AtFace(f), fmt::format("has {} sides; {}", loop.size(), advice));
    } else if (std::set<int>(loop.begin(), loop.end()).size() != loop.size()) {
      sound = false;
      findings.Error("ZERO_LENGTH_EDGE", findings.AtFace(f), "names a vertex twice");
    }
  }
  return sound;
}

}  // namespace

bool EdgeTable::Forward(const FaceSide& s, const CurveNetwork& network) const {
  return edges[At(face_edges[At(s.face)][At(s.side)])].start ==
         network.faces[At(s.face)].vertices[At(s.side)];
}

EdgeTable BuildEdgeTable(const CurveNetwork& network, Diagnostics& list) {
  const NetworkWriter findings(network, list);
  EdgeTable table;
  const int faces = static_cast<int>(network.faces.size());
  if (faces < 1 || faces > kMaxNetworkFaces) {
    Where where;
    where.field = "network.faces";
    findings.Error("PATCH_COUNT", where,
                   fmt::format("has {} faces; must have 1 to {}", faces, kMaxNetworkFaces));
    return table;
  }
  if (!CheckReferences(network, findings)) return table;
  CheckVertices(network, findings);
  CheckEdgeShapes(network, findings);
  CheckPushes(network, findings);

  std::map<std::pair<int, int>, int> by_ends;
  for (int e = 0; e < static_cast<int>(network.edges.size()); ++e) {
    const NetworkEdge& edge = network.edges[At(e)];
    if (edge.start == edge.end) {
      findings.Error("ZERO_LENGTH_EDGE", findings.AtEdge(e), "starts and ends at the same vertex");
      continue;
    }
    const auto [it, fresh] =
        by_ends.emplace(std::minmax(edge.start, edge.end), static_cast<int>(table.edges.size()));
    if (!fresh) {
      findings.Error("DUPLICATE_EDGE", findings.AtEdge(e),
                     fmt::format("joins the vertices of edges[{}]; insert a vertex on one of them",
                                 *table.edges[At(it->second)].given));
      continue;
    }
    table.edges.push_back({edge.start, edge.end, {}, e, edge.crease});
  }
  table.face_edges.resize(At(faces));
  for (int f = 0; f < faces; ++f) {
    const auto& loop = network.faces[At(f)].vertices;
    for (int s = 0; s < static_cast<int>(loop.size()); ++s) {
      const int a = loop[At(s)], b = loop[(At(s) + 1) % loop.size()];
      const auto [it, fresh] = by_ends.emplace(std::minmax(a, b), static_cast<int>(table.edges.size()));
      if (fresh) table.edges.push_back({a, b, {}, std::nullopt, false});
      table.face_edges[At(f)][At(s)] = it->second;
      table.edges[At(it->second)].faces.push_back({f, s});
    }
  }
  for (const TableEdge& edge : table.edges) {
    const Where where = edge.given ? findings.AtEdge(*edge.given) : findings.AtVertex(edge.start);
    if (edge.faces.empty()) {
      findings.Error("DANGLING_EDGE", where,
                     fmt::format("from vertex {} to {} belongs to no face", edge.start, edge.end));
    } else if (edge.faces.size() > 2) {
      findings.Error("NON_MANIFOLD_EDGE", where,
                     fmt::format("from vertex {} to {} has {} faces; at most two", edge.start, edge.end,
                                 edge.faces.size()));
    } else if (edge.crease && edge.faces.size() == 1) {
      findings.Error(
          "CONTRADICTORY_CREASE", where,
          fmt::format("from vertex {} to {} is a crease but has one face only", edge.start, edge.end));
    }
  }

  // Groups: faces that meet in a vertex, joined by smooth edges; fans: by any edge.
  UnionFind groups(4 * At(faces)), fans(4 * At(faces));
  const auto corner = [&](const FaceSide& s, int vertex) {
    const auto& loop = network.faces[At(s.face)].vertices;
    const std::size_t k = loop[At(s.side)] == vertex ? At(s.side) : (At(s.side) + 1) % loop.size();
    return 4 * At(s.face) + k;
  };
  for (const TableEdge& edge : table.edges) {
    for (std::size_t k = 1; k < edge.faces.size(); ++k) {
      for (const int v : {edge.start, edge.end}) {
        const std::size_t a = corner(edge.faces[0], v), b = corner(edge.faces[k], v);
        fans.Join(a, b);
        if (!edge.crease) groups.Join(a, b);
      }
    }
  }
  table.group.resize(At(faces));
  std::map<std::size_t, int> number;
  std::map<int, std::size_t> fan_of_vertex;
  std::set<int> split;
  for (int f = 0; f < faces; ++f) {
    const auto& loop = network.faces[At(f)].vertices;
    for (int s = 0; s < static_cast<int>(loop.size()); ++s) {
      table.group[At(f)][At(s)] =
          number.emplace(groups.Find(At(4 * f + s)), static_cast<int>(number.size())).first->second;
      const std::size_t fan = fans.Find(At(4 * f + s));
      const int v = loop[At(s)];
      if (fan_of_vertex.emplace(v, fan).first->second != fan && split.insert(v).second) {
        findings.Error("NON_MANIFOLD_VERTEX", findings.AtVertex(v),
                       "joins fans of faces that share no edge there; give one vertex to each");
      }
    }
  }
  table.group_count = static_cast<int>(number.size());

  // Breadth first over the edges; a one-sided strip keeps what it met first.
  table.sense.assign(At(faces), 0.0);
  for (int seed = 0; seed < faces; ++seed) {
    if (table.sense[At(seed)] != 0.0) continue;
    table.sense[At(seed)] = 1.0;
    std::deque<int> open = {seed};
    for (; !open.empty(); open.pop_front()) {
      const int f = open.front();
      for (int s = 0; s < SideCount(network.faces[At(f)]); ++s) {
        const TableEdge& edge = table.edges[At(table.face_edges[At(f)][At(s)])];
        for (const FaceSide& other : edge.faces) {
          if (table.sense[At(other.face)] != 0.0) continue;
          const bool same_way = table.Forward({f, s}, network) == table.Forward(other, network);
          table.sense[At(other.face)] = same_way ? -table.sense[At(f)] : table.sense[At(f)];
          open.push_back(other.face);
        }
      }
    }
  }
  return table;
}

}  // namespace patchmill
