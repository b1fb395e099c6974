// libFuzzer: any bytes into the program reader, in the dialect that the first byte chooses. Build with the
// preset `fuzz`; seeds in tests/golden and tests/golden/posts.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "cam/post/dialect.h"
#include "cam/post/program_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  patchmill::ReaderParams params;
  params.max_moves = 20'000;
  params.dialect = patchmill::Dialects()[data[0] % patchmill::Dialects().size()];
  const auto motion =
      patchmill::ReadProgram(std::string_view(reinterpret_cast<const char*>(data) + 1, size - 1), params);
  if (motion.ok()) {
    for (const patchmill::ProgramMove& move : motion->moves) {
      if (!move.from.allFinite() || !move.to.allFinite()) __builtin_trap();
    }
  } else if (motion.status().message().substr(0, 5) != "line ") {
    __builtin_trap();
  }
  return 0;
}
