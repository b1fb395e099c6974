#include "core/network/model_face.h"

#include <fmt/format.h>

namespace patchmill {

const char* Name(SurfaceKind kind) {
  switch (kind) {
    case SurfaceKind::kUnknown:
      return "unknown";
    case SurfaceKind::kPlane:
      return "plane";
    case SurfaceKind::kCylinder:
      return "cylinder";
    case SurfaceKind::kCone:
      return "cone";
    case SurfaceKind::kSphere:
      return "sphere";
    case SurfaceKind::kTorus:
      return "torus";
    case SurfaceKind::kSpline:
      return "spline";
  }
  return "";
}

std::string Title(const ModelFace& face) {
  return face.name.empty() ? face.id : fmt::format("{} ({})", face.id, face.name);
}

}  // namespace patchmill
