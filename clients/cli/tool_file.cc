#include "clients/cli/tool_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <sstream>

#include <absl/strings/ascii.h>
#include <fmt/format.h>
#include <google/protobuf/struct.pb.h>

#include "clients/cli/input_file.h"
#include "clients/cli/job_options.h"
#include "clients/cli/text.h"
#include "proto/json/json_message.h"

namespace patchmill::cli {
namespace {

using google::protobuf::Struct;
using google::protobuf::Value;

constexpr double kInch = 25.4;  // mm

std::string Trimmed(const std::string& text) {
  const std::size_t first = std::min(text.find_first_not_of(" \t\r"), text.size());
  const std::size_t last = text.find_last_not_of(" \t\r");
  return last == std::string::npos ? "" : text.substr(first, last + 1 - first);
}

std::string Lower(std::string text) {
  absl::AsciiStrToLower(&text);
  return text;
}

absl::Status Bad(const std::string& message) { return absl::InvalidArgumentError(message); }

const Value* Find(const Struct& object, const std::string& key) {
  const auto at = object.fields().find(key);
  return at == object.fields().end() ? nullptr : &at->second;
}

const Struct* FindObject(const Struct& object, const std::string& key) {
  const Value* value = Find(object, key);
  return value != nullptr && value->has_struct_value() ? &value->struct_value() : nullptr;
}

std::string TextOf(const Struct& object, const std::string& key) {
  const Value* value = Find(object, key);
  return value != nullptr && value->kind_case() == Value::kStringValue ? value->string_value() : "";
}

// A number above 0, else nothing: libraries write 0 for what they do not know.
std::optional<double> NumberOf(const Struct& object, const std::string& key) {
  const Value* value = Find(object, key);
  if (value == nullptr || value->kind_case() != Value::kNumberValue) return std::nullopt;
  const double number = value->number_value();
  if (!std::isfinite(number) || !(number > 0.0)) return std::nullopt;
  return number;
}

// "6.0 mm", "0.25 in", "0.25 \"", or a number of mm.
std::optional<double> LengthOf(const Struct& object, const std::string& key) {
  if (const auto number = NumberOf(object, key)) return number;
  const std::string text = TextOf(object, key);
  const std::size_t end = std::min(text.find_first_not_of("0123456789.+-eE"), text.size());
  double number = 0.0;
  if (!ReadFinite(text.substr(0, end), number) || !(number > 0.0)) return std::nullopt;
  const std::string unit = Trimmed(text.substr(end));
  if (unit.empty() || unit == "mm") return number;
  if (unit == "in" || unit == "\"" || unit == "inch") return kInch * number;
  if (unit == "cm") return 10.0 * number;
  return std::nullopt;
}

// One line of a tool table of LinuxCNC: "T1 P1 D6.0 Z+40.5 ;ball". Nothing for a line without a tool.
absl::StatusOr<std::optional<FileTool>> ReadTableLine(const std::string& line) {
  const std::size_t semicolon = std::min(line.find(';'), line.size());
  FileTool read;
  bool any = false;
  std::istringstream words(line.substr(0, semicolon));
  for (std::string word; words >> word;) {
    double number = 0.0;
    if (!absl::ascii_isalpha(static_cast<unsigned char>(word[0])) || !ReadFinite(word.substr(1), number))
      return Bad(fmt::format("\"{}\" is no letter with a number", word.substr(0, 30)));
    const char letter = absl::ascii_toupper(static_cast<unsigned char>(word[0]));
    if (letter == 'T') {
      if (number < 0.0 || number > 99999.0 || number != std::floor(number))
        return Bad(fmt::format("{} is no number of a tool", word.substr(0, 30)));
      read.tool.set_number(static_cast<int>(number));
      any = true;
    } else if (letter == 'D' && number > 0.0) {
      read.tool.mutable_ball_end()->set_diameter_mm(number);
    }
  }
  if (!any) return std::nullopt;
  if (semicolon < line.size()) read.tool.set_name(WireText(Trimmed(line.substr(semicolon + 1)), 100));
  if (!read.tool.has_ball_end()) read.shape = "without a diameter";
  return read;
}

absl::StatusOr<std::vector<FileTool>> ReadTable(const std::string& text) {
  std::vector<FileTool> tools;
  int number = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    ++number;
    auto tool = ReadTableLine(line);
    if (!tool.ok()) return Bad(fmt::format("line {}: {}", number, std::string(tool.status().message())));
    if (*tool) tools.push_back(*std::move(*tool));
  }
  return tools;
}

// A tool bit of FreeCAD.
FileTool ReadToolBit(const Struct& bit) {
  const Struct& parameters = *FindObject(bit, "parameter");
  FileTool read;
  std::string shape = TextOf(bit, "shape");
  shape = shape.substr(0, shape.rfind(".fcstd"));
  read.tool.set_name(WireText(TextOf(bit, "name"), 100));
  const auto diameter = LengthOf(parameters, "Diameter");
  if (Lower(shape).find("ball") == std::string::npos) {
    read.shape = shape.empty() ? "of no shape" : shape;
  } else if (!diameter) {
    read.shape = "without a diameter";
  } else {
    read.tool.mutable_ball_end()->set_diameter_mm(*diameter);
  }
  if (const auto flutes = LengthOf(parameters, "CuttingEdgeHeight")) read.tool.set_flute_length_mm(*flutes);
  if (const auto shank = LengthOf(parameters, "ShankDiameter")) read.tool.set_shank_diameter_mm(*shank);
  return read;
}

// The unit of an object of Fusion's, mm; `other` if it states none.
double UnitOf(const Struct& object, double other) {
  const std::string unit = TextOf(object, "unit");
  if (unit == "inches") return kInch;
  return unit == "millimeters" ? 1.0 : other;
}

// The segments of a holder or a shaft in a library of Fusion, from the lowest on.
struct Segments {
  std::vector<v1::HolderSegment> list;
  std::string fault;  // empty if all of them can be read
};

// `unit` is that of the tool. A segment of no height counts nothing.
Segments SegmentsOf(const Struct& tool, const std::string& key, double unit) {
  Segments found;
  const Struct* object = FindObject(tool, key);
  const Value* segments = object != nullptr ? Find(*object, "segments") : nullptr;
  if (segments == nullptr || !segments->has_list_value()) return found;
  const double own = UnitOf(*object, unit);
  for (int k = 0; k < segments->list_value().values_size(); ++k) {
    const Struct& segment = segments->list_value().values(k).struct_value();
    const Value* height = Find(segment, "height");
    if (height != nullptr && height->kind_case() == Value::kNumberValue && height->number_value() == 0.0)
      continue;
    const auto length = NumberOf(segment, "height"), lower = NumberOf(segment, "lower-diameter"),
               upper = NumberOf(segment, "upper-diameter");
    if (!length || !lower || !upper) {
      found.fault = fmt::format(
          "with segment {} of its {} unreadable (height and diameters must be numbers above 0)", k, key);
      return found;
    }
    v1::HolderSegment& out = found.list.emplace_back();
    out.set_length_mm(own * *length);
    out.set_lower_diameter_mm(own * *lower);
    out.set_upper_diameter_mm(own * *upper);
  }
  return found;
}

// Spindle speed and feeds of the first preset.
void ReadPreset(const Struct& from, double unit, v1::Tool& tool) {
  const Struct* start = FindObject(from, "start-values");
  const Value* presets = start != nullptr ? Find(*start, "presets") : nullptr;
  if (presets == nullptr || !presets->has_list_value() || presets->list_value().values().empty()) return;
  // The first of several presets is a default: nobody has chosen it.
  tool.set_cutting_data_is_default(presets->list_value().values_size() > 1);
  const Value& first = presets->list_value().values(0);
  if (!first.has_struct_value()) return;
  if (const auto speed = NumberOf(first.struct_value(), "n")) tool.set_spindle_rpm(*speed);
  if (const auto feed = NumberOf(first.struct_value(), "v_f")) tool.set_feed_mm_per_min(unit * *feed);
  if (const auto plunge = NumberOf(first.struct_value(), "v_f_plunge"))
    tool.set_plunge_feed_mm_per_min(unit * *plunge);
}

// A tool of a library of Fusion.
FileTool ReadLibraryTool(const Struct& from) {
  const double unit = UnitOf(from, 1.0);
  FileTool read;
  v1::Tool& tool = read.tool;
  tool.set_name(WireText(TextOf(from, "description"), 100));
  if (const Struct* post = FindObject(from, "post-process")) {
    const auto number = NumberOf(*post, "number");
    if (number && *number <= 99999.0) tool.set_number(static_cast<int>(*number));
  }
  const Struct* geometry = FindObject(from, "geometry");
  const auto length = [&](const char* key) {
    const auto number = geometry != nullptr ? NumberOf(*geometry, key) : std::nullopt;
    return number ? std::optional(unit * *number) : std::nullopt;
  };
  const std::string type = TextOf(from, "type");
  const auto diameter = length("DC");
  if (type != "ball end mill") {
    read.shape = type.empty() ? "of no type" : type;
  } else if (!diameter) {
    read.shape = "without a diameter";
  } else {
    tool.mutable_ball_end()->set_diameter_mm(*diameter);
  }
  if (const auto flutes = length("LCF")) tool.set_flute_length_mm(*flutes);
  // The shank counts as a cylinder as wide as its widest segment.
  double shank = length("SFDM").value_or(0.0);
  const Segments shaft = SegmentsOf(from, "shaft", unit), holder = SegmentsOf(from, "holder", unit);
  for (const v1::HolderSegment& segment : shaft.list)
    shank = std::max({shank, segment.lower_diameter_mm(), segment.upper_diameter_mm()});
  if (shank > 0.0) tool.set_shank_diameter_mm(shank);
  if (const auto stickout = length("LB")) tool.set_stickout_mm(*stickout);
  for (const v1::HolderSegment& segment : holder.list) *tool.add_holder() = segment;
  for (const Segments* segments : {&shaft, &holder})
    if (read.shape.empty()) read.shape = segments->fault;
  ReadPreset(from, unit, tool);
  return read;
}

absl::StatusOr<std::vector<FileTool>> ReadLibrary(const Value& list) {
  std::vector<FileTool> tools;
  for (const Value& value : list.list_value().values()) {
    // Holders stand in libraries, too.
    if (!value.has_struct_value() || TextOf(value.struct_value(), "type") == "holder") continue;
    tools.push_back(ReadLibraryTool(value.struct_value()));
  }
  return tools;
}

std::string NameOf(const FileTool& tool) {
  std::string name = fmt::format("T{}", tool.tool.number());
  if (!tool.tool.name().empty()) name += " " + tool.tool.name();
  if (tool.tool.has_ball_end()) name += fmt::format(" D {:g}", tool.tool.ball_end().diameter_mm());
  return name;
}

// "a, b and 3 more".
std::string ListOf(const std::vector<FileTool>& tools) {
  constexpr std::size_t kMost = 12;
  std::string list;
  for (std::size_t k = 0; k < std::min(tools.size(), kMost); ++k) {
    list += (k == 0 ? "" : ", ") + NameOf(tools[k]);
    if (!tools[k].shape.empty()) list += " (" + tools[k].shape + ")";
  }
  if (tools.size() > kMost) list += fmt::format(" and {} more", tools.size() - kMost);
  return list.empty() ? "none" : list;
}

absl::StatusOr<v1::Tool> Choose(const std::vector<FileTool>& tools, std::optional<int> number) {
  const FileTool* chosen = nullptr;
  int count = 0;
  for (const FileTool& tool : tools) {
    if (number ? tool.tool.number() != *number : !tool.shape.empty()) continue;
    chosen = &tool;
    ++count;
  }
  if (number && count == 0) return Bad(fmt::format("has no tool {}; it has {}", *number, ListOf(tools)));
  if (count == 0) return Bad(fmt::format("has no ball end mill; it has {}", ListOf(tools)));
  if (count > 1) {
    return Bad(fmt::format("has several tools{}; name one as FILE:NUMBER, of {}",
                           number ? fmt::format(" {}", *number) : "", ListOf(tools)));
  }
  if (!chosen->shape.empty()) {
    return Bad(fmt::format("tool {} is {}; Patchmill cuts with ball end mills only", chosen->tool.number(),
                           chosen->shape));
  }
  return chosen->tool;
}

}  // namespace

absl::StatusOr<std::vector<FileTool>> ReadTools(std::string_view text, const std::string& name) {
  if (Lower(std::filesystem::path(name).extension().string()) == ".tbl") return ReadTable(std::string(text));
  Struct object;
  if (const absl::Status read = ReadJsonMessage(text, object); !read.ok()) {
    return Bad(fmt::format("neither JSON nor a tool table (.tbl): {}", std::string(read.message())));
  }
  if (const Value* data = Find(object, "data"); data != nullptr && data->has_list_value())
    return ReadLibrary(*data);
  if (FindObject(object, "parameter") != nullptr) return std::vector{ReadToolBit(object)};
  FileTool own;
  if (const absl::Status read = ReadJsonMessage(text, own.tool); !read.ok()) {
    return Bad(fmt::format(
        "is no tool: neither a library of Fusion (\"data\"), nor a tool bit of FreeCAD (\"parameter\"), nor "
        "Patchmill's own (docs/tool.json): {}",
        std::string(read.message())));
  }
  if (!own.tool.has_ball_end()) own.shape = "without ball_end";
  return std::vector{std::move(own)};
}

absl::StatusOr<v1::Tool> ReadToolFile(const std::string& named) {
  std::string path = named;
  std::optional<int> number;
  const std::size_t colon = named.rfind(':');
  const std::string digits = colon == std::string::npos ? "" : named.substr(colon + 1);
  if (!digits.empty() && digits.size() <= 5 && digits.find_first_not_of("0123456789") == std::string::npos) {
    path = named.substr(0, colon);
    number = std::stoi(digits);
  }
  const auto bad = [&](const absl::Status& status) {
    return Bad(fmt::format("--tool {}: {}", named, std::string(status.message())));
  };
  absl::StatusOr<std::string> text = ReadWholeFile(path);
  if (!text.ok()) return bad(text.status());
  const auto tools = ReadTools(*text, path);
  if (!tools.ok()) return bad(tools.status());
  auto tool = Choose(*tools, number);
  if (!tool.ok()) return bad(tool.status());
  return tool;
}

}  // namespace patchmill::cli
