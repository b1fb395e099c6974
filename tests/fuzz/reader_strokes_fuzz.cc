// libFuzzer: any bytes into the reader of strokes, .curves. Build with the preset `fuzz`.
#include <cstdint>

#include "core/io/strokes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto strokes = patchmill::ReadStrokes({reinterpret_cast<const char*>(data), size});
  if (!strokes.ok()) return 0;
  if (strokes->empty()) __builtin_trap();
  for (const auto& stroke : *strokes) {
    if (stroke.empty()) __builtin_trap();
    for (const patchmill::Vec3& p : stroke) {
      if (!p.allFinite()) __builtin_trap();
    }
  }
  return 0;
}
