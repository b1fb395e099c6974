#include "core/io/curve_points.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/io/lednicer.h"
#include "core/io/text_scanner.h"

namespace patchmill {
namespace {

constexpr std::string_view kBlank = " \t\r\f\v";

std::string_view Trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

// Four fields are as wrong as more, so no more than four are kept.
std::vector<std::string_view> Fields(std::string_view line, bool commas) {
  std::vector<std::string_view> fields;
  while (fields.size() < 4) {
    const std::size_t end = commas ? line.find(',') : line.find_first_of(kBlank);
    fields.push_back(Trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    line = commas ? line.substr(end + 1) : Trimmed(line.substr(end));
  }
  return fields;
}

std::string Title(std::string_view line) {
  std::string title(line.substr(0, kMaxCurveTitle));
  for (char& c : title) {
    if (c < 0x20 || c > 0x7e) c = '?';
  }
  return title;
}

absl::Status Fail(int line, std::string_view reason) {
  return absl::InvalidArgumentError(fmt::format("line {}: {}", line, reason));
}

}  // namespace

absl::StatusOr<CurvePoints> ReadCurvePoints(std::string_view format, std::string_view text) {
  if (format != "csv" && format != "dat") {
    return absl::InvalidArgumentError(
        fmt::format("unknown format {} of a curve; known are \"csv\" and \"dat\"", Quoted(format)));
  }
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  CurvePoints curve;
  int number = 0, first_line = 0;
  bool title_possible = true, empty_line_after_first = false;
  std::size_t columns = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = text.find('\n');
    const std::string_view line = Trimmed(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    if (line.empty() && curve.points.size() == 1) empty_line_after_first = true;
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string_view> fields = Fields(line, format == "csv");
    const bool can_be_point = fields.size() == 2 || fields.size() == 3;
    if (title_possible && (!can_be_point || !ParseNumber(fields[0], "x").ok())) {
      title_possible = false;
      curve.title = Title(line);
      continue;
    }
    title_possible = false;
    if (!can_be_point) return Fail(number, "a point has two or three numbers");
    if (columns == 0) columns = fields.size(), first_line = number;
    if (fields.size() != columns) {
      return Fail(number, fmt::format("{} numbers; the points before have {}", fields.size(), columns));
    }
    if (curve.points.size() == static_cast<std::size_t>(kMaxCurvePoints)) {
      return Fail(number, fmt::format("more than {} points", kMaxCurvePoints));
    }
    Vec3 point = Vec3::Zero();
    constexpr const char* kNames[] = {"x of a point", "y of a point", "z of a point"};
    for (std::size_t k = 0; k < columns; ++k) {
      const absl::StatusOr<double> value = ParseNumber(fields[k], kNames[k]);
      if (!value.ok()) return Fail(number, std::string(value.status().message()));
      point[static_cast<Eigen::Index>(k)] = *value;
    }
    curve.points.push_back(point);
  }
  if (curve.points.empty()) return Fail(std::max(number, 1), "the text holds no point");
  curve.planar = columns == 2;
  const auto counts = curve.planar ? CountsOf(curve.points, empty_line_after_first) : std::nullopt;
  if (!counts) return curve;
  absl::StatusOr<std::vector<Vec3>> run = JoinSides(*counts, {curve.points.begin() + 1, curve.points.end()});
  if (!run.ok()) return Fail(first_line, std::string(run.status().message()));
  curve.points = *std::move(run);
  return curve;
}

}  // namespace patchmill
