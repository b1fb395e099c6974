#include "core/joining/edge_table.h"

#include <algorithm>
#include <deque>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/base/union_find.h"
#include "core/joining/edge_checks.h"
#include "core/joining/face_push.h"
#include "core/joining/network_checks.h"
#include "core/joining/network_findings.h"
#include "core/joining/t_vertices.h"

namespace patchmill {
namespace {

void AddListedEdges(const CurveNetwork& network, const NetworkWriter& findings, EdgeByEnds& by_ends,
                    EdgeTable& table) {
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
}

void AddFaceSides(const CurveNetwork& network, const DividedEdges& divided, EdgeByEnds& by_ends,
                  EdgeTable& table) {
  for (int f = 0; f < static_cast<int>(network.faces.size()); ++f) {
    const auto& loop = network.faces[At(f)].vertices;
    for (int s = 0; s < static_cast<int>(loop.size()); ++s) {
      const int a = loop[At(s)], b = loop[(At(s) + 1) % loop.size()];
      const auto [it, fresh] = by_ends.emplace(std::minmax(a, b), static_cast<int>(table.edges.size()));
      if (fresh) {
        const auto part = divided.parts.find(it->first);
        table.edges.push_back(part != divided.parts.end() ? part->second
                                                          : TableEdge{a, b, {}, std::nullopt, false});
      }
      table.face_edges[At(f)][At(s)] = it->second;
      table.edges[At(it->second)].faces.push_back({f, s});
    }
  }
}

// Sorts the parts of divided edges and lists the corners at each vertex on an edge.
void LinkParts(const CurveNetwork& network, EdgeTable& table) {
  if (table.t_vertices.empty()) return;
  for (int e = 0; e < static_cast<int>(table.edges.size()); ++e) {
    if (const auto& part = table.edges[At(e)].part) table.edges[At(part->whole)].parts.push_back(e);
  }
  for (TableEdge& edge : table.edges) {
    std::ranges::sort(edge.parts, {}, [&](int p) { return table.edges[At(p)].part->from; });
  }
  std::map<int, TVertex*> of;
  for (TVertex& t : table.t_vertices) of.emplace(t.vertex, &t);
  for (int f = 0; f < static_cast<int>(network.faces.size()); ++f) {
    for (int s = 0; s < SideCount(network.faces[At(f)]); ++s) {
      const auto t = of.find(network.faces[At(f)].vertices[At(s)]);
      if (t != of.end()) t->second->corners.push_back({f, s});
    }
  }
}

void CheckFaceCounts(const EdgeTable& table, const NetworkWriter& findings) {
  for (const TableEdge& edge : table.edges) {
    if (edge.divided) continue;  // checked by CheckTVertices
    const Where where = edge.given ? findings.AtEdge(*edge.given) : findings.AtVertex(edge.start);
    if (edge.faces.empty()) {
      findings.Error("DANGLING_EDGE", where,
                     fmt::format("from vertex {} to {} belongs to no face", edge.start, edge.end));
    } else if (edge.part && edge.faces.size() > 1) {
      const auto leads = [&](const FaceSide& s) {
        return std::ranges::any_of(table.edges[At(edge.part->whole)].faces,
                                   [&](const FaceSide& leader) { return leader.face == s.face; });
      };
      if (std::ranges::any_of(edge.faces, leads)) continue;
      findings.Error(
          "NON_MANIFOLD_EDGE", where,
          fmt::format("from vertex {} to {} has {} faces and the one along the whole of which it is "
                      "a part; at most one",
                      edge.start, edge.end, edge.faces.size()));
    } else if (edge.faces.size() > 2) {
      findings.Error("NON_MANIFOLD_EDGE", where,
                     fmt::format("from vertex {} to {} has {} faces; at most two", edge.start, edge.end,
                                 edge.faces.size()));
    } else if (edge.crease && edge.faces.size() == 1 && !edge.part) {
      findings.Error(
          "CONTRADICTORY_CREASE", where,
          fmt::format("from vertex {} to {} is a crease but has one face only", edge.start, edge.end));
    }
  }
}

// Groups are corners of faces that meet in a vertex, joined by smooth edges. Fans are joined by edges of any
// kind.
class CornerSets {
 public:
  CornerSets(const CurveNetwork& network, const EdgeTable& table)
      : network_(network), groups_(4 * network.faces.size()), fans_(4 * network.faces.size()) {
    for (const TableEdge& edge : table.edges) {
      for (const int v : {edge.start, edge.end}) {
        for (std::size_t k = 1; k < edge.faces.size(); ++k) {
          Join(Corner(edge.faces[0], v), Corner(edge.faces[k], v), edge.crease);
        }
        if (!edge.part) continue;
        const TableEdge& whole = table.edges[At(edge.part->whole)];
        if (v != whole.start && v != whole.end) continue;
        for (const FaceSide& leader : whole.faces) {
          Join(Corner(leader, v), Corner(edge.faces[0], v), edge.crease);
        }
      }
    }
    // The faces along the parts meet at a place between them through the leading face.
    for (const TVertex& t : table.t_vertices) {
      const std::vector<FaceSide> corners = CornersAlong(network, table, t);
      for (const FaceSide& c : corners) {
        Join(4 * At(corners[0].face) + At(corners[0].side), 4 * At(c.face) + At(c.side),
             table.edges[At(t.edge)].crease);
      }
    }
  }

  // Numbers the groups. Reports NON_MANIFOLD_VERTEX where fans touch, unless an earlier finding explains it
  // (`reported`).
  void Write(const NetworkWriter& findings, bool reported, EdgeTable& table) {
    std::map<std::size_t, int> number;
    std::map<int, std::size_t> fan_of_vertex;
    std::set<int> split;
    table.group.resize(network_.faces.size());
    for (int f = 0; f < static_cast<int>(network_.faces.size()); ++f) {
      const auto& loop = network_.faces[At(f)].vertices;
      for (int s = 0; s < static_cast<int>(loop.size()); ++s) {
        table.group[At(f)][At(s)] =
            number.emplace(groups_.Find(At(4 * f + s)), static_cast<int>(number.size())).first->second;
        const std::size_t fan = fans_.Find(At(4 * f + s));
        const int v = loop[At(s)];
        if (fan_of_vertex.emplace(v, fan).first->second != fan && !reported && split.insert(v).second) {
          findings.Error("NON_MANIFOLD_VERTEX", findings.AtVertex(v),
                         "joins fans of faces that share no edge there; give one vertex to each");
        }
      }
    }
    table.group_count = static_cast<int>(number.size());
  }

 private:
  std::size_t Corner(const FaceSide& s, int vertex) const {
    const auto& loop = network_.faces[At(s.face)].vertices;
    const std::size_t k = loop[At(s.side)] == vertex ? At(s.side) : (At(s.side) + 1) % loop.size();
    return 4 * At(s.face) + k;
  }
  void Join(std::size_t a, std::size_t b, bool crease) {
    fans_.Join(a, b);
    if (!crease) groups_.Join(a, b);
  }

  const CurveNetwork& network_;
  UnionFind groups_, fans_;
};

// Breadth-first search over the edges. On a one-sided strip the sense found first stays.
void FindSenses(const CurveNetwork& network, EdgeTable& table) {
  const int faces = static_cast<int>(network.faces.size());
  table.sense.assign(At(faces), 0.0);
  std::deque<int> open;
  const auto meet = [&](const FaceSide& from, const FaceSide& to) {
    if (table.sense[At(to.face)] != 0.0) return;
    const bool same_way = table.Forward(from, network) == table.Forward(to, network);
    table.sense[At(to.face)] = same_way ? -table.sense[At(from.face)] : table.sense[At(from.face)];
    open.push_back(to.face);
  };
  for (int seed = 0; seed < faces; ++seed) {
    if (table.sense[At(seed)] != 0.0) continue;
    table.sense[At(seed)] = 1.0;
    open = {seed};
    for (; !open.empty(); open.pop_front()) {
      const int f = open.front();
      for (int s = 0; s < SideCount(network.faces[At(f)]); ++s) {
        const TableEdge& edge = table.edges[At(table.face_edges[At(f)][At(s)])];
        for (const FaceSide& other : edge.faces) meet({f, s}, other);
        // Parts run in the direction of the whole edge.
        if (edge.part) {
          for (const FaceSide& other : table.edges[At(edge.part->whole)].faces) meet({f, s}, other);
        }
        for (const int part : edge.parts) {
          for (const FaceSide& other : table.edges[At(part)].faces) meet({f, s}, other);
        }
      }
    }
  }
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
  const bool apart = CheckVertices(network, findings);
  CheckEdgeShapes(network, findings);
  CheckPushes(network, findings);
  CheckBulges(network, findings);
  CheckTwists(network, findings);

  EdgeByEnds by_ends;
  AddListedEdges(network, findings, by_ends, table);
  const DividedEdges divided = DivideEdges(network, findings, by_ends, table);
  table.face_edges.resize(At(faces));
  AddFaceSides(network, divided, by_ends, table);
  LinkParts(network, table);
  CheckFaceCounts(table, findings);
  const bool sound = divided.sound && CheckTVertices(network, findings, table);
  CornerSets(network, table).Write(findings, !(sound && apart), table);
  FindSenses(network, table);
  if (sound) OrderTVertices(network, findings, table);
  return table;
}

}  // namespace patchmill
