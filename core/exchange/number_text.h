// Numbers as IGES and STEP write them.
#pragma once

#include <string>

#include <fmt/format.h>

namespace patchmill {

// The shortest text that reads back as the same value, with a decimal point and a large E: 2., -1.5E-7.
inline std::string RealText(double x) {
  std::string text = fmt::format("{}", x);
  const std::size_t e = text.find('e');
  if (text.find('.') == std::string::npos) text.insert(e == std::string::npos ? text.size() : e, 1, '.');
  if (const std::size_t at = text.find('e'); at != std::string::npos) text[at] = 'E';
  return text;
}

}  // namespace patchmill
