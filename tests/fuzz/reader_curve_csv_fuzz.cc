// libFuzzer: any bytes into the reader of curve points, .csv. Build with the preset `fuzz`; seeds in
// tests/models/curves.
#include "tests/fuzz/curve_points_contract.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (!patchmill::KeepsCurvePointsContract(text, patchmill::ReadCurvePoints("csv", text))) __builtin_trap();
  return 0;
}
