// libFuzzer: any bytes into the .bez reader. Build with the preset `fuzz`; seeds in tests/models and
// examples.
#include "core/io/bez.h"
#include "tests/fuzz/reader_contract.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (!patchmill::KeepsReaderContract(text, patchmill::ReadBez(text))) __builtin_trap();
  return 0;
}
