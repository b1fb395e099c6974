// A CAD file as the importer has read it.
#pragma once

#include <string>

#include "core/base/diagnostic.h"
#include "core/brep/brep_model.h"

namespace patchmill {

// What the file says of itself.
struct FileFacts {
  std::string schema, length_unit, written_by;
  Diagnostics findings;  // of the reader
};

struct ImportedPart {
  BrepModel model;
  FileFacts facts;
};

}  // namespace patchmill
