// A picture of a model's faces, each with its id.
#pragma once

#include <string>
#include <vector>

#include "core/surface/face_figures.h"
#include "core/surface/surface.h"

namespace patchmill {

// An SVG as DrawPreview draws it. Faces have the colours of the file, or pale ones where it gives none, or
// one for all. Edges between faces are drawn; edges inside a face are not.
std::string DrawFaces(const Surface& surface, const std::vector<FaceFigures>& figures,
                      const std::string& title);

}  // namespace patchmill
