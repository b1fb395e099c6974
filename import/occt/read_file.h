// STEP and IGES files as shapes of Open CASCADE.
//
// One file a process: the readers keep settings and state in globals. They write to the standard output, and
// damaged files can crash them or make them hang.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <TopoDS_Shape.hxx>
#include <absl/status/statusor.h>

#include "import/occt/sew.h"
#include "import/occt/shape_labels.h"

namespace patchmill {

struct CadFile {
  TopoDS_Shape shape;  // mm
  ShapeLabels labels;

  // What the file says of itself; empty if nothing.
  std::string schema;      // "AUTOMOTIVE_DESIGN", "IGES 5.3"
  std::string unit;        // "INCH"
  std::string written_by;  // the program
  int root_count = 0;      // of those that gave a shape
  bool searched = false;   // there was no root: every body and face in the file was taken

  // What is no face, by kind: "wires", "points", "tessellated faces", "hidden faces".
  std::map<std::string, int> skipped;
  std::vector<std::string> external_files;  // that the file refers to, and that were not read
  std::vector<std::int64_t> lost_faces;     // numbers of faces in the file that gave none in the shape
  Sewing sewing;
};

// `format` is "step" or "iges". Loose faces are sewn. INVALID_ARGUMENT, one sentence, for what cannot be read
// or has no shape at all. Does not throw for what Open CASCADE finds wrong.
absl::StatusOr<CadFile> ReadCadFile(std::string_view content, std::string_view format);

}  // namespace patchmill
