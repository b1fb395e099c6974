// Reads tools from files: Patchmill's own JSON, Fusion's tool libraries, FreeCAD's tool bits, LinuxCNC's tool
// tables.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "patchmill/v1/tool.pb.h"

namespace patchmill::cli {

// A tool of a file. Lengths are in mm; what the file does not state is not set.
struct FileTool {
  v1::Tool tool;
  std::string shape;  // if it is no ball end: its shape in the words of the file
};

// Reads all tools of a file, by its content; `name` decides only that *.tbl is a tool table. A table states
// no shapes: its tools count as ball ends. Lengths of a table are mm. INVALID_ARGUMENT if it is none of
// these.
absl::StatusOr<std::vector<FileTool>> ReadTools(std::string_view text, const std::string& name);

// Reads the tool that --tool names: "FILE", or "FILE:NUMBER" where the file has several ball ends.
// INVALID_ARGUMENT lists the tools there are.
absl::StatusOr<v1::Tool> ReadToolFile(const std::string& named);

}  // namespace patchmill::cli
