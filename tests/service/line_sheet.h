// A sheet of lines as a network on the wire.
#pragma once

#include "patchmill/v1/model.pb.h"
#include "server/convert/model.h"
#include "tests/core/joining/networks.h"

namespace patchmill::testing {

// side x side vertices (LineSheet) with lines, G2-Gregory faces, in the given unit.
inline v1::PatchModel SheetModel(int side, v1::LengthUnit unit = v1::LENGTH_UNIT_MILLIMETER) {
  const CurveNetwork network = LineSheet(1, side, side);
  v1::PatchModel model;
  model.set_length_unit(unit);
  for (const NetworkVertex& vertex : network.vertices) {
    auto* to = model.mutable_network()->add_vertices();
    for (int k = 0; k < 3; ++k) to->add_position(vertex.position[k] / *MillimetersPer(unit));
  }
  for (const NetworkFace& face : network.faces) {
    auto* to = model.mutable_network()->add_faces();
    to->mutable_vertices()->Add(face.vertices.begin(), face.vertices.end());
    to->set_scheme(v1::PATCH_SCHEME_G2_GREGORY);
  }
  for (const NetworkLine& line : network.lines) {
    model.mutable_network()->add_lines()->mutable_vertices()->Add(line.vertices.begin(), line.vertices.end());
  }
  return model;
}

}  // namespace patchmill::testing
