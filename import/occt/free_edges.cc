#include "import/occt/free_edges.h"

#include <BRep_Tool.hxx>
#include <NCollection_IndexedDataMap.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS.hxx>

namespace patchmill {

int CountFreeEdges(const TopoDS_Shape& shape) {
  NCollection_IndexedDataMap<TopoDS_Shape, int, TopTools_ShapeMapHasher> uses;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) {
    for (TopExp_Explorer it(face.Current(), TopAbs_EDGE); it.More(); it.Next()) {
      const TopAbs_Orientation side = it.Current().Orientation();
      if (side != TopAbs_FORWARD && side != TopAbs_REVERSED) continue;
      if (BRep_Tool::Degenerated(TopoDS::Edge(it.Current()))) continue;
      if (int* known = uses.ChangeSeek(it.Current()); known != nullptr) {
        ++*known;
      } else {
        uses.Add(it.Current(), 1);
      }
    }
  }
  int free_edges = 0;
  for (int k = 1; k <= uses.Extent(); ++k) free_edges += uses(k) == 1 ? 1 : 0;
  return free_edges;
}

}  // namespace patchmill
