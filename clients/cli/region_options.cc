#include "clients/cli/region_options.h"

#include <sstream>

#include <absl/status/statusor.h>
#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include "clients/cli/input_file.h"
#include "clients/cli/job_options.h"
#include "patchmill/v1/analysis_service.pb.h"

namespace patchmill::cli {
namespace {

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

// Reads one of the words after the colons. False if the word is unknown or repeats a setting.
bool ReadWord(const std::string& word, v1::RegionOverride& change) {
  const std::size_t equals = word.find('=');
  const std::string name = word.substr(0, equals);
  if (equals != std::string::npos) {
    double value = 0.0;
    if (!ReadFinite(word.substr(equals + 1), value)) return false;
    if (name == "angle" && !change.has_zigzag_angle_deg()) {
      change.set_zigzag_angle_deg(value);
    } else if (name == "scallop" && !change.has_scallop_mm()) {
      change.set_scallop_mm(value);
    } else {
      return false;
    }
    return true;
  }
  if (name == "off") {
    change.set_skip(true);
  } else if ((name == "oneway" || name == "bothways") && !change.has_one_way_lines()) {
    change.set_one_way_lines(name == "oneway");
  } else if ((name == "auto" || name == "contour" || name == "zigzag") &&
             change.strategy() == v1::STRATEGY_UNSPECIFIED) {
    change.set_strategy(MakeStrategy(name));
  } else {
    return false;
  }
  return true;
}

// Reads ID:WORD[:WORD] or X,Y,Z:WORD[:WORD].
absl::Status ReadChange(const std::string& text, v1::RegionOverride& change) {
  const std::vector<std::string> parts = Split(text, ':');
  bool good = parts.size() >= 2;
  if (good && parts.front().find(',') != std::string::npos) {
    const absl::StatusOr<v1::Point3> point = ReadPoint(parts.front(), "--region");
    good = point.ok();
    if (good) *change.mutable_at() = *point;
  } else if (good) {
    int id = -1;
    good = CLI::detail::lexical_cast(parts.front(), id) && id >= 0;
    change.set_region_id(id);
  }
  for (std::size_t k = 1; good && k < parts.size(); ++k) good = ReadWord(parts[k], change);
  if (good) return absl::OkStatus();
  return absl::InvalidArgumentError(fmt::format(
      "--region \"{}\"; must be ID or X,Y,Z and then :off, or :auto, :contour, :zigzag, :angle=DEG, "
      ":oneway, :bothways, :scallop=MM, one of a kind",
      text.substr(0, 80)));
}

// Reads the digest from 64 hexadecimal digits, or from the file that `patchmill regions` wrote.
absl::StatusOr<std::string> ReadMap(const std::string& text) {
  constexpr std::size_t kBytes = 32;
  if (text.size() == 2 * kBytes && text.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos) {
    std::string bytes;
    for (std::size_t i = 0; i < text.size(); i += 2) {
      bytes += static_cast<char>(std::stoi(text.substr(i, 2), nullptr, 16));
    }
    return bytes;
  }
  absl::StatusOr<std::string> content = ReadWholeFile(text);
  if (!content.ok()) return content.status();
  v1::SplitRegionsResponse response;
  const bool read = google::protobuf::util::JsonStringToMessage(*content, &response).ok();
  if (read && response.regions().regions_sha256().size() == kBytes)
    return response.regions().regions_sha256();
  return absl::InvalidArgumentError(
      fmt::format("--regions {}: neither a .json of `patchmill regions` nor 64 hexadecimal digits", text));
}

}  // namespace

void AddRegionChangeOptions(CLI::App& app, RegionChangeOptions& options) {
  app.add_option(
      "--region", options.changes,
      "how to cut one region: its ID, or X,Y,Z of a point of it (program frame), then :off, or any of "
      ":auto, :contour, :zigzag, :angle=DEG, :oneway, :bothways, :scallop=MM; repeat the option for more "
      "regions");
  app.add_option(
      "--regions", options.map,
      "map that the ids refer to: the .json of `patchmill regions` with the same options, or its sha256");
}

absl::Status SetRegions(const RegionChangeOptions& options, std::string* sha256,
                        google::protobuf::RepeatedPtrField<v1::RegionOverride>* overrides) {
  bool by_id = false;
  for (const std::string& text : options.changes) {
    v1::RegionOverride& change = *overrides->Add();
    if (const absl::Status read = ReadChange(text, change); !read.ok()) return read;
    by_id = by_id || !change.has_at();
  }
  if (options.map.empty()) {
    if (!by_id) return absl::OkStatus();
    return absl::InvalidArgumentError(
        "--region names a region by its id; add --regions MAP.json, which `patchmill regions -o MAP.json` "
        "writes, or name the region by a point, --region X,Y,Z:...");
  }
  absl::StatusOr<std::string> map = ReadMap(options.map);
  if (!map.ok()) return map.status();
  *sha256 = *std::move(map);
  return absl::OkStatus();
}

}  // namespace patchmill::cli
