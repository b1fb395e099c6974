#include "clients/cli/fair_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <absl/strings/ascii.h>
#include <fmt/format.h>

#include "clients/cli/input_file.h"
#include "clients/cli/job_options.h"
#include "clients/cli/length_units.h"
#include "clients/cli/text.h"

namespace patchmill::cli {
namespace {

absl::Status Wrong(const char* option, const std::string& text, const char* constraint) {
  return absl::InvalidArgumentError(fmt::format("{} {}; must be {}", option, text, constraint));
}

std::vector<std::string> Split(const std::string& text, char by) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, by);) parts.push_back(part);
  if (text.empty() || text.back() == by) parts.emplace_back();
  return parts;
}

// The parts as numbers; nothing if one of them is no number.
std::vector<double> Numbers(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& part : Split(text, ',')) {
    double value = 0.0;
    if (!CLI::detail::lexical_cast(part, value) || !std::isfinite(value)) return {};
    numbers.push_back(value);
  }
  return numbers;
}

bool ReadAxes(const std::string& text, google::protobuf::RepeatedField<int>* axes) {
  if (text.empty()) return false;
  for (const char c : text) {
    if (c < 'x' || c > 'z') return false;
    axes->Add(v1::AXIS_X + (c - 'x'));
  }
  return true;
}

bool ReadIndex(const std::string& text, int& index) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  return error == std::errc() && end == text.data() + text.size() && index >= 0;
}

// Reads "7" or "3-9", with or without ":xz".
bool ReadLock(const std::string& text, v1::FairCurveRequest& request) {
  constexpr int kMostPoints = 100'000;
  const std::size_t colon = text.find(':');
  const std::string range = text.substr(0, colon);
  const std::size_t dash = range.find('-');
  int first = 0, last = 0;
  if (!ReadIndex(range.substr(0, dash), first)) return false;
  last = first;
  if (dash != std::string::npos && !ReadIndex(range.substr(dash + 1), last)) return false;
  if (last < first || last - first >= kMostPoints) return false;
  for (int point = first; point <= last; ++point) {
    v1::PointLock& lock = *request.add_locks();
    lock.set_point_index(point);
    if (colon != std::string::npos && !ReadAxes(text.substr(colon + 1), lock.mutable_axes())) return false;
  }
  return true;
}

bool ReadBand(const std::string& text, v1::FairCurveRequest& request) {
  if (text == "none") return true;
  v1::FairingBand& band = *request.mutable_band();
  if (!text.empty() && text.back() == '%') {
    const std::vector<double> percent = Numbers(text.substr(0, text.size() - 1));
    if (percent.size() != 1) return false;
    band.set_fraction(percent[0] / 100.0);
    return true;
  }
  const std::vector<double> numbers = Numbers(text);
  if (numbers.size() != 1 && numbers.size() != 3) return false;
  band.set_x_mm(numbers.front());
  band.set_y_mm(numbers.size() == 3 ? numbers[1] : numbers[0]);
  band.set_z_mm(numbers.back());
  return true;
}

v1::FairingStop MakeStop(const std::string& name) {
  if (name == "energy") return v1::FAIRING_STOP_SIGNS_AND_ENERGY;
  if (name == "iterations") return v1::FAIRING_STOP_ITERATIONS;
  return v1::FAIRING_STOP_SIGNS;
}

bool ReadDirection(const std::string& text, google::protobuf::RepeatedField<double>* direction) {
  if (text.empty()) return true;
  const std::vector<double> numbers = Numbers(text);
  if (numbers.size() != 3) return false;
  direction->Add(numbers.begin(), numbers.end());
  return true;
}

// The ending of a path without its dot, in lower case: "csv", "dat" or any other.
std::string Ending(const std::string& path) {
  const std::string ending = absl::AsciiStrToLower(std::filesystem::path(path).extension().native());
  return ending.empty() ? ending : ending.substr(1);
}

}  // namespace

void AddFairOptions(CLI::App& app, FairOptions& options) {
  app.add_option(
         "POINTS", options.files,
         "measured points: .csv (commas) or .dat (blanks), one point of two or three numbers a line. Several "
         "files are sections,\n"
         "each faired by itself: OUTPUT.json is then an outline for the command build")
      ->required();
  app.add_option("-o,--output", options.output,
                 "the faired points: .csv, .dat, or .json with the curve, energies and curvatures")
      ->required();
  app.add_option(
         "--band", options.band,
         "how far a component may move: B or X,Y,Z in the unit of the points, P% of the diagonal of their "
         "box, or none")
      ->capture_default_str();
  app.add_option("--lock", options.locks,
                 "points that do not move, from 0: 4, 4-9, or components 4:xz; separated by commas")
      ->delimiter(',');
  app.add_option("--axes", options.axes, "components that may move")->capture_default_str();
  app.add_option("--start-direction", options.start_direction,
                 "X,Y,Z at the first point; default: that of the circle through 3 points");
  app.add_option("--end-direction", options.end_direction,
                 "X,Y,Z at the last point; default: that of the circle through 3 points");
  app.add_option("--iterations", options.iterations, "largest number of iterations")
      ->check(CLI::Range(0, 10'000))
      ->capture_default_str();
  app.add_option("--stop", options.stop,
                 "end when no curvature changes its sign (signs), when the energy settles, too (energy), or "
                 "not earlier\n"
                 "(iterations)")
      ->check(CLI::IsMember({"signs", "energy", "iterations"}))
      ->capture_default_str();
  app.add_option("--band-rule", options.band_rule,
                 "find the least energy within the bands, or cut points back to the bands as in the paper")
      ->check(CLI::IsMember({"least", "cut"}))
      ->capture_default_str();
  app.add_option("--net", options.net,
                 "the points are a net of this many lines, one after the other; both families of lines are "
                 "faired, and "
                 "the border stays")
      ->check(CLI::Range(2, 50'000));
  std::vector<std::string> units;
  for (const auto& [name, unit] : LengthUnits()) units.push_back(name);
  app.add_option("--length-unit", options.length_unit,
                 "unit of the points, which the outline of several files states; default mm")
      ->check(CLI::IsMember(units));
  app.add_flag("--fit", options.fit, "only fit the curve through the points; no point moves");
  CLI::Option* polyline =
      app.add_option("--polyline", options.polyline, "write the faired curve as a polyline: .csv or .dat");
  CLI::Option* tolerance = AddNumber(app, "--tolerance", options.tolerance,
                                     "tolerance of the polyline, in the unit of the points");
  polyline->needs(tolerance);
  tolerance->needs(polyline);
  app.add_option("--preview", options.preview,
                 "write a picture of the curve before and after fairing, with its curvature comb: .svg");
}

absl::StatusOr<v1::FairNetRequest> MakeFairNetRequest(const FairOptions& options) {
  for (const auto& [option, given] :
       {std::pair{"--polyline", &options.polyline}, std::pair{"--preview", &options.preview},
        std::pair{"--start-direction", &options.start_direction},
        std::pair{"--end-direction", &options.end_direction}}) {
    if (!given->empty())
      return absl::InvalidArgumentError(
          fmt::format("{} is for curves; it cannot be combined with --net", option));
  }
  absl::StatusOr<v1::FairCurveRequest> curve = MakeFairRequest(options);
  if (!curve.ok()) return curve.status();
  v1::FairNetRequest request;
  request.mutable_file()->Swap(curve->mutable_file());
  request.set_line_count(options.net);
  *request.mutable_axes() = curve->axes();
  if (curve->has_band()) *request.mutable_band() = curve->band();
  *request.mutable_locks() = curve->locks();
  request.set_max_iterations(curve->max_iterations());
  request.set_stop(curve->stop());
  request.set_band_rule(curve->band_rule());
  return request;
}

absl::StatusOr<v1::FairCurveRequest> MakeFairRequest(const FairOptions& options) {
  v1::FairCurveRequest request;
  absl::StatusOr<std::string> bytes = ReadWholeFile(options.points);
  if (!bytes.ok()) return bytes.status();
  NameModel(options.points);
  request.mutable_file()->set_format(WireText(Ending(options.points), 20));
  request.mutable_file()->set_content(*std::move(bytes));
  if (!ReadAxes(options.axes, request.mutable_axes())) return Wrong("--axes", options.axes, "of x, y, z");
  if (!ReadBand(options.band, request)) return Wrong("--band", options.band, "B, X,Y,Z, P% or none");
  for (const std::string& lock : options.locks) {
    if (!ReadLock(lock, request)) return Wrong("--lock", lock, "I, I-J, I:xyz or I-J:xyz");
  }
  if (!ReadDirection(options.start_direction, request.mutable_start_direction())) {
    return Wrong("--start-direction", options.start_direction, "X,Y,Z");
  }
  if (!ReadDirection(options.end_direction, request.mutable_end_direction())) {
    return Wrong("--end-direction", options.end_direction, "X,Y,Z");
  }
  request.set_max_iterations(options.fit ? 0 : options.iterations);
  request.set_stop(MakeStop(options.stop));
  request.set_band_rule(options.band_rule == "cut" ? v1::BAND_RULE_CUT : v1::BAND_RULE_LEAST_ENERGY);
  if (options.tolerance) request.set_polyline_tolerance_mm(*options.tolerance);
  request.set_picture(!options.preview.empty());
  request.set_name(WireText(std::filesystem::path(options.points).filename().string(), 100));
  return request;
}

}  // namespace patchmill::cli
