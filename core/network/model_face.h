// Faces: what a person calls one surface of a part. A CAD file trims each face by its edges; the importer
// cuts it into several patches.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace patchmill {

enum class SurfaceKind { kUnknown, kPlane, kCylinder, kCone, kSphere, kTorus, kSpline };
constexpr SurfaceKind LastOf(SurfaceKind) { return SurfaceKind::kSpline; }
const char* Name(SurfaceKind kind);  // "plane"; "unknown"

struct ModelFace {
  std::string id;                    // "f12": unique in the model, not empty
  std::string name, body, layer;     // as the file has them; not unique, may be empty
  std::optional<std::uint32_t> rgb;  // 0xRRGGBB
  SurfaceKind kind = SurfaceKind::kUnknown;
  double radius = 0.0;      // mm: of a cylinder, a sphere, the tube of a torus; else 0
  bool hollow = false;      // the surface of revolution surrounds air: a drill hole, a fillet in a corner
  std::int64_t entity = 0;  // number of the face in the file; 0 unknown
  // Not read: its patches are a box that holds it. The tool keeps off the box, and none of it is finished.
  bool skipped = false;
};

// "f12 (pocket floor)", or "f12" without a name.
std::string Title(const ModelFace& face);

}  // namespace patchmill
