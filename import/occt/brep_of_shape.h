// A shape of Open CASCADE as a BrepModel.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <TopoDS_Shape.hxx>
#include <absl/status/statusor.h>

#include "core/base/vec.h"
#include "core/brep/brep_model.h"
#include "import/occt/shape_labels.h"

namespace patchmill {

// A face, or a body, that needs a remark.
struct ShapeFinding {
  // FACE_UNREADABLE: the face is in the model without loops. OFFSET_FOLDS, NEGATIVE_WEIGHT: the same, for
  // that reason. FACE_UNTRIMMED: it has fewer loops than in the file. FACE_OVERLAPS: its border covers more
  // than a whole turn of a closed surface, most often since edges lie on the wrong side of its seam.
  // FACE_SHARED: another body has it too; it is in the model once. INSIDE_OUT: a closed body was turned;
  // `face` is its first.
  std::string code;
  std::string reason;
  int face = 0;  // in BrepModel::faces
  std::int64_t entity = 0;
  Box3 box;  // mm, holds the face; empty where unknown
};

struct BrepOfShapeResult {
  BrepModel model;
  std::vector<ShapeFinding> findings;
  int hidden_faces = 0;  // left out, since the file says that they are not to be seen
};

// Bodies are solids, then shells and loose faces outside of them, each instance of an assembly one of its
// own. Within a body, faces are in the order of their numbers in the file, bodies in that of the shape.
// FAILED_PRECONDITION where the shape has no face. Does not throw for what Open CASCADE finds wrong.
absl::StatusOr<BrepOfShapeResult> BrepOfShape(const TopoDS_Shape& shape, const ShapeLabels& labels);

}  // namespace patchmill
