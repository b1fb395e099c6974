#include "import/occt/edge_table.h"

#include <utility>

#include <BRepLib.hxx>
#include <BRep_Tool.hxx>
#include <Standard_Failure.hxx>
#include <TopoDS.hxx>
#include <absl/status/status.h>

#include "import/occt/failures.h"

namespace patchmill {
namespace {

// An edge whose curve stays within this, mm, is one point.
constexpr double kPointSize = 1e-7;

bool IsPoint(const BrepCurve& curve) {
  Box3 box;
  for (const Vec3& p : curve.points) box.Add(p);
  return box.Diagonal() < kPointSize;
}

}  // namespace

int EdgeTable::NumberOf(const TopoDS_Edge& edge) {
  if (const int known = edge_map_.FindIndex(edge); known > 0) return known - 1;
  const int number = edge_map_.Add(edge) - 1;
  // The place is taken first: numbers must fit even if reading ends with an exception.
  edges_.emplace_back().status = absl::InvalidArgumentError("the edge could not be read");
  TableEdge read;
  try {
    read = Read(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)));
  } catch (const Standard_Failure& failure) {
    read.status = absl::InvalidArgumentError(TextOf(failure));
  }
  edges_[At(number)] = std::move(read);
  return number;
}

TableEdge EdgeTable::Read(const TopoDS_Edge& edge) {
  TableEdge read;
  Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, read.first, read.last);
  if (curve.IsNull() && !BRep_Tool::Degenerated(edge)) {
    BRepLib::BuildCurve3d(edge);
    curve = BRep_Tool::Curve(edge, read.first, read.last);
    if (curve.IsNull()) {
      read.status = absl::InvalidArgumentError("an edge has no curve in space");
      return read;
    }
  }
  if (BRep_Tool::Degenerated(edge)) {
    read.degenerate = true;
  } else {
    absl::StatusOr<CurvePart> part = CurveBetween(curve, read.first, read.last);
    if (!part.ok()) {
      read.status = part.status();
      return read;
    }
    read.part = *std::move(part);
    if (IsPoint(read.part.curve)) {
      read.degenerate = true;
      read.part.curve = {};
    }
  }
  return read;
}

std::vector<BrepEdge> EdgeTable::Edges() const {
  std::vector<BrepEdge> edges;
  edges.reserve(edges_.size());
  for (const TableEdge& e : edges_) {
    edges.push_back({e.part.curve, e.degenerate || !e.status.ok(), e.part.error});
  }
  return edges;
}

}  // namespace patchmill
