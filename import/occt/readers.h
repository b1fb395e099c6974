// The two readers behind ReadCadFile.
#pragma once

#include <string_view>

#include <Interface_Static.hxx>
#include <TopExp_Explorer.hxx>
#include <absl/status/status.h>

#include "import/occt/read_file.h"

namespace patchmill {

inline bool HasFace(const TopoDS_Shape& shape) {
  return !shape.IsNull() && TopExp_Explorer(shape, TopAbs_FACE).More();
}

// Takes `search()` for the file's shape where its roots have given no face.
template <class Search>
void SearchWithoutRoots(CadFile& file, const Search& search) {
  if (HasFace(file.shape)) return;
  const TopoDS_Shape found = search();
  if (!HasFace(found) && !file.shape.IsNull()) return;
  file.shape = found;
  file.searched = true;
}

// What both formats are read with: millimetres, and the precision that the file states. One file a process.
inline void SetReaderParameters() {
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  Interface_Static::SetIVal("read.precision.mode", 0);
  Interface_Static::SetIVal("read.maxprecision.mode", 0);
  Interface_Static::SetIVal("read.surfacecurve.mode", 0);
}

// Fill everything but `sewing`, "wires" and "points". INVALID_ARGUMENT for what cannot be read or has no
// shape. May throw Standard_Failure.
absl::Status ReadStep(std::string_view content, CadFile& file);
absl::Status ReadIges(std::string_view content, CadFile& file);

}  // namespace patchmill
