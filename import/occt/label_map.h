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

using Entity = Handle(Standard_Transient);  // of a file

// The entity as one of a kind; null if it is none.
template <class Kind>
Handle(Kind) As(const Entity& entity) {
  return Handle(Kind)::DownCast(entity);
}

// Labels faces, shells and solids with what `label_of` says of the entity that became them. Faces that are
// parts of a larger result have its label, unless they have their own. Only entities that `wanted` accepts.
void LabelShapes(const Transfer_TransientProcess& transfer,
                 const std::function<ShapeLabel(const Entity&)>& label_of,
                 const std::function<bool(const Entity&)>& wanted, ShapeLabels& labels);

// Those of the faces (number, whether it is to be seen) that no face of the file's shape comes from.
std::vector<std::int64_t> LostFaces(const std::vector<std::pair<std::int64_t, bool>>& faces,
                                    const CadFile& file);

// From parts in [0,1].
std::uint32_t PackRgb(double red, double green, double blue);

}  // namespace patchmill
