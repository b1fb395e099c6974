// The edges of a shape, each once.
#pragma once

#include <cstddef>
#include <vector>

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <absl/status/statusor.h>

#include "core/base/index.h"
#include "core/brep/brep_model.h"
#include "import/occt/curves.h"

namespace patchmill {

struct TableEdge {
  absl::Status status;             // why it cannot be used
  CurvePart part;                  // without points for a degenerate edge
  double first = 0.0, last = 1.0;  // range of the edge in the parameters of Open CASCADE
  bool degenerate = false;
};

// Faces that meet along an edge find the same number for it. Numbers follow the order of the questions, so
// that they do not depend on addresses.
class EdgeTable {
 public:
  int NumberOf(const TopoDS_Edge& edge);
  const TableEdge& edge(int number) const { return edges_[At(number)]; }

  // Edges that cannot be used are degenerate there, and no face has them.
  std::vector<BrepEdge> Edges() const;

 private:
  TableEdge Read(const TopoDS_Edge& edge);

  TopTools_IndexedMapOfShape edge_map_;
  std::vector<TableEdge> edges_;
};

}  // namespace patchmill
