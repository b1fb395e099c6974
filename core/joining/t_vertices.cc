#include "core/joining/t_vertices.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/base/index.h"

namespace patchmill {
namespace {

constexpr std::string_view kCode = "INVALID_T_VERTEX";

struct Place {
  double at = 0.0;
  int vertex = 0;
};

// An edge with the places at which it is cut, in ascending order.
struct CutEdge {
  int index = 0;
  const TableEdge& whole;
  const std::vector<Place>& places;
};

void AddParts(const NetworkWriter& findings, const CutEdge& edge, const EdgeByEnds& by_ends,
              DividedEdges& divided) {
  const auto& [index, whole, places] = edge;
  std::vector<Place> all = {{0.0, whole.start}};
  all.insert(all.end(), places.begin(), places.end());
  all.push_back({1.0, whole.end});
  for (std::size_t k = 1; k < all.size(); ++k) {
    const auto [from, a] = all[k - 1];
    const auto [to, b] = all[k];
    const int vertex = k + 1 < all.size() ? b : a;
    const auto error = [&](std::string_view text) {
      divided.sound = false;
      findings.Error(kCode, findings.AtVertex(vertex), text);
    };
    if (to - from < kMinEdgePart) {
      error(fmt::format("lies {:g} after vertex {} on their edge; must be at least {:g}", to - from, a,
                        kMinEdgePart));
    } else if (by_ends.contains(std::minmax(a, b))) {
      error(
          fmt::format("makes a part from vertex {} to {} of the edge it lies on; that part is listed as an "
                      "edge or divided itself: it takes the curve of the whole, name that one",
                      a, b));
    } else {
      divided.parts.emplace(std::minmax(a, b),
                            TableEdge{a, b, {}, std::nullopt, whole.crease, EdgePart{index, from, to}});
    }
  }
}

// For every vertex its entry of t_vertices, or nullptr.
std::vector<const TVertex*> ByVertex(const CurveNetwork& network, const EdgeTable& table) {
  std::vector<const TVertex*> of(network.vertices.size());
  for (const TVertex& t : table.t_vertices) of[At(t.vertex)] = &t;
  return of;
}

bool CheckLeaders(const CurveNetwork& network, const NetworkWriter& findings, const EdgeTable& table) {
  bool sound = true;
  std::set<int> reported;
  const auto error = [&](int vertex, std::string_view text) {
    sound = false;
    findings.Error(kCode, findings.AtVertex(vertex), text);
  };
  for (const TVertex& t : table.t_vertices) {
    const TableEdge& whole = table.edges[At(t.edge)];
    if (whole.faces.size() != 1) {
      if (!reported.insert(t.edge).second) continue;
      error(t.vertex,
            fmt::format("lies on the edge from vertex {} to {}, which is a side of {} faces; must be "
                        "one, the others have sides along its parts",
                        whole.start, whole.end, whole.faces.size()));
      continue;
    }
    const int leader = whole.faces[0].face;
    const std::vector<FaceSide> corners = CornersAlong(network, table, t);
    if (std::ranges::count(network.faces[At(leader)].vertices, t.vertex) > 0) {
      error(t.vertex, fmt::format("lies on a side of faces[{}] and is a corner of it", leader));
    } else if (corners.empty()) {
      error(t.vertex,
            fmt::format("lies on the edge from vertex {} to {}, but no face has a side along a part "
                        "of that edge there",
                        whole.start, whole.end));
    } else if (!whole.crease &&
               std::ranges::any_of(network.vertices[At(t.vertex)].normals, [&](const auto& normal) {
                 return normal.faces.empty() || std::ranges::any_of(corners, [&](const FaceSide& c) {
                          return std::ranges::count(normal.faces, c.face) > 0;
                        });
               })) {
      error(t.vertex, fmt::format("has a normal, but lies on a smooth edge: faces[{}] gives it; leave it out "
                                  "or make the edge a crease",
                                  leader));
    }
  }
  return sound;
}

// Reports sides that join two places of one edge and skip a place between them.
bool CheckSkips(const CurveNetwork& network, const NetworkWriter& findings, const EdgeTable& table) {
  bool sound = true;
  const std::vector<const TVertex*> of = ByVertex(network, table);
  for (const TableEdge& edge : table.edges) {
    if (edge.part || edge.faces.empty()) continue;
    for (const auto& [a, b] : {std::pair(edge.start, edge.end), std::pair(edge.end, edge.start)}) {
      if (of[At(a)] == nullptr) continue;
      const TableEdge& whole = table.edges[At(of[At(a)]->edge)];
      const bool same =
          of[At(b)] != nullptr ? of[At(b)]->edge == of[At(a)]->edge : b == whole.start || b == whole.end;
      if (!same) continue;
      sound = false;
      findings.Error(kCode, findings.AtVertex(a),
                     fmt::format("faces[{}] has a side from there to vertex {} that skips a vertex on their "
                                 "edge; give it that corner",
                                 edge.faces[0].face, b));
      break;
    }
  }
  return sound;
}

}  // namespace

bool CheckTReferences(const CurveNetwork& network, const NetworkWriter& findings) {
  bool sound = true;
  const int count = static_cast<int>(network.vertices.size());
  for (int v = 0; v < count; ++v) {
    const auto& on = network.vertices[At(v)].on_edge;
    if (!on) continue;
    const auto error = [&](std::string_view code, std::string_view text) {
      sound = false;
      findings.Error(code, findings.AtVertex(v), text);
    };
    if (const int bad = on->start < 0 || on->start >= count ? on->start : on->end; bad < 0 || bad >= count) {
      error("INVALID_REFERENCE",
            fmt::format("lies on an edge of vertex {}; must be in [0, {}]", bad, count - 1));
    } else if (on->start == on->end || on->start == v || on->end == v) {
      error(kCode,
            fmt::format("lies on the edge from vertex {} to {}; must be two others", on->start, on->end));
    } else if (!(on->parameter >= kMinEdgePart && on->parameter <= 1.0 - kMinEdgePart)) {
      error(kCode, fmt::format("lies at {:g} of its edge; must be in [{:g}, {:g}]", on->parameter,
                               kMinEdgePart, 1.0 - kMinEdgePart));
    }
  }
  return sound;
}

DividedEdges DivideEdges(const CurveNetwork& network, const NetworkWriter& findings, EdgeByEnds& by_ends,
                         EdgeTable& table) {
  std::map<int, std::vector<Place>> places;  // of each divided edge
  for (int v = 0; v < static_cast<int>(network.vertices.size()); ++v) {
    const auto& on = network.vertices[At(v)].on_edge;
    if (!on) continue;
    const auto [it, fresh] =
        by_ends.emplace(std::minmax(on->start, on->end), static_cast<int>(table.edges.size()));
    if (fresh) table.edges.push_back({on->start, on->end, {}, std::nullopt, false});
    TableEdge& whole = table.edges[At(it->second)];
    whole.divided = true;
    const double at = whole.start == on->start ? on->parameter : 1.0 - on->parameter;
    table.t_vertices.push_back({v, it->second, at});
    places[it->second].push_back({at, v});
  }
  DividedEdges divided;
  for (auto& [edge, list] : places) {
    std::ranges::stable_sort(list, {}, &Place::at);
    AddParts(findings, {edge, table.edges[At(edge)], list}, by_ends, divided);
  }
  return divided;
}

bool CheckTVertices(const CurveNetwork& network, const NetworkWriter& findings, const EdgeTable& table) {
  if (table.t_vertices.empty()) return true;
  const bool leaders = CheckLeaders(network, findings, table);
  return CheckSkips(network, findings, table) && leaders;
}

void OrderTVertices(const CurveNetwork& network, const NetworkWriter& findings, EdgeTable& table) {
  // A vertex waits for the vertices on edges among the corners of its leading face: the ends of its edge, and
  // of the edges that cross it there.
  const std::vector<const TVertex*> of = ByVertex(network, table);
  std::vector<int> waits(network.vertices.size());
  std::vector<std::vector<const TVertex*>> then(network.vertices.size());
  std::vector<const TVertex*> ready;
  for (const TVertex& t : table.t_vertices) {
    for (const int corner : network.faces[At(table.edges[At(t.edge)].faces[0].face)].vertices) {
      if (of[At(corner)] == nullptr) continue;
      ++waits[At(t.vertex)];
      then[At(corner)].push_back(&t);
    }
    if (waits[At(t.vertex)] == 0) ready.push_back(&t);
  }
  for (std::size_t k = 0; k < ready.size(); ++k) {
    for (const TVertex* next : then[At(ready[k]->vertex)]) {
      if (--waits[At(next->vertex)] == 0) ready.push_back(next);
    }
  }
  if (ready.size() < table.t_vertices.size()) {
    const auto stuck =
        std::ranges::find_if(table.t_vertices, [&](const TVertex& t) { return waits[At(t.vertex)] > 0; });
    findings.Error("T_VERTEX_CYCLE", findings.AtVertex(stuck->vertex),
                   "lies on an edge of a face that waits for the place of this very vertex; make one of the "
                   "T-junctions around it a vertex of both sides");
    return;
  }
  std::vector<TVertex> sorted;
  for (const TVertex* t : ready) sorted.push_back(*t);
  table.t_vertices = std::move(sorted);
}

std::vector<FaceSide> CornersAlong(const CurveNetwork& network, const EdgeTable& table, const TVertex& t) {
  std::vector<FaceSide> corners;
  for (const int p : table.edges[At(t.edge)].parts) {
    const TableEdge& part = table.edges[At(p)];
    if (part.start != t.vertex && part.end != t.vertex) continue;
    for (const FaceSide& s : part.faces) {
      const int n = SideCount(network.faces[At(s.face)]);
      const bool first = network.faces[At(s.face)].vertices[At(s.side)] == t.vertex;
      corners.push_back({s.face, first ? s.side : (s.side + 1) % n});
    }
  }
  return corners;
}

}  // namespace patchmill
