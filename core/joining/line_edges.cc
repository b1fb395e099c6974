#include "core/joining/line_edges.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/curve/ended_spline.h"
#include "core/curve/spline.h"
#include "core/joining/network_findings.h"

namespace patchmill {

CurveNetwork WithLinesAsEdges(const CurveNetwork& network, Diagnostics& list) {
  const NetworkWriter findings(network, list);
  const int count = static_cast<int>(network.vertices.size());
  CurveNetwork whole = network;
  whole.lines.clear();
  for (int k = 0; k < static_cast<int>(network.lines.size()); ++k) {
    const NetworkLine& line = network.lines[static_cast<std::size_t>(k)];
    const auto bad = std::ranges::find_if(line.vertices, [&](int v) { return v < 0 || v >= count; });
    if (bad != line.vertices.end()) {
      findings.Error("INVALID_LINE", findings.AtLine(k),
                     fmt::format("names vertex {}; must be in [0, {}]", *bad, count - 1));
      continue;
    }
    const auto placed = std::ranges::find_if(line.vertices, [&](int v) {
      return network.vertices[static_cast<std::size_t>(v)].on_edge.has_value();
    });
    if (placed != line.vertices.end()) {
      findings.Error(
          "INVALID_LINE", findings.AtLine(k),
          fmt::format("names vertex {}, which lies on an edge and has no place before the edge has; "
                      "end the line there with an edge of its own",
                      *placed));
      continue;
    }
    std::vector<Vec3> points;
    for (const int v : line.vertices)
      points.push_back(network.vertices[static_cast<std::size_t>(v)].position);
    // Its vertex has a finding already.
    if (!std::ranges::all_of(points, [](const Vec3& p) { return p.allFinite(); })) continue;
    const bool ends =
        line.start.direction || line.start.curvature || line.end.direction || line.end.curvature;
    if (line.closed && ends) {
      findings.Error("INVALID_LINE", findings.AtLine(k),
                     "is closed and has a direction or a curvature at an end; a closed line has no end");
      continue;
    }
    const auto spline =
        ends ? SplineWithEnds(points, line.start, line.end) : SplineThrough(points, line.closed);
    if (!spline.ok()) {
      findings.Error("INVALID_LINE", findings.AtLine(k),
                     fmt::format("has no spline: {}", std::string(spline.status().message())));
      continue;
    }
    for (std::size_t i = 0; i < spline->size(); ++i) {
      const int to = line.vertices[(i + 1) % line.vertices.size()];
      whole.edges.push_back({"", line.vertices[i], to, CurveEdge{(*spline)[i]}, line.crease, k});
    }
  }
  return whole;
}

}  // namespace patchmill
