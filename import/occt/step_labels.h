// What a STEP file says of the shapes made from it.
#pragma once

#include <STEPControl_Reader.hxx>

#include "import/occt/read_file.h"

namespace patchmill {

// After the transfer: fills labels and lost faces of the file, whose shape is complete. A body without a name
// of its own gets that of its product.
void ReadStepLabels(STEPControl_Reader& reader, CadFile& file);

}  // namespace patchmill
