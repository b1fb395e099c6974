// libFuzzer: any bytes into the reader of polygon meshes, .obj. Build with the preset `fuzz`.
#include <cstdint>

#include "core/io/obj.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto mesh = patchmill::ReadObj({reinterpret_cast<const char*>(data), size});
  if (!mesh.ok()) return 0;
  if (mesh->faces.empty()) __builtin_trap();
  for (const auto& face : mesh->faces) {
    if (face.size() != 3 && face.size() != 4) __builtin_trap();
    for (const int corner : face) {
      if (corner < 0 || static_cast<std::size_t>(corner) >= mesh->points.size()) __builtin_trap();
    }
  }
  return 0;
}
