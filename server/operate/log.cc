#include "server/operate/log.h"

#include <cmath>
#include <memory>

#include <absl/time/clock.h>
#include <absl/time/time.h>
#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace patchmill {
namespace {

LogFormat& Format() {
  static LogFormat format = LogFormat::kText;
  return format;
}

spdlog::logger& Lines() {
  static const auto* const logger = [] {
    auto* made = new std::shared_ptr<spdlog::logger>(spdlog::stderr_logger_mt("patchmill"));
    (*made)->set_pattern("%v");
    return made;
  }();
  return **logger;
}

const char* NameOf(LogLevel level) {
  switch (level) {
    case LogLevel::kInfo:
      return "info";
    case LogLevel::kWarning:
      return "warning";
    case LogLevel::kError:
      return "error";
  }
  return "error";
}

// Nothing that comes from outside can end a line, or begin a string of its own. Other bytes than those of
// printable ASCII become question marks.
std::string Quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c < ' ' || c > '~' ? '?' : c;
  }
  return quoted + '"';
}

// JSON has no word for what is not finite.
std::string NumberText(const LogValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  const double number = std::get<double>(value);
  if (!std::isfinite(number)) return "null";
  const bool is_whole = number == std::floor(number) && std::abs(number) < 1e15;
  return is_whole ? fmt::format("{:.0f}", number) : fmt::format("{:.6g}", number);
}

bool IsWord(std::string_view text) {
  return text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.:/%[]@+") ==
         text.npos;
}

std::string ValueText(LogFormat format, const LogValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  if (text == nullptr) return NumberText(value);
  return format == LogFormat::kText && IsWord(*text) ? *text : Quoted(*text);
}

std::string OneLineOf(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    if (c < ' ' || c > '~') c = '?';
  }
  return line;
}

bool IsEmpty(const LogValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text != nullptr && text->empty();
}

}  // namespace

void SetLogFormat(LogFormat format) { Format() = format; }

std::string LogLine(LogFormat format, LogLevel level, std::string_view message, const LogFields& fields) {
  const bool json = format == LogFormat::kJson;
  std::string line = json ? fmt::format("\"level\":\"{}\",\"message\":{}", NameOf(level), Quoted(message))
                          : fmt::format("{} {}", NameOf(level), OneLineOf(message));
  bool first = true;
  for (const auto& [name, value] : fields) {
    if (IsEmpty(value)) continue;
    line += json ? fmt::format(",\"{}\":", name) : fmt::format("{}{}=", first ? ": " : " ", name);
    line += ValueText(format, value);
    first = false;
  }
  return line;
}

void Log(LogLevel level, std::string_view message, const LogFields& fields) {
  const std::string time = absl::FormatTime("%Y-%m-%dT%H:%M:%E3S%Ez", absl::Now(), absl::LocalTimeZone());
  const std::string rest = LogLine(Format(), level, message, fields);
  Lines().info("{}", Format() == LogFormat::kJson ? fmt::format("{{\"time\":\"{}\",{}}}", time, rest)
                                                  : fmt::format("{} {}", time, rest));
}

}  // namespace patchmill
