// libFuzzer: any bytes into the program reader. Build with the preset `fuzz`; seeds in tests/golden/*.ngc.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "cam/post/program_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  patchmill::ReaderParams params;
  params.max_moves = 20'000;
  const auto motion =
      patchmill::ReadProgram(std::string_view(reinterpret_cast<const char*>(data), size), params);
  if (motion.ok()) {
    for (const patchmill::ProgramMove& move : motion->moves) {
      if (!move.from.allFinite() || !move.to.allFinite()) __builtin_trap();
    }
  } else if (motion.status().message().substr(0, 5) != "line ") {
    __builtin_trap();
  }
  return 0;
}
