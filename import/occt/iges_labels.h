// What an IGES file says of the shapes made from it.
#pragma once

#include <IGESControl_Reader.hxx>

#include "import/occt/read_file.h"

namespace patchmill {

// After the transfer: fills labels, hidden faces and lost faces of the file, whose shape is complete.
void ReadIgesLabels(IGESControl_Reader& reader, CadFile& file);

}  // namespace patchmill
