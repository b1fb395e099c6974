// Turned parts as CAD files give them: each profile is a face, or two of half a turn.
#pragma once

#include "tests/support/profiles.h"

namespace patchmill::testing {

struct TurnedFace {
  Profile profile;
  SurfaceKind kind = SurfaceKind::kPlane;
  double radius = 0.0;  // as ModelFace::radius
  bool hollow = false;
  bool halves = false;  // two faces of half a turn
};

// The faces are "f1", "f2" and so on. A profile that goes up has its air outside.
inline PatchModel TurnedPart(const std::vector<TurnedFace>& faces) {
  std::vector<Profile> profiles;
  for (const TurnedFace& face : faces) profiles.push_back(face.profile);
  PatchModel model = Turned(profiles);
  for (std::size_t k = 0; k < faces.size(); ++k) {
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
      if (quarter == 0 || (quarter == 2 && faces[k].halves)) {
        ModelFace face;
        face.id = "f" + std::to_string(model.faces.size() + 1);
        face.kind = faces[k].kind;
        face.radius = faces[k].radius;
        face.hollow = faces[k].hollow;
        model.faces.push_back(face);
      }
      model.patches[4 * k + quarter].face = FaceId(model.faces.size() - 1);
    }
  }
  return model;
}

// The wall of a hole of this radius, from the height `top` down to `bottom`.
inline TurnedFace Bore(double radius, double top, double bottom) {
  return {Line({radius, top}, {radius, bottom}), SurfaceKind::kCylinder, radius, true};
}
// The wall of a pin.
inline TurnedFace Pin(double radius, double bottom, double top) {
  return {Line({radius, bottom}, {radius, top}), SurfaceKind::kCylinder, radius};
}
// A level ring from one radius to another: it looks up if it goes inwards.
inline TurnedFace Ring(double from, double to, double z) { return {Line({from, z}, {to, z})}; }

}  // namespace patchmill::testing
