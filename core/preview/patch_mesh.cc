#include "core/preview/patch_mesh.h"

#include <optional>

#include "core/diffgeo/forms.h"

namespace patchmill {

namespace {

// The normal at a place; at a pole that of the surface beside it.
std::optional<Vec3> NormalAt(const PatchShape& shape, const Vec2& uv, const SurfaceJet& jet) {
  constexpr double kBeside = 1e-6;  // share of the way to the middle of the patch
  if (const std::optional<Vec3> normal = UnitNormal(jet)) return normal;
  const Vec2 middle = Vec2::Constant(IsTriangle(shape) ? 1.0 / 3.0 : 0.5);
  const Vec2 beside = uv + kBeside * (middle - uv);
  return UnitNormal(Evaluate(shape, beside.x(), beside.y()));
}

}  // namespace

PatchMesh MeshOf(const PatchShape& shape, int cells) {
  const bool triangle = IsTriangle(shape);
  PatchMesh mesh;
  const auto row = [&](int i) { return triangle ? cells - i : cells; };  // steps along v at step i of u
  std::vector<int> first;                                                // place of each row
  for (int i = 0; i <= cells; ++i) {
    first.push_back(static_cast<int>(mesh.places.size()));
    for (int j = 0; j <= row(i); ++j) {
      const Vec2 uv(static_cast<double>(i) / cells, static_cast<double>(j) / cells);
      const SurfaceJet jet = Evaluate(shape, uv.x(), uv.y());
      mesh.places.push_back(jet.p);
      mesh.normals.push_back(NormalAt(shape, uv, jet).value_or(Vec3::Zero()));
    }
  }
  for (int i = 0; i < cells; ++i) {
    const int here = first[static_cast<std::size_t>(i)], next = first[static_cast<std::size_t>(i) + 1];
    for (int j = 0; j < row(i); ++j) {
      mesh.corners.push_back({here + j, next + j, here + j + 1});
      if (j < row(i + 1)) mesh.corners.push_back({next + j, next + j + 1, here + j + 1});
    }
  }
  return mesh;
}

}  // namespace patchmill
