#include "cam/post/post_template.h"

#include <utility>

#include <fmt/format.h>

namespace patchmill {
namespace {

constexpr std::array<std::pair<std::string_view, std::string PostValues::*>, 12> kPlaceholders = {{
    {"program", &PostValues::program},
    {"work_offset", &PostValues::work_offset},
    {"tool", &PostValues::tool},
    {"speed", &PostValues::speed},
    {"coolant", &PostValues::coolant},
    {"path", &PostValues::path},
    {"tolerance", &PostValues::tolerance},
    {"x", &PostValues::x},
    {"y", &PostValues::y},
    {"z", &PostValues::z},
    {"unit", &PostValues::unit},
    {"machine_top", &PostValues::top},
}};

std::string PostValues::*MemberOf(std::string_view name) {
  for (const auto& [known, member] : kPlaceholders) {
    if (known == name) return member;
  }
  return nullptr;
}

std::string Known() {
  std::string list = "{header}";
  for (const auto& [name, member] : kPlaceholders) list += fmt::format(", {{{}}}", name);
  return list;
}

}  // namespace

absl::Status CheckTemplate(std::string_view line) {
  if (line == kHeaderLine) return absl::OkStatus();
  for (std::size_t at = 0; (at = line.find_first_of("{}", at)) != std::string_view::npos;) {
    const std::size_t end = line.find_first_of("{}", at + 1);
    if (line[at] == '}' || end == std::string_view::npos || line[end] == '{')
      return absl::InvalidArgumentError("a brace without its other one");
    const std::string_view name = line.substr(at + 1, end - at - 1);
    if (name == "header") return absl::InvalidArgumentError("{header} must stand alone on its line");
    if (MemberOf(name) == nullptr) {
      return absl::InvalidArgumentError(
          fmt::format("{{{}}} is not a placeholder; there are {}", name.substr(0, 40), Known()));
    }
    at = end + 1;
  }
  return absl::OkStatus();
}

std::optional<std::string> FillTemplate(std::string_view line, const PostValues& values) {
  std::string filled;
  while (!line.empty()) {
    const std::size_t at = line.find('{');
    filled += line.substr(0, at);
    if (at == std::string_view::npos) break;
    const std::size_t end = line.find('}', at);
    const std::string& value = values.*MemberOf(line.substr(at + 1, end - at - 1));
    if (value.empty()) return std::nullopt;
    filled += value;
    line.remove_prefix(end + 1);
  }
  return filled;
}

}  // namespace patchmill
