// Labels of the shapes that were made from the entities of a file.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <Standard_Handle.hxx>
#include <Standard_Transient.hxx>
#include <Transfer_TransientProcess.hxx>

#include "import/occt/read_file.h"
#include "import/occt/shape_labels.h"

namespace patchmill {

// Labels faces, shells and solids with what `label_of` says of the entity that became them. Faces that are
// parts of a larger result have its label, unless they have their own. Only entities that `wanted` accepts.
void LabelShapes(const Transfer_TransientProcess& transfer,
                 const std::function<ShapeLabel(const Handle(Standard_Transient) &)>& label_of,
                 const std::function<bool(const Handle(Standard_Transient) &)>& wanted, ShapeLabels& labels);

// Those of the faces (number, whether it is to be seen) that no face of the file's shape comes from.
std::vector<std::int64_t> LostFaces(const std::vector<std::pair<std::int64_t, bool>>& faces,
                                    const CadFile& file);

// From parts in [0,1].
std::uint32_t PackRgb(double red, double green, double blue);

}  // namespace patchmill
