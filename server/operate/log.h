// The log of the server: one line on stderr for each event, as text or as JSON.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace patchmill {

enum class LogLevel { kInfo, kWarning, kError };
enum class LogFormat { kText, kJson };

using LogValue = std::variant<std::string, double, std::int64_t>;
using LogFields = std::vector<std::pair<const char*, LogValue>>;

// Call it before other threads start. Default: text.
void SetLogFormat(LogFormat format);

// Writes a line: time with its zone, level, message, fields. Fields that are empty strings are left out.
//   2026-11-30T22:17:05.123+01:00 info call ends: call=17 method=CheckModel code=OK seconds=0.012
//   {"time":"...","level":"info","message":"call ends","call":17,"method":"CheckModel","code":"OK",...}
void Log(LogLevel level, std::string_view message, const LogFields& fields = {});

// The line without its time, as Log writes it.
std::string LogLine(LogFormat format, LogLevel level, std::string_view message, const LogFields& fields);

}  // namespace patchmill
