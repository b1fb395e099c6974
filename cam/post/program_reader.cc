#include "cam/post/program_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <absl/strings/ascii.h>
#include <fmt/format.h>

#include "cam/post/arc_chords.h"
#include "cam/post/block_use.h"
#include "cam/post/drilling_cycle.h"
#include "cam/post/gcode_modes.h"
#include "cam/post/program_lines.h"
#include "core/base/status.h"

namespace patchmill {

namespace {

constexpr double kInch = 25.4;              // mm
constexpr int kLinesBetweenPolls = 4096;    // of ReaderParams::run
constexpr double kLargestCoordinate = 1e6;  // mm; a move beyond it is an error
constexpr std::array<char, 3> kAxis = {'X', 'Y', 'Z'};
constexpr std::array<char, 3> kOffset = {'I', 'J', 'K'};

absl::Status Bad(const std::string& message) { return absl::InvalidArgumentError(message); }

// The state of the control and its motion so far.
class Interpreter {
 public:
  explicit Interpreter(const ReaderParams& params)
      : params_(params), dialect_(params_.dialect), arc_stated_(params.dialect.arcs.center_from_start) {}

  absl::Status Run(const BlockModes& block, int line);
  void SkipLine() { motion_.has_deletable_lines = true; }
  bool ended() const { return ended_; }
  ProgramMotion Take();

 private:
  absl::Status SetModes(const BlockModes& block);
  absl::Status SetPathMode(const BlockModes& block);
  double Smoothing() const;     // mm: by how much the control may leave the path now
  double BareBlending() const;  // mm: the same under a G64 without P
  bool StopsExactly() const { return path_mode_ == PathMode::kExact && !merges_ && !coarse_stop_; }
  absl::Status SetTool(const BlockModes& block);
  absl::Status SetToolName(const BlockModes& block);
  absl::Status SetOffsets(const BlockModes& block);
  absl::Status SetCompensation(const BlockModes& block);
  absl::Status CheckFeed() const;  // a feed move may begin
  absl::Status Home(const BlockModes& block);
  absl::Status Reference(const BlockModes& block);
  // Moves the named axes to places of the machine: Z above everything, X and Y to where the program frame
  // does not know them.
  absl::Status ToMachine(const BlockModes& axes, ProgramMove::Kind kind);
  absl::Status Cycle(const BlockModes& block);
  absl::Status Straight(const BlockModes& block);
  absl::Status Arc(const BlockModes& block);
  // Notes what the program leaves to the control's state, once each, when it first matters.
  void NoteAssumptions(ProgramMove::Kind kind, bool below);
  void Note(const char* code, const std::string& message) { NoteAt(line_, code, message); }
  void NotePlane(const char* motion) {
    if (plane_stated_ || dialect_.syntax == Syntax::kKlartext) return;
    Note("PLANE_ASSUMED", fmt::format("{}, and none of G17, G18 and G19 so far; taken as G17", motion));
  }
  void NoteAt(int line, const char* code, const std::string& message);
  void NoteBlock(const BlockModes& block);
  void AddWithoutEffect(const std::string& word);
  bool IsOfPost(const std::string& word) const;
  void SetFeed(const BlockModes& block);
  void UseOwnWord(const BlockModes& block);
  bool IsIncremental(const BlockModes& block, char axis) const;
  // The target of the axis words. An axis whose place is unknown is taken to start where it is first sent.
  absl::StatusOr<Vec3> Target(const BlockModes& block);
  absl::Status TooMany() const {
    return absl::ResourceExhaustedError(fmt::format("more than {} moves", params_.max_moves));
  }
  absl::Status Emit(ProgramMove::Kind kind, const Vec3& to, bool to_above, double chord_error);

  ReaderParams params_;
  const Dialect& dialect_;
  ProgramMotion motion_;
  int line_ = 0;
  int motion_mode_ = 800;
  int plane_ = 170;
  double unit_ = 1.0;  // mm
  bool incremental_ = false;
  bool arc_absolute_ = false;
  Vec3 at_ = Vec3::Zero();
  std::array<bool, 3> known_{};
  bool anywhere_ = false;         // X or Y of at_ was not known before this line
  bool above_ = true;             // Z is at machine zero, or was never stated
  double feed_ = 0.0;             // mm/min
  int feed_line_ = 0;             // line of the F in force
  bool feed_unit_stated_ = true;  // G20 or G21 was in force when it was read
  enum class PathMode { kNotStated, kExact, kBlended };
  PathMode path_mode_ = PathMode::kNotStated;
  double blending_ = 0.0;               // mm, of G64
  std::optional<double> own_blending_;  // mm, by a word of the dialect's own
  bool merges_ = false;                 // the control smooths the path by what no word limits
  bool coarse_stop_ = false;            // exact stops go on before the axes have arrived
  bool unit_stated_ = false, distance_stated_ = false, plane_stated_ = false;
  bool arc_stated_;              // what I, J and K count from is known
  int length_of_ = -1;           // H of the last G43; -1 if it had none
  int tool_ = -1, loaded_ = -1;  // T of the program and the tool in the spindle; -1 if not known yet
  std::string tool_name_;        // of a tool without a number
  int work_offset_ = 0;          // code; 0 if not stated yet
  int without_offset_ = 0;       // line that ended the work offset below machine zero; 0 if none did
  bool rotary_ = false;          // the rotary axes have been sent to zero
  std::vector<std::string> without_effect_;
  int tool_length_ = 0;                  // code; 0 if not stated yet
  int feed_mode_ = 940;                  // code
  int feed_mode_line_ = 0;               // its line
  std::optional<double> offset_number_;  // the last D of G41 or G42
  int cycle_end_ = 0;                    // G98 or G99 as code; 0 if not stated yet
  // Words that stay in force through a series of canned cycles, and the height at which the series began.
  struct Series {
    std::optional<double> r, z, q;
    double begin_z = 0.0;
    bool began_above = false;
  };
  Series series_;
  bool shifted_ = false;  // the tool or its length changed below machine zero, so Z is unknown
  bool moved_ = false, moved_below_ = false;
  double speed_ = 0.0;  // 1/min; 0 before any S, as in RS274
  bool spindle_on_ = false, reversed_ = false, coolant_on_ = false, ended_ = false;
};

// The word for a place in machine coordinates.
const char* MachineWord(Syntax syntax) {
  switch (syntax) {
    case Syntax::kRs274:
      return "G53";
    case Syntax::kSiemens:
      return "SUPA";
    case Syntax::kKlartext:
      return "M91";
  }
  return "";
}

double UnitOf(int units_code) { return units_code == 200 ? kInch : 1.0; }  // mm

absl::Status Interpreter::SetPathMode(const BlockModes& block) {
  if (!block.path) return absl::OkStatus();
  path_mode_ = *block.path == 640 ? PathMode::kBlended : PathMode::kExact;
  if (path_mode_ == PathMode::kExact) return absl::OkStatus();
  blending_ = BareBlending();
  // G64 and G641 to G645 replace what CYCLE832 has set.
  if (dialect_.syntax == Syntax::kSiemens) own_blending_.reset();
  if (block.blending) {
    own_blending_ = unit_ * *block.blending;
    return absl::OkStatus();
  }
  if (dialect_.path_tolerance.substr(0, 3) != "G64") {
    if (block['P'] || block['Q']) return Bad("G64 has no P and no Q in this dialect");
  } else if (block['P'].value_or(0.0) != 0.0) {  // for LinuxCNC P0 means that there is no limit
    // LinuxCNC merges moves within Q and blends the result within P. If Q is absent it takes Q = P.
    blending_ = unit_ * (*block['P'] + block['Q'].value_or(*block['P']));
  }
  return absl::OkStatus();
}

double Interpreter::BareBlending() const {
  if (dialect_.path_tolerance.substr(0, 3) == "G64") return kInfinity;
  return params_.control_deviation.value_or(kInfinity);
}

// A program that states nothing is judged as one with a bare G64, unless the path is assumed to be exact.
double Interpreter::Smoothing() const {
  if (dialect_.follows_exactly || StopsExactly()) return 0.0;
  if (merges_ || path_mode_ == PathMode::kExact) return BareBlending();
  if (own_blending_) return *own_blending_;
  if (path_mode_ == PathMode::kBlended) return blending_;
  return params_.assume_exact_path ? 0.0 : BareBlending();
}

absl::Status Interpreter::SetTool(const BlockModes& block) {
  if (block['T']) {
    if (!(*block['T'] <= 1e6) || *block['T'] != std::floor(*block['T'])) return Bad("T is not a tool number");
    tool_ = static_cast<int>(*block['T']);
  }
  PM_RETURN_IF_ERROR(SetToolName(block));
  if (block.tool_change && block['T'] && !tool_name_.empty())
    return Bad(
        fmt::format("T{:g} after tool \"{}\"; state every tool of the program", *block['T'], tool_name_));
  if (block.tool_change) {
    spindle_on_ = false;  // every RS274 control stops it for the change
    if (!above_) {
      Note("TOOL_CHANGE_ASSUMED", "the tool is taken to be changed above everything, anywhere in X and Y");
      above_ = true;
      known_[0] = known_[1] = shifted_ = false;
    }
  }
  if (block.tool_change && tool_ >= 0) {
    if (loaded_ >= 0 && loaded_ != tool_ && !params_.several_tools) {
      return Bad(fmt::format("M6: tool {} after tool {}; state every tool of the program", tool_, loaded_));
    }
    loaded_ = tool_;
  }
  return absl::OkStatus();
}

// A tool that has a name in place of a number. Without a tool of that name, it may be the only one.
absl::Status Interpreter::SetToolName(const BlockModes& block) {
  const std::string& name = block.tool_name;
  if (name.empty() || name == tool_name_) return absl::OkStatus();
  if (const auto found = params_.tools_by_name.find(absl::AsciiStrToLower(name));
      found != params_.tools_by_name.end()) {
    tool_ = found->second;
    return absl::OkStatus();
  }
  if (params_.several_tools) {
    return Bad(fmt::format("tool \"{}\" is none of the tools; state one of this name", name));
  }
  if (!tool_name_.empty() || loaded_ >= 0) {
    return Bad(fmt::format("tool \"{}\" after tool {}; state every tool of the program", name,
                           tool_name_.empty() ? fmt::format("{}", loaded_) : '"' + tool_name_ + '"'));
  }
  tool_name_ = name;
  Note("TOOL_NAME_ASSUMED", fmt::format("tool \"{}\" is taken to be the tool of this set-up", name));
  return absl::OkStatus();
}

absl::Status Interpreter::SetOffsets(const BlockModes& block) {
  if (block.tool_length) {
    const int of =
        *block.tool_length == 430 && block['H'] ? static_cast<int>(std::min(*block['H'], 1e9)) : -1;
    const auto entry = [&](int h) { return h < 0 ? loaded_ : h; };  // G43 without H means the loaded tool
    const bool none = !dialect_.length_offset && *block.tool_length == 490;  // there is nothing to cancel
    const bool same = *block.tool_length == tool_length_ && entry(of) == entry(length_of_);
    if (!above_ && !none && !same) shifted_ = true;
    tool_length_ = *block.tool_length;
    length_of_ = of;
  }
  if (block.work_offset) {
    if (moved_below_ && *block.work_offset != (work_offset_ == 0 ? 540 : work_offset_)) {
      return Bad(fmt::format("{}: one work offset per program", OffsetName(*block.work_offset)));
    }
    without_offset_ = 0;
    work_offset_ = *block.work_offset;
    known_[0] = known_[0] && moved_below_;
    known_[1] = known_[1] && moved_below_;
  }
  if (block.no_offset) {
    if (moved_below_) {
      without_offset_ = line_;
    } else {
      work_offset_ = 0;
    }
  }
  return absl::OkStatus();
}

// F takes effect before G20 and G21 of the same line, so it counts in the unit before them (RS274/NGC, order
// of execution; LinuxCNC's interpreter does the same).
void Interpreter::SetFeed(const BlockModes& block) {
  if (!block['F']) return;
  if (dialect_.feed_in_new_unit) {
    feed_ = *block['F'] * (block.units ? UnitOf(*block.units) : unit_);
    feed_line_ = line_;
    feed_unit_stated_ = unit_stated_ || block.units;
    return;
  }
  feed_ = *block['F'] * unit_;
  feed_line_ = line_;
  feed_unit_stated_ = unit_stated_;
  if (!unit_stated_ || !block.units || UnitOf(*block.units) == unit_) return;
  Note("FEED_IN_UNIT_BEFORE",
       fmt::format("F{:g} is on the line of G{} and counts in the unit in force before it: {:.6g} mm/min",
                   *block['F'], *block.units / 10, feed_));
}

absl::Status Interpreter::SetModes(const BlockModes& block) {
  SetFeed(block);
  if (block.units) unit_ = UnitOf(*block.units);
  unit_stated_ = unit_stated_ || block.units;
  distance_stated_ = distance_stated_ || block.distance;
  arc_stated_ = arc_stated_ || block.arc_distance;
  PM_RETURN_IF_ERROR(SetTool(block));
  if (block['S']) speed_ = *block['S'];
  if (block.spindle) {
    spindle_on_ = *block.spindle != 50;
    reversed_ = *block.spindle == 40;
  }
  if (block.coolant) coolant_on_ = *block.coolant != 90;
  if (block.plane) plane_ = *block.plane;
  plane_stated_ = plane_stated_ || block.plane;
  PM_RETURN_IF_ERROR(SetCompensation(block));
  PM_RETURN_IF_ERROR(SetOffsets(block));
  PM_RETURN_IF_ERROR(SetPathMode(block));
  if (block.feed_mode) {
    if (*block.feed_mode != feed_mode_ && !block['F']) feed_ = 0.0;
    feed_mode_ = *block.feed_mode;
    feed_mode_line_ = line_;
  }
  if (block.merges) merges_ = *block.merges;
  if (block.coarse_stop) coarse_stop_ = *block.coarse_stop;
  if (block.word) UseOwnWord(block);
  if (block.distance) incremental_ = *block.distance == 910;
  if (block.arc_distance) arc_absolute_ = *block.arc_distance == 901;
  if (block.cycle_end) cycle_end_ = *block.cycle_end;
  if (block.motion) {
    if (IsCycle(*block.motion) && !IsCycle(motion_mode_)) {
      series_ = Series();
      series_.begin_z = at_.z();
      series_.began_above = above_;
    } else if (*block.motion != motion_mode_) {
      series_.r = series_.z = series_.q = std::nullopt;
    }
    motion_mode_ = *block.motion;
  }
  return absl::OkStatus();
}

// Cutter radius compensation is harmless only if its offset is zero.
absl::Status Interpreter::SetCompensation(const BlockModes& block) {
  if (block['D']) offset_number_ = block['D'];
  if (block.compensation.value_or(400) == 400) return absl::OkStatus();
  const bool by_value = *block.compensation % 10 != 0;  // G41.1: D is a diameter, not a number
  const bool zero =
      by_value ? block['D'] == 0.0 : dialect_.d0_is_no_offset && offset_number_.value_or(0.0) == 0.0;
  if (zero) return absl::OkStatus();
  return Bad(fmt::format("G{:g}: the offset of cutter radius compensation is not in the program",
                         *block.compensation / 10.0));
}

absl::Status Interpreter::CheckFeed() const {
  if (feed_mode_ != 940) {
    return Bad(fmt::format("feed move under G{} of line {}; feeds per minute (G94) are supported",
                           feed_mode_ / 10, feed_mode_line_));
  }
  if (!(feed_ > 0.0)) return Bad("feed move without a feed rate");
  return absl::OkStatus();
}

// Whether a dialect that Patchmill brings along says the same of the word.
bool OfAShippedDialect(const BlockModes& block) {
  const auto& all = Dialects();
  return std::any_of(all.begin(), all.end(), [&](const Dialect& dialect) {
    const auto known = dialect.words.find(std::string(block.own_word));
    return known != dialect.words.end() && known->second.tolerance_letter == block.word->tolerance_letter;
  });
}

// A word of the dialect's own. What a post file of the user says of it is an assumption.
void Interpreter::UseOwnWord(const BlockModes& block) {
  if (!block.own_word.empty() && !OfAShippedDialect(block)) {
    Note("WORD_EXPLAINED",
         fmt::format("{} is taken for what [words] of the post file {} says of it, and so are "
                     "all others of that section",
                     block.own_word, dialect_.name));
  }
  if (block.word->tolerance_letter == '\0') return;
  const auto& value = block[block.word->tolerance_letter];
  own_blending_ = value ? unit_ * *value : kInfinity;
  // CYCLE832 sets the path mode and the compressor, or gives them back to the machine's own setting.
  if (dialect_.syntax != Syntax::kSiemens) return;
  path_mode_ = PathMode::kBlended;
  merges_ = false;
}

// What a block says beside its motion, and what is assumed for it.
void Interpreter::NoteBlock(const BlockModes& block) {
  for (const BlockNote& note : block.notes) Note(note.code, note.message);
  if (block.rotary && !rotary_) {
    rotary_ = true;
    if (!above_) Note("ROTARY_ASSUMED", "rotary axes go to 0; they are taken to stand there before, too");
  }
  for (const std::string& word : block.without_effect) AddWithoutEffect(word);
}

// Notes a word that neither moves nor changes the path, with the line where it first stands.
void Interpreter::AddWithoutEffect(const std::string& word) {
  constexpr std::size_t kMost = 12;
  const auto is_word = [&](const std::string& text) {
    return text.compare(0, text.rfind(" (line"), word) == 0;
  };
  if (without_effect_.size() > kMost || IsOfPost(word) ||
      std::any_of(without_effect_.begin(), without_effect_.end(), is_word))
    return;
  without_effect_.push_back(without_effect_.size() == kMost ? "and others"
                                                            : fmt::format("{} (line {})", word, line_));
}

// Whether the line has the word, and not a longer one: G8, but not G80 and not G8.1.
bool HasWord(const std::string& line, const std::string& word) {
  for (std::size_t at = line.find(word); at != std::string::npos; at = line.find(word, at + 1)) {
    const char next = at + word.size() < line.size() ? line[at + word.size()] : ' ';
    if (next != '.' && !(next >= '0' && next <= '9')) return true;
  }
  return false;
}

// Whether the post of the dialect writes the word itself.
bool Interpreter::IsOfPost(const std::string& word) const {
  const auto has = [&](const std::vector<std::string>& lines) {
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string& line) { return HasWord(line, word); });
  };
  return has(dialect_.begin) || has(dialect_.end) || has(dialect_.restart);
}

void Interpreter::NoteAt(int line, const char* code, const std::string& message) {
  for (const Diagnostic& known : motion_.assumptions) {
    if (known.code == code) return;
  }
  motion_.assumptions.push_back(MakeWarning(code, fmt::format("line {}: {}", line, message), {.line = line}));
}

void Interpreter::NoteAssumptions(ProgramMove::Kind kind, bool below) {
  if (!unit_stated_) Note("UNITS_ASSUMED", "neither G20 nor G21 so far; taken as mm, as LinuxCNC starts");
  if (kind == ProgramMove::Kind::kFeed && !feed_unit_stated_) {
    NoteAt(feed_line_, "UNITS_ASSUMED",
           "F is read while neither G20 nor G21 is in force; taken as mm/min, as LinuxCNC starts");
  }
  if (!distance_stated_) Note("DISTANCE_MODE_ASSUMED", "neither G90 nor G91 so far; taken as G90");
  if (work_offset_ == 0 && dialect_.syntax != Syntax::kKlartext) {
    Note("WORK_OFFSET_ASSUMED",
         "no work offset is in force (G54 to G59); the active one is taken as that of this set-up");
  }
  const bool own_post = !IsShipped(dialect_);
  if (own_post && dialect_.follows_exactly) {
    Note("PATH_MODE_ASSUMED",
         fmt::format("the control is taken to follow the path exactly: the post file {} says so",
                     dialect_.name));
  }
  if (!below) return;
  if (tool_length_ != 430) {
    Note("LENGTH_OFFSET_ASSUMED", "no G43 is in force; Z is taken as the tip of the right tool");
  } else if (length_of_ >= 0 && loaded_ >= 0 && length_of_ != loaded_) {
    Note(
        "LENGTH_OFFSET_OF_OTHER_TOOL",
        fmt::format("G43 H{} while T{} is in the spindle; taken as that tool's length", length_of_, loaded_));
  }
  if (kind == ProgramMove::Kind::kFeed && spindle_on_ && reversed_) {
    Note("SPINDLE_REVERSED", "M4 is in force; a right-hand cutter does not cut that way");
  }
  if (kind != ProgramMove::Kind::kFeed || dialect_.follows_exactly) return;
  const bool stated = path_mode_ != PathMode::kNotStated || own_blending_;
  if (!stated && params_.assume_exact_path) {
    Note("PATH_MODE_ASSUMED", "no word for the path so far; taken as exact, as the request says");
  } else if (!stated) {
    Note("PATH_MODE_ASSUMED",
         "no word for the path so far; taken as a G64 that states no limit, unless the path is assumed to be "
         "exact");
  }
  if (!StopsExactly() && params_.control_deviation && (!own_blending_ || merges_) &&
      Smoothing() == *params_.control_deviation) {
    Note("CONTROL_DEVIATION_ASSUMED",
         fmt::format("the control is taken to leave the path by at most {:.4g} mm: no word says so",
                     *params_.control_deviation));
  }
}

absl::Status Interpreter::Emit(ProgramMove::Kind kind, const Vec3& to, bool to_above, double chord_error) {
  if (motion_.moves.size() >= params_.max_moves) {
    return TooMany();
  }
  if (!(to.cwiseAbs().maxCoeff() <= kLargestCoordinate)) {
    return Bad(fmt::format("beyond {} mm", kLargestCoordinate));
  }
  ProgramMove move;
  move.kind = kind;
  move.from = at_;
  move.to = to;
  move.feed = kind == ProgramMove::Kind::kFeed ? feed_ : 0.0;
  move.line = line_;
  move.from_above = above_;
  move.to_above = to_above;
  move.from_anywhere = anywhere_;
  move.chord_error = chord_error;
  move.spindle_speed = spindle_on_ ? static_cast<float>(speed_) : 0.0F;
  move.coolant_on = coolant_on_;
  move.tool = loaded_;
  if (kind == ProgramMove::Kind::kFeed) {
    motion_.controller_tolerance = std::max(motion_.controller_tolerance, Smoothing());
  } else if (!(above_ && to_above)) {
    motion_.rapid_tolerance = std::max(motion_.rapid_tolerance, Smoothing());
  }
  if (!(above_ && to_above)) {
    const bool straight_up = Xy(to) == Xy(at_) && !above_ && (to_above || to.z() > at_.z());
    if (to != at_ || above_ != to_above) motion_.last_motion_is_up = straight_up;
    moved_below_ = true;
  }
  motion_.moves.push_back(move);
  moved_ = true;
  at_ = to;
  above_ = to_above;
  return absl::OkStatus();
}

// G53, SUPA, M91: to places of the machine.
absl::Status Interpreter::Home(const BlockModes& block) {
  const auto& z = block['Z'];
  const char* word = MachineWord(dialect_.syntax);
  if (!HasAxis(block)) return Bad(fmt::format("{} without coordinates", word));
  if (motion_mode_ != 0 && motion_mode_ != 10) return Bad(fmt::format("{} needs G0 or G1 in force", word));
  if (incremental_) return Bad(fmt::format("{} while G91 is in force", word));
  for (const char axis : kAxis) {
    if (block[axis] && block.axis_mode[static_cast<std::size_t>(axis - 'X')] == AxisMode::kIncremental)
      return Bad(fmt::format("{} with an incremental coordinate", word));
  }
  const double safe = params_.machine_z_safe.value_or(dialect_.machine_top);
  if (z && *z * unit_ < safe) {
    return Bad(fmt::format("{} with Z below machine {}: it is not known to be above everything", word,
                           safe == 0.0 ? "zero" : fmt::format("Z{:g}", safe)));
  }
  const double known = IsShipped(dialect_) ? dialect_.machine_top : 0.0;
  if (z && *z * unit_ < known) {
    Note("MACHINE_Z_ASSUMED",
         fmt::format("{} Z{:g} is taken as above everything, as every machine Z from {:g} mm up", word, *z,
                     safe));
  }
  if (motion_mode_ == 10) PM_RETURN_IF_ERROR(CheckFeed());
  return ToMachine(block, motion_mode_ == 0 ? ProgramMove::Kind::kRapid : ProgramMove::Kind::kFeed);
}

absl::Status Interpreter::ToMachine(const BlockModes& axes, ProgramMove::Kind kind) {
  const bool aside = axes['X'] || axes['Y'];
  if (axes['Z']) {
    if (!moved_) motion_.first_motion_is_up = !aside;
    shifted_ = false;
  }
  if (axes['Z'] || !above_) {
    anywhere_ = aside && !above_;  // nobody knows over which places the move goes
    PM_RETURN_IF_ERROR(Emit(kind, at_, axes['Z'] || above_, 0.0));
    motion_.last_motion_is_up = !anywhere_;
  }
  known_[0] = known_[0] && !axes['X'];
  known_[1] = known_[1] && !axes['Y'];
  return absl::OkStatus();
}

// G28, G30: a rapid to the coordinates in the mode in force, then the axes that are named, or all, go to the
// reference point.
absl::Status Interpreter::Reference(const BlockModes& block) {
  if (block.rotary && !HasAxis(block)) return absl::OkStatus();  // only rotary axes go there
  BlockModes axes = block;
  if (!HasAxis(block)) {
    for (const char axis : kAxis) axes.value[static_cast<std::size_t>(axis - 'A')] = 0.0;
  }
  const bool away = std::any_of(kAxis.begin(), kAxis.end(), [&](char axis) {
    return block[axis] && (!IsIncremental(block, axis) || *block[axis] != 0.0);
  });
  if (away) {
    PM_ASSIGN_OR_RETURN(const Vec3 to, Target(block));
    NoteAssumptions(ProgramMove::Kind::kRapid, !above_ || block['Z']);
    PM_RETURN_IF_ERROR(Emit(ProgramMove::Kind::kRapid, to, above_ && !block['Z'], 0.0));
  }
  const std::string word =
      dialect_.syntax == Syntax::kSiemens ? "G74 or G75" : fmt::format("G{}", *block.once / 10);
  const auto writes = [&](const std::string& line) { return line.find(word) != std::string::npos; };
  const bool numbered = block['P'].has_value();
  if (axes['Z'] && (numbered || std::none_of(dialect_.begin.begin(), dialect_.begin.end(), writes)))
    Note("REFERENCE_ASSUMED", fmt::format("the reference point of {} is taken as above everything", word));
  return ToMachine(axes, ProgramMove::Kind::kRapid);
}

bool Interpreter::IsIncremental(const BlockModes& block, char axis) const {
  const AxisMode mode = block.axis_mode[static_cast<std::size_t>(axis - 'X')];
  return mode == AxisMode::kInForce ? incremental_ : mode == AxisMode::kIncremental;
}

absl::StatusOr<Vec3> Interpreter::Target(const BlockModes& block) {
  if (without_offset_ > 0) {
    return Bad(
        fmt::format("motion after line {} has ended the work offset: the place of the part is not known",
                    without_offset_));
  }
  if (shifted_) {
    return Bad("motion after a change of tool or tool length offset below machine zero: Z is not known");
  }
  Vec3 to = at_;
  anywhere_ = !known_[0] || !known_[1];
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& word = block[kAxis[k]];
    if (!word) continue;
    const auto i = static_cast<Eigen::Index>(k);
    const bool known = known_[k] && (k < 2 || !above_);
    if (IsIncremental(block, kAxis[k])) {
      if (!known) return Bad(fmt::format("{} is incremental from an unknown place", kAxis[k]));
      to[i] = at_[i] + *word * unit_;
    } else {
      to[i] = *word * unit_;
      if (!known) at_[i] = to[i];
      known_[k] = true;
    }
  }
  return to;
}

absl::Status Interpreter::Straight(const BlockModes& block) {
  PM_ASSIGN_OR_RETURN(const Vec3 to, Target(block));
  const auto kind = motion_mode_ == 0 ? ProgramMove::Kind::kRapid : ProgramMove::Kind::kFeed;
  const bool stays_above = above_ && !block['Z'];
  NoteAssumptions(kind, !stays_above);
  return Emit(kind, to, stays_above, 0.0);
}

absl::Status Interpreter::Arc(const BlockModes& block) {
  if (above_ && (plane_ != 170 || block['Z'])) return Bad("arc from an unknown or machine-zero Z");
  const Eigen::Index first = plane_ == 170 ? 0 : plane_ == 180 ? 2 : 1;
  const Eigen::Index second = (first + 1) % 3, normal = (first + 2) % 3;
  const auto known = [&](Eigen::Index k) { return k == 2 ? !above_ : known_[static_cast<std::size_t>(k)]; };
  if (!known(first) || !known(second)) return Bad("arc from an unknown place");
  PM_ASSIGN_OR_RETURN(const Vec3 to, Target(block));
  const auto in_plane = [&](const Vec3& p) { return Vec3(p[first], p[second], p[normal]); };
  PlaneArc arc;
  arc.from = in_plane(at_);
  arc.to = in_plane(to);
  arc.clockwise = motion_mode_ == 20;
  const bool inches = unit_ == kInch && dialect_.arc_radius_slack_in > 0.0;
  arc.radius_slack = inches ? kInch * dialect_.arc_radius_slack_in : dialect_.arc_radius_slack;
  if (block.turns) {
    arc.turns = static_cast<int>(*block.turns);
  } else if (block['P'] && block.path != 640) {
    if (!(*block['P'] >= 1.0 && *block['P'] <= 1e9) || *block['P'] != std::floor(*block['P']))
      return Bad(fmt::format("P{:g} of an arc; it must be a whole number of turns, 1 or more", *block['P']));
    arc.turns = static_cast<int>(*block['P']);
  }
  NotePlane("an arc");
  const auto& i = block[kOffset[static_cast<std::size_t>(first)]];
  const auto& j = block[kOffset[static_cast<std::size_t>(second)]];
  if (block[kOffset[static_cast<std::size_t>(normal)]])
    return Bad("arc centre word outside the plane in force");
  if (block['R']) {
    if (i || j) return Bad("arc with both R and a centre");
    PM_ASSIGN_OR_RETURN(arc.center,
                        CenterFromRadius(Xy(arc.from), Xy(arc.to), *block['R'] * unit_, arc.clockwise));
  } else {
    if (!i && !j) return Bad("arc without a centre or R");
    if (arc_absolute_ && !(i && j)) return Bad("G90.1 needs both centre words");
    if (!arc_stated_) {
      Note("ARC_MODE_ASSUMED",
           "neither G90.1 nor G91.1 so far; I, J and K are taken from the arc's start (G91.1)");
    }
    arc.center = unit_ * Vec2(i.value_or(0.0), j.value_or(0.0));
    if (!arc_absolute_) arc.center += Xy(arc.from);
  }
  if (!(arc.to.cwiseAbs().maxCoeff() <= kLargestCoordinate) ||
      !(arc.center.cwiseAbs().maxCoeff() <= kLargestCoordinate)) {
    return Bad(fmt::format("beyond {} mm", kLargestCoordinate));
  }
  PM_ASSIGN_OR_RETURN(const ArcChords chords,
                      ChordArc(arc, params_.arc_chord_error, params_.max_moves - motion_.moves.size()));
  NoteAssumptions(ProgramMove::Kind::kFeed, !above_);
  for (const Vec3& p : chords.points) {
    Vec3 q;
    q[first] = p.x();
    q[second] = p.y();
    q[normal] = p.z();
    PM_RETURN_IF_ERROR(Emit(ProgramMove::Kind::kFeed, q, above_, chords.chord_error));
  }
  return absl::OkStatus();
}

absl::Status Interpreter::Cycle(const BlockModes& block) {
  if (plane_ != 170) return Bad("a canned cycle needs G17");
  if (shifted_) return Bad("a canned cycle after a change of tool length offset: Z is not known");
  if (block['L'] && (!(*block['L'] >= 1.0 && *block['L'] <= 1e6) || *block['L'] != std::floor(*block['L'])))
    return Bad("L of a canned cycle; it must be a whole number of holes, 1 or more");
  const std::pair<char, std::optional<double>*> words[] = {
      {'R', &series_.r}, {'Z', &series_.z}, {'Q', &series_.q}};
  for (const auto& [letter, word] : words) {
    if (block[letter]) *word = block[letter];
  }
  const std::string name = fmt::format("G{}", motion_mode_ / 10);
  if (!series_.r || !series_.z) return Bad(fmt::format("{} needs R and Z", name));
  const bool pecks = motion_mode_ == 730 || motion_mode_ == 830;
  if (pecks && !(series_.q.value_or(0.0) > 0.0)) return Bad(fmt::format("{} needs Q above 0", name));
  if (incremental_ && above_) return Bad(fmt::format("R of {} is incremental from an unknown place", name));
  NotePlane("a canned cycle");
  if (cycle_end_ == 0) Note("CYCLE_END_ASSUMED", "neither G98 nor G99 so far; taken as G98");
  BlockModes over = block;
  over.value['Z' - 'A'] = std::nullopt;
  const int holes = incremental_ ? static_cast<int>(block['L'].value_or(1.0)) : 1;
  for (int hole = 0; hole < holes; ++hole) {
    DrillingCycle cycle;
    PM_ASSIGN_OR_RETURN(const Vec3 to, Target(over));
    cycle.hole = Xy(to);
    cycle.from = at_;
    cycle.from_above = above_;
    cycle.retract_z = *series_.r * unit_ + (incremental_ ? at_.z() : 0.0);
    cycle.bottom_z = *series_.z * unit_ + (incremental_ ? cycle.retract_z : 0.0);
    if (cycle.bottom_z > cycle.retract_z) return Bad(fmt::format("{}: its Z is above its R", name));
    cycle.ends_above = cycle_end_ != 990 && series_.began_above;
    cycle.end_z = cycle_end_ == 990 ? cycle.retract_z : std::max(cycle.retract_z, series_.begin_z);
    NoteAssumptions(ProgramMove::Kind::kFeed, true);
    for (const CycleMove& move : ExpandCycle(cycle)) {
      PM_RETURN_IF_ERROR(Emit(move.kind, move.to, move.to_above, 0.0));
      anywhere_ = !known_[0] || !known_[1];
    }
  }
  return absl::OkStatus();
}

absl::Status Interpreter::Run(const BlockModes& block, int line) {
  line_ = line;
  PM_RETURN_IF_ERROR(CheckUse(block, motion_mode_, dialect_));
  PM_RETURN_IF_ERROR(SetModes(block));
  motion_.has_deletable_lines = motion_.has_deletable_lines || block.deletable;
  NoteBlock(block);
  if (block.without_point != '\0') {
    Note("POINT_ASSUMED",
         fmt::format("{}{:g} has no decimal point: taken as {}, and a control that is set to count "
                     "increments moves a thousandth of that or less",
                     block.without_point, *block[block.without_point], unit_ == kInch ? "inches" : "mm"));
  }
  const bool arc = IsArc(motion_mode_), cycle = IsCycle(motion_mode_);
  const bool stated = (arc || cycle) && block.motion.has_value();
  if (block.still) {
    // The coordinates are those of a word that moves nothing.
  } else if (block.once == 530) {
    PM_RETURN_IF_ERROR(Home(block));
  } else if (IsReference(block)) {
    PM_RETURN_IF_ERROR(Reference(block));
  } else if (HasAxis(block) || (HasCenter(block) && !cycle) || stated) {
    if (motion_mode_ != 0) PM_RETURN_IF_ERROR(CheckFeed());
    PM_RETURN_IF_ERROR(cycle ? Cycle(block) : arc ? Arc(block) : Straight(block));
  }
  if (block.stop == 20 || block.stop == 300) {
    spindle_on_ = coolant_on_ = false;  // every RS274 control switches them off at the end
    ended_ = true;
  }
  return absl::OkStatus();
}

ProgramMotion Interpreter::Take() {
  if (!without_effect_.empty()) {
    std::string list;
    for (const std::string& word : without_effect_) list += list.empty() ? word : fmt::format(", {}", word);
    motion_.assumptions.push_back(
        MakeInfo("WORDS_WITHOUT_EFFECT", "words that neither move the tool nor change the path: " + list));
  }
  motion_.tool_number = loaded_ >= 0 ? loaded_ : std::max(tool_, 0);
  motion_.ends_with_spindle_off = !spindle_on_;
  motion_.ends_with_coolant_off = !coolant_on_;
  return std::move(motion_);
}

absl::Status AtLine(int line, const absl::Status& status) {
  return absl::Status(status.code(), fmt::format("line {}: {}", line, std::string(status.message())));
}

}  // namespace

absl::StatusOr<ProgramMotion> ReadProgram(std::string_view text, const ReaderParams& params) {
  if (!(params.arc_chord_error > 0.0)) return Bad("arc_chord_error must be > 0 mm");
  Interpreter interpreter(params);
  ProgramLines lines(params.dialect);
  int line = 0;
  while (!text.empty() && !interpreter.ended() && !lines.ended()) {
    const std::string_view code = TakeLine(text);
    ++line;
    if (params.run != nullptr && line % kLinesBetweenPolls == 0) PM_RETURN_IF_ERROR(params.run->Check());
    if (code.size() > params.max_line_length) {
      return AtLine(line, Bad(fmt::format("longer than {} characters", params.max_line_length)));
    }
    const auto block = lines.Read(code);
    if (!block.ok()) return AtLine(line, block.status());
    if (!block->has_value()) continue;
    if ((*block)->deletable && !params.run_deletable_lines) {
      interpreter.SkipLine();
      continue;
    }
    if (const absl::Status done = interpreter.Run(**block, line); !done.ok()) return AtLine(line, done);
  }
  return interpreter.Take();
}

}  // namespace patchmill
