#include "server/operate/serve_words.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include <absl/strings/ascii.h>
#include <absl/strings/str_split.h>
#include <fmt/format.h>

#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr std::string_view kPrefix = "PATCHMILLD_";
constexpr std::size_t kMaxConfigBytes = std::size_t{1} << 20;

class Collector {
 public:
  Collector(std::vector<std::string> words, const std::vector<ServeOption>& options) : options_(options) {
    collected_.words = std::move(words);
  }

  // An option that stands in the words already keeps its value. `place` is for messages.
  absl::Status Add(const std::string& name, const std::string& value, const std::string& place) {
    const auto option =
        std::find_if(options_.begin(), options_.end(), [&](const ServeOption& o) { return o.name == name; });
    if (option == options_.end()) {
      return absl::InvalidArgumentError(
          fmt::format("{}: there is no option --{}; patchmilld --help lists all", place, name));
    }
    if (value.empty())
      return absl::InvalidArgumentError(fmt::format("{}: has no value for --{}", place, name));
    if (option->is_flag && value != "true" && value != "false") {
      return absl::InvalidArgumentError(
          fmt::format("{}: --{} = {}; must be true or false", place, name, value));
    }
    if (Given(name)) return absl::OkStatus();
    if (!option->is_flag) {
      collected_.words.push_back(fmt::format("--{}={}", name, value));
    } else if (value == "true") {
      collected_.words.push_back("--" + name);
    }
    collected_.origin["--" + name] = place;
    return absl::OkStatus();
  }

  // The file of --config; empty without one.
  std::string File() const {
    for (std::size_t k = 0; k < collected_.words.size(); ++k) {
      const std::string& word = collected_.words[k];
      if (word.starts_with("--config=")) return word.substr(9);
      if (word == "--config" && k + 1 < collected_.words.size()) return collected_.words[k + 1];
    }
    return {};
  }

  absl::Status AddFile(const std::string& path) {
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (!in) {
      return absl::InvalidArgumentError(
          fmt::format("--config {}: cannot be read: {}", path, std::strerror(errno)));
    }
    std::string text(kMaxConfigBytes, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (in.bad()) {
      return absl::InvalidArgumentError(
          fmt::format("--config {}: cannot be read: {}", path, std::strerror(errno)));
    }
    text.resize(static_cast<std::size_t>(in.gcount()));
    std::map<std::string, int> lines;
    int number = 0;
    for (absl::string_view line : absl::StrSplit(text, '\n')) {
      ++number;
      line = absl::StripAsciiWhitespace(line);
      if (line.empty() || line.front() == '#') continue;
      const std::string place = fmt::format("{}, line {}", path, number);
      const std::size_t equals = line.find('=');
      if (equals == line.npos) {
        return absl::InvalidArgumentError(
            fmt::format("{}: is no \"option = value\" and no comment with #", place));
      }
      const std::string name(absl::StripAsciiWhitespace(line.substr(0, equals)));
      const auto [before, is_new] = lines.emplace(name, number);
      if (!is_new) {
        return absl::InvalidArgumentError(
            fmt::format("{}: {} stands in line {} already", place, name, before->second));
      }
      PM_RETURN_IF_ERROR(Add(name, std::string(absl::StripAsciiWhitespace(line.substr(equals + 1))), place));
    }
    return absl::OkStatus();
  }

  ServeWords End() { return std::move(collected_); }

 private:
  bool Given(const std::string& name) const {
    const std::string dashed = "--" + name;
    return collected_.origin.contains(dashed) ||
           std::any_of(collected_.words.begin(), collected_.words.end(), [&](const std::string& word) {
             return word == dashed || word.starts_with(dashed + "=");
           });
  }

  const std::vector<ServeOption>& options_;
  ServeWords collected_;
};

}  // namespace

std::string EnvironmentName(const std::string& option) {
  std::string name(kPrefix);
  for (const char c : option) name += c == '-' ? '_' : absl::ascii_toupper(static_cast<unsigned char>(c));
  return name;
}

absl::StatusOr<ServeWords> CollectServeWords(std::vector<std::string> words,
                                             const std::vector<ServeOption>& options,
                                             const std::vector<std::string>& environment) {
  Collector collector(std::move(words), options);
  for (const std::string& variable : environment) {
    if (!variable.starts_with(kPrefix)) continue;
    const std::size_t equals = variable.find('=');
    const std::string name = variable.substr(0, equals);
    std::string option = absl::AsciiStrToLower(name.substr(kPrefix.size()));
    std::replace(option.begin(), option.end(), '_', '-');
    const std::string value = equals == variable.npos ? "" : variable.substr(equals + 1);
    PM_RETURN_IF_ERROR(collector.Add(option, value, name));
  }
  if (const std::string file = collector.File(); !file.empty()) PM_RETURN_IF_ERROR(collector.AddFile(file));
  return collector.End();
}

}  // namespace patchmill
