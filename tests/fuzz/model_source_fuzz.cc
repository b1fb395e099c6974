// Models as JSON and as binary messages. The first byte picks the format.
#include <cstdint>
#include <cstdlib>

#include "tests/fuzz/model_source_contract.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static constexpr const char* kFormats[] = {"json", "pb", ""};
  const std::string content(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (!patchmill::KeepsModelSourceContract(kFormats[data[0] % 3], content)) std::abort();
  return 0;
}
