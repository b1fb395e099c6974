#include "clients/cli/files_in_json.h"

#include <absl/strings/ascii.h>
#include <absl/strings/escaping.h>
#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/wrappers.pb.h>

#include "clients/cli/input_file.h"

namespace patchmill::cli {
namespace {

constexpr std::string_view kFileKey = "\"file\"";
constexpr std::string_view kJsonBlanks = " \t\r\n";

// The place just behind the string that begins at `from` with a quotation mark; npos without an end.
std::size_t EndOfString(const std::string& json, std::size_t from) {
  for (std::size_t k = from + 1; k < json.size(); ++k) {
    if (json[k] == '\\') {
      ++k;
    } else if (json[k] == '"') {
      return k + 1;
    }
  }
  return std::string::npos;
}

absl::StatusOr<std::string> FileMessage(const std::string& name, const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / std::filesystem::path(name);
  const absl::StatusOr<std::string> bytes = ReadWholeFile(path.string());
  if (!bytes.ok()) return bytes.status();
  const std::string ending = absl::AsciiStrToLower(path.extension().string());
  if (ending != ".csv" && ending != ".dat" && ending != ".json") {
    return absl::InvalidArgumentError(
        fmt::format("\"file\": \"{}\": points end in .csv or .dat, faired curves in .json", name));
  }
  return fmt::format(R"({{"format": "{}", "content": "{}"}})", ending.substr(1), absl::Base64Escape(*bytes));
}

}  // namespace

absl::StatusOr<std::string> PutFilesIntoJson(const std::string& json, const std::filesystem::path& folder) {
  std::string out;
  std::size_t done = 0;
  for (std::size_t k = 0; k < json.size();) {
    if (json[k] != '"') {
      ++k;
      continue;
    }
    const std::size_t key = k;
    k = EndOfString(json, key);
    if (k == std::string::npos) break;
    if (json.compare(key, k - key, kFileKey) != 0) continue;
    const std::size_t colon = json.find_first_not_of(kJsonBlanks, k);
    if (colon == std::string::npos || json[colon] != ':') continue;
    const std::size_t value = json.find_first_not_of(kJsonBlanks, colon + 1);
    if (value == std::string::npos || json[value] != '"') continue;
    k = EndOfString(json, value);
    if (k == std::string::npos) break;
    google::protobuf::StringValue name;
    if (!google::protobuf::util::JsonStringToMessage(json.substr(value, k - value), &name).ok()) continue;
    absl::StatusOr<std::string> message = FileMessage(name.value(), folder);
    if (!message.ok()) return message.status();
    out.append(json, done, value - done);
    out += *message;
    done = k;
  }
  out.append(json, done);
  return out;
}

}  // namespace patchmill::cli
