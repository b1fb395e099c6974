// Writes the triangles of a surface as files for printers and viewers. No path is planned on them.
#pragma once

#include <string>
#include <vector>

#include "core/surface/surface_mesh.h"

namespace patchmill {

// Binary STL: 84 bytes and 50 per triangle, corners anticlockwise from the side of the normals. Coordinates
// are in mm and rounded to single precision. Triangles whose corners coincide then are left out.
std::string StlBytes(const std::vector<PieceTriangles>& mesh);

// Wavefront OBJ in mm, with the normals of the surface: one object per piece, numbers with seven decimals.
std::string ObjText(const std::vector<PieceTriangles>& mesh);

}  // namespace patchmill
