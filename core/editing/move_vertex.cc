#include "core/editing/move_vertex.h"

#include <variant>

#include "core/base/index.h"

namespace patchmill {
namespace {

void MoveEnd(std::vector<Vec3>& points, bool first, const Vec3& by) {
  const std::size_t count = points.size(), moved = count >= 4 ? 2 : 1;
  for (std::size_t k = 0; k < moved; ++k) points[first ? k : count - 1 - k] += by;
}

struct EndMover {
  bool first;
  Vec3 by;

  void operator()(HermiteCurve& curve) const { (first ? curve.p0 : curve.p1) += by; }
  void operator()(BezierCurve& curve) const { MoveEnd(curve.points, first, by); }
  void operator()(BsplineCurve& curve) const { MoveEnd(curve.points, first, by); }
  void operator()(HosakaSegment& curve) const {
    if (first) curve.origin += by;
    curve.a += first ? Vec3(-by) : by;
  }
};

}  // namespace

void MoveVertexTo(CurveNetwork& network, int vertex, const Vec3& position) {
  const Vec3 by = position - network.vertices[At(vertex)].position;
  network.vertices[At(vertex)].position = position;
  for (NetworkEdge& edge : network.edges) {
    auto* given = std::get_if<CurveEdge>(&edge.shape);
    if (given == nullptr || (edge.start != vertex && edge.end != vertex)) continue;
    std::visit(EndMover{edge.start == vertex, by}, given->curve);
  }
}

}  // namespace patchmill
