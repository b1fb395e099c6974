// One job as values: the request and the result. server/convert makes them from the messages of the wire.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cam/limits/containment.h"
#include "cam/limits/stock_depth.h"
#include "cam/link/link_paths.h"
#include "cam/path/parallel/line_frame.h"
#include "cam/plan/wall_sides.h"
#include "cam/post/program_writer.h"
#include "cam/region/map/region_map.h"
#include "cam/tool/tool.h"
#include "cam/toolpath/machine.h"
#include "cam/toolpath/motion_time.h"
#include "cam/toolpath/path_amount.h"
#include "cam/verify/verify.h"
#include "core/network/patch_model.h"

namespace patchmill {

inline constexpr double kDefaultClearanceAbove = 5.0;  // mm, above the highest of model, stock and obstacles

enum class Strategy { kAuto, kContour, kZigzag };
enum class EdgeRule { kStop, kRoll, kExtend };

// A clamp, a vice, anything that the tool has to avoid; PROGRAM frame.
struct ObstacleOutline {
  std::string id;
  Ring outline;
  double top_z = 0.0, margin = 0.0;  // mm
};

struct NoStockBody {};
struct BlockStock {
  double margin = 0.0;  // mm, beside the box of the placed model
};
struct OutlineStock {
  Ring outline;  // PROGRAM frame
};
struct CylinderStock {
  double diameter = 0.0;       // mm
  std::optional<Vec2> center;  // PROGRAM frame; default the middle of the box of the placed model
};

struct ModelStock {
  std::shared_ptr<const Surface> surface;  // placed as the model is; never null in a job that runs
  std::string digest;                      // SHA-256 of its model, 32 bytes
};

struct Setup {
  Placement placement;
  // Exactly what [machining M3] offers: a point of the placed model, or one of its box's named points.
  enum class Zero { kPoint, kTopCenter, kBottomCorner };
  Zero zero = Zero::kPoint;
  Vec3 zero_point = Vec3::Zero();  // for kPoint, placed frame; default the model's own origin
  bool zero_stated = true;         // false: the client has not said where the zero is
  // PROGRAM frame, default model top + allowance, or the top of a stock with a model of its own if that is
  // higher.
  std::optional<double> stock_top_z;
  StockDepth allowance;
  // True if the client has stated the allowance. A body of the stock has then been cut down to it over the
  // area that the surface covers as seen from above; else the body is whole.
  bool allowance_stated = false;
  std::variant<NoStockBody, BlockStock, OutlineStock, CylinderStock, ModelStock> stock_body = NoStockBody{};
  std::vector<ObstacleOutline> obstacles;
  // ChooseUp (cam/plan/choose_up.h) turns the placement once the model is known: the axis that shows most
  // points up, or the outer normal of a plane face. At most one is set.
  bool up_auto = false;
  std::string up_face = {};               // id
  std::vector<WallSide> wall_sides = {};  // of walls that nothing else decides
  // mm, > 0, of the placed model: holes of at most this diameter are capped before it is placed (CapHoles).
  std::optional<double> cap_holes = std::nullopt;
  std::optional<Machine> machine = std::nullopt;
};

// True if the client has stated what stock there is.
inline bool StockIsStated(const Setup& setup) {
  return setup.allowance_stated || !std::holds_alternative<NoStockBody>(setup.stock_body);
}

// Which part of the model is cut. A patch is named by its id, or by "#" and its index (0-based, in the order
// of the model).
struct Selection {
  std::vector<std::string> patches;  // empty: all
  std::vector<std::string> avoid;
  double avoid_margin = 0.0;   // mm between tool and avoided patches, >= 0
  std::vector<Ring> boundary;  // PROGRAM frame; empty: none
  BoundaryMode boundary_mode = BoundaryMode::kCenter;
  double boundary_offset = 0.0;  // mm, > 0 widens
  bool mill_outside = false;     // vertical walls on the outer border from outside (cam/plan/beside_part.h)
};

// A component of a region whose lines are circles.
struct CircularComponent {
  ComponentId component = kNoComponent;  // RegionMap::ComponentAt
  CircularLines lines;
  bool operator==(const CircularComponent&) const = default;
};

// How one region is cut.
struct RegionChoice {
  bool skip = false;  // not at all
  Strategy strategy = Strategy::kAuto;
  double zigzag_angle = 0.0;  // rad
  bool one_way = false;       // all its lines run along zigzag_angle, none back
  double scallop = 0.01;      // mm
  // Components whose lines are circles, whatever zigzag_angle says, in rising order.
  std::vector<CircularComponent> around;
  bool all_circular = false;  // the other components are too small for lines of their own
  bool operator==(const RegionChoice&) const = default;
};

// What the choice of one region leaves to the planner.
struct OpenChoice {
  bool angle = false;    // QuickestAngles finds zigzag_angle
  bool circles = false;  // ChooseCircularLines finds the components whose lines are circles
};

// How all regions of a map are cut, by id.
struct RegionChoices {
  std::vector<RegionChoice> choices;
  std::vector<OpenChoice> open;
};

// What is measured of one region once its choice is known (MeasureRegions).
struct RegionFigures {
  double step_min = 0.0, step_max = 0.0;  // mm, distances between neighbouring ball centres for the scallop
  double selected_share = 1.0;            // share of the area that the operation selects, 0 to 1
  double otherwise_share = 0.0;           // share of the area that the passes of the other slope cut
};

// A change to one region. The region is named by its id in the map of Operation::regions_sha256, or by a
// point on it.
struct RegionOverride {
  RegionId region = kNoRegion;  // unless `at` is given
  std::optional<Vec3> at;       // PROGRAM frame, within kPickReach of the surface
  bool skip = false;
  std::optional<Strategy> strategy;
  std::optional<double> zigzag_angle, scallop;  // absent: as the operation
  std::optional<bool> one_way;
};
inline constexpr double kPickReach = 1.0;  // mm
inline constexpr double kMinLeadSweepDeg = 10.0, kMaxLeadSweepDeg = 90.0;
inline constexpr double kDefaultMaxUnreached = 0.5;  // share, of Operation::max_unreached
inline constexpr double kMinPlungeAngleDeg = 1.0;    // the most is kDefaultPlungeAngle
inline constexpr double kMaxZigzagBendDeg = 30.0;    // of Operation::zigzag_bend

struct Operation {
  std::string id;  // the client's name for it; changes nothing
  Tool tool;
  double scallop = 0.01;
  double tolerance = 0.01;  // the whole budget
  double leave = 0.0;
  double steep_angle = Radians(45.0);
  Strategy strategy = Strategy::kAuto;
  double zigzag_angle = 0.0;
  bool one_way = false;  // zig-zag lines run along their angle only
  double zigzag_bend =
      Radians(20.0);          // rad, how far lines may turn from their angle (BendLines); 0: straight
  bool angle_auto = false;    // each region's lines in the direction that takes the least time
  bool round_lines = true;    // lines of ring-shaped regions may be circles (ChooseCircularLines)
  bool border_passes = true;  // along the borders that lines run along (BorderPasses)
  bool spirals = false;       // contours one below the other become one pass (SpiralPaths)
  double detail = RegionParams().detail;
  CutDirection contour_direction = CutDirection::kClimb;
  EdgeRule edge_rule = EdgeRule::kStop;
  // PROGRAM frame, tip heights.
  std::optional<double> clearance_z, floor_z, top_z;
  std::optional<double> clearance_above;  // mm; kDefaultClearanceAbove when neither is given
  double approach_gap = 1.0;
  // All rapids at the clearance plane. Else those between passes are as low as the stock allows, if it is
  // stated (StockIsStated).
  bool high_rapids = false;
  std::optional<double> lead_radius;  // mm; default half the ball radius
  double lead_sweep = 0.5 * kPi;      // rad
  double plunge_angle = kDefaultPlungeAngle;
  bool keep_feed = false;                       // of passes, on steep descents too; the stock must be stated
  std::optional<double> link_feed, lead_feed;   // mm/min; default that of the tool
  std::optional<double> corner_feed;            // mm/min, lowest feed of WithCornerFeeds; default: none
  double accept_depth = 0.0;                    // mm; deeper cuts than it and the allowance end the job
  double max_unreached = kDefaultMaxUnreached;  // share of what looks up, [0, 1]: UnreachedShare
  Selection selection;
  std::string regions_sha256;  // what `overrides` were made for; empty: not checked
  std::vector<RegionOverride> overrides;
};

struct Job {
  Setup setup;
  Operation operation;
  Dialect dialect = LinuxCnc();
  ProgramUnit unit = ProgramUnit::kMillimeter;  // of the program's text
  std::string work_offset = "G54";
  int program_number = 1;  // 1..9999, where the dialect numbers its programs
  // mm: by how much the control leaves the path, where the dialect has no word that says so. Unset: exact
  // stop.
  std::optional<double> control_deviation;
  bool arcs = true;                          // the program has arcs where the dialect has them
  bool restart_points = false;               // the program may be started again at them (ProgramSection)
  std::optional<int> line_number_step = {};  // default that of the dialect
  std::vector<std::string> header;           // extra comment lines (request hash, version, model name)
  bool default_cutting_data = false;         // the client used defaults: warn ([machining M5])
  bool default_tool_number = false;          // the same for the number of the tool
  bool unitless_file = false;                // warn when the extent looks wrong ([machining M14])
  PathLimits path_limits;     // what passes may come to; the service has its own (server/limits.h)
  Diagnostics model_remarks;  // warnings from its reading, points as placed: they go into the report
};

enum class Outcome {
  kComplete,
  kCompleteWhereReachable,
  kNothingToCut,
  kVerificationFailed,
  kNeedsRoughing,
  kTooMuchUnreached
};

struct StageTime {
  std::string name;
  double seconds = 0.0;
};

struct JobReport {
  Outcome outcome = Outcome::kNothingToCut;
  VerifyReport verify;
  LinkStats motion;
  std::vector<LeadFigure> leads;
  std::optional<ToolpathTimes> times;     // on Setup::machine
  double min_concave_radius = kInfinity;  // mm, smallest on the reachable side; infinity: none
  double controller_tolerance = 0.0;      // mm
  double least_cut_length = 0.0;  // mm: no passes of this finish are shorter together (LeastCutLength)
  int point_count = 0;
  std::uint64_t certificate_defects = 0;  // Locator::defect_count of the passes
  std::vector<Region> regions;
  std::vector<RegionChoice> choices;   // of each region
  std::vector<RegionFigures> figures;  // of each region
  Diagnostics diagnostics;
  std::vector<StageTime> stages;
};

struct JobResult {
  JobReport report;
  std::string program;                 // empty unless the outcome carries one
  LinkResult motion;                   // straight moves only
  Toolpath posted;                     // the motion as the program has it, with arcs
  std::vector<int> posted_lines;       // of its moves (WrittenProgram::move_lines); empty without a program
  std::vector<double> posted_seconds;  // of its moves: SecondsOf
  RegionMap regions;
  Vec3 program_zero = Vec3::Zero();
};

}  // namespace patchmill
