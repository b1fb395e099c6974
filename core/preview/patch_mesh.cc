#include "core/preview/patch_mesh.h"

#include "core/diffgeo/forms.h"

namespace patchmill {

PatchMesh MeshOf(const PatchShape& shape, int cells) {
  const bool triangle = IsTriangle(shape);
  PatchMesh mesh;
  const auto row = [&](int i) { return triangle ? cells - i : cells; };  // steps along v at step i of u
  std::vector<int> first;                                                // place of each row
  for (int i = 0; i <= cells; ++i) {
    first.push_back(static_cast<int>(mesh.places.size()));
    for (int j = 0; j <= row(i); ++j) {
      const SurfaceJet jet = Evaluate(shape, static_cast<double>(i) / cells, static_cast<double>(j) / cells);
      mesh.places.push_back(jet.p);
      mesh.normals.push_back(UnitNormal(jet).value_or(Vec3::Zero()));
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
