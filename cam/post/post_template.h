// The placeholders in the lines of a post file, and their values.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <absl/status/status.h>

namespace patchmill {

// The values of the placeholders. A line with a placeholder whose value is empty is left out.
struct PostValues {
  std::string program;      // number, four digits
  std::string work_offset;  // "G54"
  std::string tool;         // number
  std::string speed;        // 1/min
  std::string coolant, path, tolerance;
  std::string x, y, z;  // first position of the tip
  std::string unit;     // "G21"
  std::string top;      // machine_top
};

// {header} stands alone on its line, for the comments.
inline constexpr std::string_view kHeaderLine = "{header}";

// INVALID_ARGUMENT, without the line number, for a placeholder that does not exist, for one without its
// closing brace, and for {header} beside other text.
absl::Status CheckTemplate(std::string_view line);

// The line with its values; absent if one of them is empty. The line has passed CheckTemplate.
std::optional<std::string> FillTemplate(std::string_view line, const PostValues& values);

}  // namespace patchmill
