#include "import/occt/sew.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>

#include "core/base/vec.h"
#include "import/occt/convert.h"
#include "import/occt/free_edges.h"

namespace patchmill {
namespace {

// In tolerances: a face that is narrower might get the edges of its neighbours on the other side.
constexpr double kLeastWidth = 4.0;

double Diagonal(const TopoDS_Shape& shape) {
  Box3 box;
  for (TopExp_Explorer it(shape, TopAbs_VERTEX); it.More(); it.Next()) {
    box.Add(ToVec3(BRep_Tool::Pnt(TopoDS::Vertex(it.Current()))));
  }
  return box.Diagonal();
}

double Area(const TopoDS_Shape& shape) {
  double area = 0.0;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    GProp_GProps figures;
    BRepGProp::SurfaceProperties(it.Current(), figures);
    area += std::abs(figures.Mass());
  }
  return area;
}

int CountFaces(const TopoDS_Shape& shape) {
  int count = 0;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) ++count;
  return count;
}

// About how wide a face is, mm: a narrow one's area over its length.
double WidthOf(const TopoDS_Shape& face) {
  GProp_GProps length;
  BRepGProp::LinearProperties(face, length);
  return length.Mass() > 0.0 ? 2.0 * Area(face) / length.Mass() : 0.0;
}

struct LooseFaces {
  std::vector<TopoDS_Shape> faces;
  std::vector<double> widths;  // [face], mm
};

LooseFaces FacesOf(const TopoDS_Shape& shape) {
  LooseFaces loose;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    loose.faces.push_back(it.Current());
    loose.widths.push_back(WidthOf(it.Current()));
  }
  return loose;
}

// Bodies that are solids, and everything else.
void Split(const TopoDS_Shape& shape, TopoDS_Compound& solids, TopoDS_Compound& rest) {
  BRep_Builder builder;
  builder.MakeCompound(solids);
  builder.MakeCompound(rest);
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) builder.Add(solids, it.Current());
  for (TopExp_Explorer it(shape, TopAbs_SHELL, TopAbs_SOLID); it.More(); it.Next()) {
    builder.Add(rest, it.Current());
  }
  for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SHELL); it.More(); it.Next()) {
    builder.Add(rest, it.Current());
  }
}

}  // namespace

Sewing SewLooseFaces(TopoDS_Shape& shape, ShapeLabels& labels) {
  TopoDS_Compound whole, loose;
  Split(shape, whole, loose);
  Sewing result;
  result.free_edges_before = result.free_edges_after = CountFreeEdges(loose);
  const int faces = CountFaces(loose);
  if (faces < 2 || result.free_edges_before == 0) return result;
  const double most = std::min(0.05, 1e-4 * Diagonal(loose)), area = Area(loose);
  const LooseFaces parts = FacesOf(loose);
  const BRep_Builder builder;
  TopoDS_Shape best;
  Handle(BRepBuilderAPI_Sewing) best_step;
  double last = 0.0;
  for (const double step : {1e-5, 1e-4, 1e-3, 1e-2, 0.05}) {
    const double tolerance = std::min(step, most);
    if (tolerance <= last) break;
    last = tolerance;
    const Handle(BRepBuilderAPI_Sewing) sewing = new BRepBuilderAPI_Sewing(tolerance);
    TopoDS_Compound narrow;
    builder.MakeCompound(narrow);
    int count = 0;
    for (std::size_t k = 0; k < parts.faces.size(); ++k) {
      if (parts.widths[k] < kLeastWidth * tolerance) {
        builder.Add(narrow, parts.faces[k]);
      } else {
        sewing->Add(parts.faces[k]);
        ++count;
      }
    }
    if (count < 2) break;
    sewing->Perform();
    if (sewing->SewedShape().IsNull() || CountFaces(sewing->SewedShape()) != count) break;
    TopoDS_Compound sewn;
    builder.MakeCompound(sewn);
    builder.Add(sewn, sewing->SewedShape());
    for (TopoDS_Iterator it(narrow); it.More(); it.Next()) builder.Add(sewn, it.Value());
    if (std::abs(Area(sewn) - area) > 1e-4 * area) break;
    const int free_edges = CountFreeEdges(sewn);
    if (free_edges >= result.free_edges_after) {
      if (best_step.IsNull()) continue;
      break;
    }
    result.free_edges_after = free_edges;
    result.tolerance = tolerance;
    best = sewn;
    best_step = sewing;
  }
  if (best_step.IsNull()) return result;
  for (TopExp_Explorer it(loose, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Shape made = best_step->ModifiedSubShape(it.Current());
    if (const ShapeLabel* label = labels.Find(it.Current()); label != nullptr && !made.IsNull()) {
      const ShapeLabel copy = *label;
      for (TopExp_Explorer part(made, TopAbs_FACE); part.More(); part.Next())
        labels.Set(part.Current(), copy);
    }
  }
  builder.Add(whole, best);
  shape = whole;
  return result;
}

}  // namespace patchmill
