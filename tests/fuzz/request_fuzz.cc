// The requests of all RPCs (request_contract.h).
#include <cstddef>
#include <cstdint>
#include <string>

#include "tests/fuzz/request_contract.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  patchmill::testing::CheckAnyRequest(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
