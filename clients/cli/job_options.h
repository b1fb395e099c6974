// The options of the commands as values, and the messages made of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>

#include "clients/cli/connection.h"
#include "patchmill/v1/job.pb.h"

namespace patchmill::cli {

// How the model lies on the machine.
struct SetupOptions {
  double scale = 1.0;
  std::string up = "z";
  std::optional<double> cap_holes;
  std::vector<double> translate;
  std::string zero;  // empty: not stated
  std::optional<double> stock_top;
  std::optional<double> allowance, allowance_walls, allowance_floors;
  std::string stock, machine;
  std::vector<std::string> wall_sides;  // "NAME=X,Y,Z"
};

// The tool above its ball.
struct ShankOptions {
  std::optional<double> flute_length, shank_diameter, stickout, holder_clearance;
  std::string holder;  // segments from below: "LENGTH,DIAMETER" or "LENGTH,LOWER,UPPER", apart by spaces
};

inline constexpr double kDefaultDiameter = 6.0;  // mm

struct OperationOptions {
  std::string tool;                     // "FILE" or "FILE:NUMBER"
  std::optional<double> tool_diameter;  // mm; default that of the file, or kDefaultDiameter
  double scallop = 0.01, tolerance = 0.01, leave = 0.0, steep_angle = 45.0;
  std::string strategy = "auto", direction = "climb", coolant = "off", edges = "stop";
  double zigzag_angle = 0.0, bend = 20.0, clearance = 5.0, detail = 0.5;
  bool one_way = false, spirals = false, auto_angle = false, no_border_passes = false;
  bool no_round_lines = false, high_rapids = false, low_rapids = false, keep_feed = false;
  std::optional<double> approach_gap, lead_radius, lead_sweep, plunge_angle, link_feed, lead_feed,
      corner_feed;
  double accept_depth = 0.0;
  std::optional<double> max_unreached;  // percent
  std::optional<double> floor, feed, plunge_feed, spindle;
  std::optional<int> tool_number;
  ShankOptions shank;
};

// Adds an option for a finite number. Any other text is a usage error.
CLI::Option* AddNumber(CLI::App& app, const std::string& name, double& value, const std::string& help);
CLI::Option* AddNumber(CLI::App& app, const std::string& name, std::optional<double>& value,
                       const std::string& help);

void AddCommonOptions(CLI::App& app, CommonOptions& options);
// Adds the options that regions depend on: --tool-diameter to --steep-angle, --detail, --floor.
void AddSplitOptions(CLI::App& app, OperationOptions& options);
void AddShankOptions(CLI::App& app, ShankOptions& options);
void AddSetupOptions(CLI::App& app, SetupOptions& options);
void AddStockOptions(CLI::App& app, SetupOptions& options);

inline constexpr char kModelHelp[] =
    "model file: .step, .stp, .iges, .igs, .json, .pb, .bpt, .bv, .bez, .patches";

absl::Status SetShank(const ShankOptions& options, v1::Tool& tool);
absl::StatusOr<v1::Operation> MakeOperation(const OperationOptions& options);
v1::Strategy MakeStrategy(const std::string& name);
bool ReadFinite(const std::string& text, double& value);
// Reads "X,Y,Z". INVALID_ARGUMENT names the option.
absl::StatusOr<v1::Point3> ReadPoint(const std::string& text, const char* option);

// The options for reading a model file.
struct ReadingOptions {
  std::string length_unit;  // of formats that state none: "mm", "inch", "m"; empty: not stated
  std::optional<double> border_tolerance;
  std::vector<std::string> skip_faces;
};
void AddReadingOptions(CLI::App& app, ReadingOptions& options);

// `length_unit` is that of a stock's model that states none, as in ReadingOptions.
absl::StatusOr<v1::Setup> MakeSetup(const SetupOptions& options, const std::string& length_unit = "");

// The bytes of a model file, its format and how it is read. The ending of the path gives the text formats.
// The server distinguishes JSON from protobuf by content.
absl::StatusOr<v1::ModelSource> ReadModelFile(const std::string& path, const ReadingOptions& options);
// Reads the file of the part. Messages about its content name this file.
absl::StatusOr<v1::ModelSource> ReadModel(const std::string& path, const ReadingOptions& options = {});

}  // namespace patchmill::cli
