// libFuzzer: any bytes as a tool file, JSON and table. What is read has numbers that a request may carry.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "clients/cli/tool_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace patchmill::cli;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const char* name : {"tool.json", "tool.tbl"}) {
    const auto tools = ReadTools(text, name);
    if (!tools.ok()) continue;
    for (const FileTool& read : *tools) {
      if (!read.shape.empty()) continue;
      if (!read.tool.has_ball_end()) __builtin_trap();
      const std::string wire = read.tool.SerializeAsString();
      patchmill::v1::Tool again;
      if (!again.ParseFromString(wire)) __builtin_trap();
    }
  }
  return 0;
}
