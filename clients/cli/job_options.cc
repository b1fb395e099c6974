#include "clients/cli/job_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <absl/strings/ascii.h>
#include <fmt/format.h>

#include "clients/cli/input_file.h"
#include "clients/cli/length_units.h"
#include "clients/cli/stock_option.h"
#include "clients/cli/text.h"
#include "clients/cli/tool_file.h"
#include "proto/json/json_message.h"

namespace patchmill::cli {
namespace {

std::string FiniteFault(const std::string& text) {
  double value = 0.0;
  if (ReadFinite(text, value)) return "";
  return fmt::format("\"{}\" is not a finite number", text);
}

const CLI::Validator kFinite(FiniteFault, "NUMBER", "finite");

template <class Value>
CLI::Option* AddNumberOf(CLI::App& app, const std::string& name, Value& value, const std::string& help) {
  CLI::Option* option = app.add_option(name, value, help);
  return option->check(kFinite)->capture_default_str();
}

// The axis of this name, in small letters or capitals; nothing for any other text.
std::optional<v1::UpAxis> MakeUp(const std::string& given) {
  const std::string name = absl::AsciiStrToLower(given);
  if (name == "auto") return v1::UP_AXIS_AUTO;
  if (name == "z") return v1::UP_AXIS_Z;
  if (name == "y") return v1::UP_AXIS_Y;
  if (name == "x") return v1::UP_AXIS_X;
  if (name == "-z") return v1::UP_AXIS_NEG_Z;
  if (name == "-y") return v1::UP_AXIS_NEG_Y;
  if (name == "-x") return v1::UP_AXIS_NEG_X;
  return std::nullopt;
}

v1::CutDirection MakeDirection(const std::string& name) {
  if (name == "conventional") return v1::CUT_DIRECTION_CONVENTIONAL;
  if (name == "either") return v1::CUT_DIRECTION_EITHER;
  return v1::CUT_DIRECTION_CLIMB;
}

v1::Coolant MakeCoolant(const std::string& name) {
  if (name == "flood") return v1::COOLANT_FLOOD;
  if (name == "mist") return v1::COOLANT_MIST;
  if (name == "air") return v1::COOLANT_AIR;
  return v1::COOLANT_OFF;
}

// Default cutting data: 12000 rpm, feed 1200 and plunge feed 400 mm/min at D 6. Larger tools have the same
// cutting speed; smaller ones have the same feed per turn relative to the diameter. The spindle speed never
// exceeds 12000 rpm.
void SetCuttingData(const OperationOptions& options, v1::Tool& tool) {
  const double diameter = tool.ball_end().diameter_mm();
  const double larger = std::min(1.0, 6.0 / diameter), smaller = std::min(1.0, diameter / 6.0);
  if (options.spindle) tool.set_spindle_rpm(*options.spindle);
  if (options.feed) tool.set_feed_mm_per_min(*options.feed);
  if (options.plunge_feed) tool.set_plunge_feed_mm_per_min(*options.plunge_feed);
  const bool speed = options.spindle || tool.spindle_rpm() > 0.0;
  const bool feed = options.feed || tool.feed_mm_per_min() > 0.0;
  const bool plunge = options.plunge_feed || tool.plunge_feed_mm_per_min() > 0.0;
  if (!speed) tool.set_spindle_rpm(std::max(1.0, std::round(12000.0 * larger)));
  if (!feed) tool.set_feed_mm_per_min(std::max(1.0, std::round(1200.0 * smaller)));
  if (!plunge) {
    const double third = feed ? tool.feed_mm_per_min() / 3.0 : std::round(1200.0 * smaller) / 3.0;
    tool.set_plunge_feed_mm_per_min(std::max(1.0, std::round(third)));
  }
  const bool chosen = options.spindle && options.feed && options.plunge_feed;
  tool.set_cutting_data_is_default(!speed || !feed || !plunge || (tool.cutting_data_is_default() && !chosen));
}

}  // namespace

bool ReadFinite(const std::string& text, double& value) {
  return CLI::detail::lexical_cast(text, value) && std::isfinite(value);
}

absl::StatusOr<v1::Point3> ReadPoint(const std::string& text, const char* option) {
  std::array<double, 3> xyz{};
  std::istringstream in(text);
  std::string part;
  std::size_t count = 0;
  while (std::getline(in, part, ',')) {
    if (count == 3 || !ReadFinite(part, xyz[count])) {
      count = 4;
      break;
    }
    ++count;
  }
  if (count != 3) {
    return absl::InvalidArgumentError(fmt::format("{} {}; must be X,Y,Z", option, text));
  }
  v1::Point3 point;
  point.set_x_mm(xyz[0]);
  point.set_y_mm(xyz[1]);
  point.set_z_mm(xyz[2]);
  return point;
}

CLI::Option* AddNumber(CLI::App& app, const std::string& name, double& value, const std::string& help) {
  return AddNumberOf(app, name, value, help);
}

CLI::Option* AddNumber(CLI::App& app, const std::string& name, std::optional<double>& value,
                       const std::string& help) {
  return app.add_option(name, value, help)->check(kFinite);
}

void AddCommonOptions(CLI::App& app, CommonOptions& options) {
  app.add_option("--server", options.server,
                 "HOST:PORT of a patchmilld; default: the service runs inside this process");
  app.add_option("--ca", options.ca_file,
                 "TLS: certificate of the authority that the server's certificate is checked with (PEM)");
  app.add_option("--cert", options.cert_file, "TLS: certificate of this client (PEM)");
  app.add_option("--key", options.key_file, "TLS: key of that certificate (PEM)");
  app.add_option_function<std::string>(
         "--token-file",
         [&options](const std::string& path) {
           const absl::StatusOr<std::string> token = ReadTokenFile(path);
           if (!token.ok()) throw CLI::ValidationError("--token-file", std::string(token.status().message()));
           options.token = *token;
         },
         "file with the bearer token that the server knows this caller by; also PATCHMILL_TOKEN_FILE")
      ->envname("PATCHMILL_TOKEN_FILE");
  app.add_option("--threads", options.threads, "number of threads; 0: all; the result does not depend on it")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  AddNumber(app, "--timeout", options.timeout, "give up after this many seconds")
      ->check(CLI::Range(0.001, 1e6));
  app.add_flag("--quiet", options.quiet,
               "no progress bar and no summary of the files written; answers to the screen remain, and so do "
               "warnings\n"
               "except those that the header of every program states");
}

void AddSplitOptions(CLI::App& app, OperationOptions& options) {
  app.add_option(
      "--tool", options.tool,
      "FILE or FILE:NUMBER: a tool of a file; .json of Fusion, FreeCAD's tool bits (.fctb), LinuxCNC's "
      "tool\ntables (.tbl), or Patchmill's own .json (docs/tool.json). Options go before what it states");
  AddNumber(app, "--tool-diameter", options.tool_diameter, "ball diameter, mm; default 6, or that of --tool");
  AddNumber(app, "--scallop", options.scallop, "scallop (cusp) height: highest ridge between passes, mm");
  AddNumber(app, "--tolerance", options.tolerance, "whole error budget of the job, mm");
  AddNumber(app, "--leave", options.leave, "stock to leave along the normal, mm");
  AddNumber(app, "--steep-angle", options.steep_angle,
            "slope from which on contours (waterlines) cut instead of zig-zag lines, degrees");
  AddNumber(app, "--detail", options.detail,
            "how finely the surface is divided into regions: 0 coarsest, 1 finest")
      ->check(CLI::Range(0.0, 1.0));
  AddNumber(app, "--floor", options.floor,
            "lowest tip, mm, program frame; default: lowest point of the model");
}

void AddShankOptions(CLI::App& app, ShankOptions& options) {
  AddNumber(app, "--flute-length", options.flute_length,
            "flute length from the tip, mm; default: unknown and not checked");
  AddNumber(
      app, "--shank-diameter", options.shank_diameter,
      "diameter above the flutes, mm; area that it blocks is left, SHANK; default: as wide as the ball");
  AddNumber(app, "--stickout", options.stickout,
            "length from tip to holder, mm; a warning if the job needs more; default: unknown");
  app.add_option(
      "--holder", options.holder,
      "segments of the holder from below, apart by spaces: LENGTH,DIAMETER, or LENGTH,LOWER,UPPER for a "
      "cone, mm.\nNeeds --stickout; area that only the holder blocks is left, HOLDER");
  AddNumber(app, "--holder-clearance", options.holder_clearance,
            "distance kept around the holder and below it, mm; default 0.5, or --allowance if that is more");
}

void AddSetupOptions(CLI::App& app, SetupOptions& options) {
  AddNumber(app, "--scale", options.scale, "scale factor of the model");
  app.add_option(
         "--up", options.up,
         "what points up on the machine: an axis of the model (x, y, z, -x, -y, -z), auto (the axis that "
         "shows most),\nor a plane face (f12), with its outer side")
      ->capture_default_str();
  AddNumber(
      app, "--cap-holes", options.cap_holes,
      "close round holes of at most this diameter by caps over their mouths, and mill over them, mm;\nmodels "
      "with faces");
  app.add_option("--translate", options.translate, "translation X,Y,Z after scaling and turning, mm")
      ->delimiter(',')
      ->expected(3)
      ->check(kFinite);
  app.add_option("--zero", options.zero,
                 "program zero: X,Y,Z | origin | top-center | bottom-corner; default origin, with a warning");
  app.add_option(
         "--wall-side", options.wall_sides,
         "NAME=X,Y,Z: an upright wall that nothing else decides, and a point on the side where the tool "
         "stands, in\ncoordinates of the placed model; once for each wall")
      ->allow_extra_args(false);
}

void AddStockOptions(CLI::App& app, SetupOptions& options) {
  AddNumber(app, "--stock-top", options.stock_top,
            "top of the stock, mm; default: top of the model + allowance");
  AddNumber(app, "--allowance", options.allowance,
            "stock allowance along the normal, mm; default 0.5, or --leave if that is more");
  AddNumber(app, "--allowance-walls", options.allowance_walls,
            "stock allowance of walls, mm; default --allowance. On a slope it lies between both");
  AddNumber(app, "--allowance-floors", options.allowance_floors,
            "stock allowance of floors, mm; default --allowance");
  app.add_option("--stock", options.stock,
                 "the stock as it lies on the machine, up to --stock-top: block[,MARGIN] around the model |\n"
                 "cylinder,D[,X,Y] | \"outline: X,Y X,Y ...\" | outline:@FILE | model:FILE, placed as the "
                 "model is. It is\nwhole, or with --allowance it has been roughed to that over the part and "
                 "stands beside it");
  app.add_option(
      "--machine", options.machine,
      "the machine as a .json file: travel, speeds and accelerations of its axes (docs/motion.md). Moves "
      "and\nfeeds beyond them are errors, and the time includes accelerations");
}

namespace {

absl::Status ReadMachine(const std::string& path, v1::Machine& machine) {
  absl::StatusOr<std::string> text = ReadWholeFile(path);
  if (!text.ok()) return text.status();
  const absl::Status read = ReadJsonMessage(*text, machine);
  if (read.ok()) return read;
  return absl::InvalidArgumentError(
      fmt::format("--machine {}: no machine in JSON: {}", path, std::string(read.message())));
}

}  // namespace

absl::StatusOr<v1::Setup> MakeSetup(const SetupOptions& options, const std::string& length_unit) {
  v1::Setup setup;
  if (const std::optional<v1::UpAxis> up = MakeUp(options.up)) {
    setup.set_up(*up);
  } else {
    setup.set_up_face(WireText(options.up, 200));
  }
  setup.set_scale(options.scale);
  if (options.cap_holes) setup.set_cap_holes_mm(*options.cap_holes);
  if (!options.translate.empty()) {
    setup.mutable_translation()->set_x_mm(options.translate[0]);
    setup.mutable_translation()->set_y_mm(options.translate[1]);
    setup.mutable_translation()->set_z_mm(options.translate[2]);
  }
  for (const std::string& text : options.wall_sides) {
    const std::size_t equals = text.rfind('=');
    if (equals == std::string::npos || equals == 0)
      return absl::InvalidArgumentError(fmt::format("--wall-side {}; must be NAME=X,Y,Z", text));
    absl::StatusOr<v1::Point3> air = ReadPoint(text.substr(equals + 1), "--wall-side");
    if (!air.ok()) return air.status();
    v1::WallSide& side = *setup.add_wall_sides();
    side.set_patch_id(WireText(text.substr(0, equals), 200));
    *side.mutable_air() = *std::move(air);
  }
  if (options.zero.empty()) {
    setup.clear_zero();
  } else if (options.zero == "origin") {
    setup.set_zero_anchor(v1::ZERO_ANCHOR_ORIGIN);
  } else if (options.zero == "top-center") {
    setup.set_zero_anchor(v1::ZERO_ANCHOR_TOP_CENTER);
  } else if (options.zero == "bottom-corner") {
    setup.set_zero_anchor(v1::ZERO_ANCHOR_BOTTOM_CORNER);
  } else {
    absl::StatusOr<v1::Point3> point = ReadPoint(options.zero, "--zero");
    if (!point.ok()) {
      return absl::InvalidArgumentError(std::string(point.status().message()) +
                                        ", origin, top-center or bottom-corner");
    }
    *setup.mutable_program_zero() = *point;
  }
  if (options.stock_top) setup.mutable_stock()->set_top_z_mm(*options.stock_top);
  if (options.allowance) setup.mutable_stock()->set_allowance_mm(*options.allowance);
  if (options.allowance_walls) setup.mutable_stock()->set_wall_allowance_mm(*options.allowance_walls);
  if (options.allowance_floors) setup.mutable_stock()->set_floor_allowance_mm(*options.allowance_floors);
  if (!options.machine.empty()) {
    if (const absl::Status read = ReadMachine(options.machine, *setup.mutable_machine()); !read.ok())
      return read;
  }
  if (!options.stock.empty()) {
    ReadingOptions reading;
    reading.length_unit = length_unit;
    const absl::Status read = ReadStockBody(options.stock, reading, *setup.mutable_stock());
    if (!read.ok()) return read;
  }
  return setup;
}

v1::Strategy MakeStrategy(const std::string& name) {
  if (name == "contour") return v1::STRATEGY_CONTOUR;
  if (name == "zigzag") return v1::STRATEGY_ZIGZAG;
  return v1::STRATEGY_AUTO;
}

v1::EdgeRule MakeEdgeRule(const std::string& name) {
  if (name == "roll") return v1::EDGE_RULE_ROLL;
  if (name == "extend") return v1::EDGE_RULE_EXTEND;
  return v1::EDGE_RULE_STOP;
}

namespace {

absl::StatusOr<v1::HolderSegment> ReadSegment(const std::string& text) {
  std::vector<double> numbers;
  std::istringstream in(text);
  bool good = !text.empty() && text.back() != ',';
  for (std::string part; good && std::getline(in, part, ',');) {
    numbers.push_back(0.0);
    good = ReadFinite(part, numbers.back());
  }
  if (!good || numbers.size() < 2 || numbers.size() > 3) {
    return absl::InvalidArgumentError(
        fmt::format("--holder \"{}\": must be LENGTH,DIAMETER or LENGTH,LOWER,UPPER in mm", text));
  }
  v1::HolderSegment segment;
  segment.set_length_mm(numbers[0]);
  segment.set_lower_diameter_mm(numbers[1]);
  segment.set_upper_diameter_mm(numbers.back());
  return segment;
}

}  // namespace

absl::Status SetShank(const ShankOptions& options, v1::Tool& tool) {
  if (options.flute_length) tool.set_flute_length_mm(*options.flute_length);
  if (options.shank_diameter) tool.set_shank_diameter_mm(*options.shank_diameter);
  if (options.stickout) tool.set_stickout_mm(*options.stickout);
  if (!options.holder.empty()) tool.clear_holder();
  std::istringstream segments(options.holder);
  for (std::string text; segments >> text;) {
    absl::StatusOr<v1::HolderSegment> segment = ReadSegment(text);
    if (!segment.ok()) return segment.status();
    *tool.add_holder() = *std::move(segment);
  }
  // Nobody has said how far above the tip the holder of the file begins.
  if (options.holder.empty() && !tool.has_stickout_mm()) tool.clear_holder();
  if (options.holder_clearance) tool.set_holder_clearance_mm(*options.holder_clearance);
  return absl::OkStatus();
}

absl::StatusOr<v1::Operation> MakeOperation(const OperationOptions& options) {
  v1::Operation op;
  v1::Tool& tool = *op.mutable_tool();
  if (!options.tool.empty()) {
    absl::StatusOr<v1::Tool> read = ReadToolFile(options.tool);
    if (!read.ok()) return read.status();
    tool = *std::move(read);
  }
  tool.set_number_is_default(!options.tool_number && tool.number() == 0);
  if (options.tool_number || tool.number() == 0) tool.set_number(options.tool_number.value_or(1));
  if (options.tool_diameter || !tool.has_ball_end())
    tool.mutable_ball_end()->set_diameter_mm(options.tool_diameter.value_or(kDefaultDiameter));
  if (options.coolant != "off" || tool.coolant() == v1::COOLANT_UNSPECIFIED)
    tool.set_coolant(MakeCoolant(options.coolant));
  if (const absl::Status set = SetShank(options.shank, tool); !set.ok()) return set;
  SetCuttingData(options, tool);
  op.set_scallop_mm(options.scallop);
  op.set_tolerance_mm(options.tolerance);
  op.set_stock_to_leave_mm(options.leave);
  op.set_steep_angle_deg(options.steep_angle);
  op.set_strategy(MakeStrategy(options.strategy));
  op.set_zigzag_angle_deg(options.zigzag_angle);
  op.set_zigzag_bend_deg(options.bend);
  op.set_one_way_lines(options.one_way);
  op.set_contour_spirals(options.spirals);
  op.set_border_passes(!options.no_border_passes);
  op.set_round_lines(!options.no_round_lines);
  op.set_zigzag_angle_auto(options.auto_angle);
  op.set_edge_rule(MakeEdgeRule(options.edges));
  op.set_detail(options.detail);
  op.set_contour_direction(MakeDirection(options.direction));
  op.mutable_heights()->set_clearance_above_mm(options.clearance);
  op.mutable_heights()->set_high_rapids(options.high_rapids);
  if (options.approach_gap) op.mutable_heights()->set_approach_gap_mm(*options.approach_gap);
  if (options.lead_radius) op.mutable_leads()->set_radius_mm(*options.lead_radius);
  if (options.lead_sweep) op.mutable_leads()->set_sweep_deg(*options.lead_sweep);
  if (options.plunge_angle) op.mutable_feeds()->set_plunge_angle_deg(*options.plunge_angle);
  if (options.keep_feed) op.mutable_feeds()->set_keep_on_passes(true);
  if (options.link_feed) op.mutable_feeds()->set_link_mm_per_min(*options.link_feed);
  if (options.lead_feed) op.mutable_feeds()->set_lead_mm_per_min(*options.lead_feed);
  if (options.corner_feed) op.mutable_feeds()->set_corner_mm_per_min(*options.corner_feed);
  op.set_accept_depth_mm(options.accept_depth);
  if (options.max_unreached) {
    if (!(*options.max_unreached >= 0.0 && *options.max_unreached <= 100.0)) {
      return absl::InvalidArgumentError(
          fmt::format("--max-unreached {:g}; must be in [0, 100] percent", *options.max_unreached));
    }
    op.set_max_unreached_fraction(0.01 * *options.max_unreached);
  }
  if (options.floor) op.mutable_heights()->set_floor_z_mm(*options.floor);
  return op;
}

void AddReadingOptions(CLI::App& app, ReadingOptions& options) {
  app.add_option(
         "--length-unit", options.length_unit,
         "unit of a model file that states none (.bpt, .bv, .bez, .patches); default mm, with a finding")
      ->check(CLI::IsMember({"mm", "inch", "m"}));
  AddNumber(
      app, "--border-tolerance", options.border_tolerance,
      "CAD files: how far the borders of patches may lie from the edges of faces where they cannot follow "
      "them\nexactly, mm in the file; default 0.0001");
  app.add_option(
         "--skip-face", options.skip_faces,
         "CAD files: leave out these faces (f12), separated by commas, for instance those that cannot be "
         "read;\nthe tool keeps off a box around each, and nothing of them is finished")
      ->delimiter(',');
}

absl::StatusOr<v1::ModelSource> ReadModel(const std::string& path, const ReadingOptions& options) {
  absl::StatusOr<v1::ModelSource> source = ReadModelFile(path, options);
  if (source.ok()) NameModel(path);
  return source;
}

absl::StatusOr<v1::ModelSource> ReadModelFile(const std::string& path, const ReadingOptions& options) {
  absl::StatusOr<std::string> bytes = ReadWholeFile(path, kMaxModelFileBytes);
  if (!bytes.ok()) return bytes.status();
  v1::ModelSource source;
  v1::ModelFile& file = *source.mutable_file();
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  // Others are known by their content.
  constexpr std::string_view kStated[] = {".bpt", ".bv",  ".bez",  ".patches", ".step",
                                          ".stp", ".p21", ".iges", ".igs"};
  if (std::find(std::begin(kStated), std::end(kStated), ending) != std::end(kStated)) {
    file.set_format(ending.substr(1));
  }
  file.set_content(*std::move(bytes));
  if (!options.length_unit.empty()) file.set_length_unit(LengthUnits().at(options.length_unit));
  for (const std::string& id : options.skip_faces)
    file.mutable_import_options()->add_skip_faces(WireText(id, 200));
  if (options.border_tolerance) {
    file.mutable_import_options()->set_border_tolerance_mm(*options.border_tolerance);
  }
  return source;
}

}  // namespace patchmill::cli
