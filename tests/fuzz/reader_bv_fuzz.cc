// libFuzzer: any bytes into the .bv reader. Build with the preset `fuzz`; seeds in tests/models and examples.
#include "core/io/bv.h"
#include "tests/fuzz/reader_contract.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  patchmill::Diagnostics remarks;
  if (!patchmill::KeepsReaderContract(text, patchmill::ReadBv(text, &remarks))) __builtin_trap();
  if (remarks.size() > 1) __builtin_trap();
  return 0;
}
