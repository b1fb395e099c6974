#include "cam/plan/posted_program.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "cam/post/program_assumptions.h"
#include "cam/post/program_lines.h"
#include "cam/post/program_reader.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

struct Fault {
  const char* code;
  int line;  // 0: no line of the program
  std::string message;
};

// True if the user has stated it of the control: then the program owes no word for it.
bool IsStatedByUser(std::string_view code, const Dialect& dialect) {
  if (code == "LENGTH_OFFSET_ASSUMED") return !dialect.length_offset;
  return code == "CONTROL_DEVIATION_ASSUMED" || code == "MACHINE_Z_ASSUMED" || code == "WORD_EXPLAINED" ||
         code == "REFERENCE_ASSUMED" || (code == "PATH_MODE_ASSUMED" && dialect.follows_exactly) ||
         code == "FEED_IN_UNIT_BEFORE" || code == "WORD_ASSUMED" || code == "WORDS_WITHOUT_EFFECT";
}

// The first assumption that the program itself should have ruled out; nullptr if there is none.
const Diagnostic* LeftToControl(const ProgramMotion& motion, const Dialect& dialect) {
  const auto found =
      std::find_if(motion.assumptions.begin(), motion.assumptions.end(),
                   [&](const Diagnostic& assumption) { return !IsStatedByUser(assumption.code, dialect); });
  return found == motion.assumptions.end() ? nullptr : &*found;
}

// A message without the "line 12: " before it.
std::string WithoutLine(const std::string& message) {
  const std::size_t colon = message.find(": ");
  return message.compare(0, 5, "line ") == 0 && colon != message.npos ? message.substr(colon + 2) : message;
}

// The beginnings of the lines of a text: entry k is that of line k + 1.
std::vector<std::size_t> LineBegins(std::string_view text) {
  std::vector<std::size_t> begins = {0};
  for (std::size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + 1))
    begins.push_back(at + 1);
  return begins;
}

// The program that the control runs if it is started at the restart point. A Heidenhain control has the unit
// from the first line of the whole program.
std::string TailOf(const WrittenProgram& written, const std::vector<std::size_t>& begins,
                   const WrittenProgram::Restart& restart, const Dialect& dialect) {
  const std::string_view text = written.text;
  const auto begin_of = [&](int line) {
    const auto k = static_cast<std::size_t>(std::max(line, 1) - 1);
    return k < begins.size() ? begins[k] : text.size();
  };
  const std::size_t begin = begin_of(restart.first_line);
  std::string tail;
  if (dialect.syntax == Syntax::kKlartext) tail = text.substr(0, begin_of(2));
  tail += text.substr(begin, begin_of(restart.end_line) - begin);
  return tail;
}

// Reads the words of a program, block by block, for what the motion does not tell.
class WordCheck {
 public:
  explicit WordCheck(const Job& job) : job_(job), dialect_(job.dialect) {}

  // The first fault of the text up to the end; empty if there is none.
  std::optional<Fault> FirstFault(std::string_view text) {
    ProgramLines lines(dialect_);
    int line = 0;
    while (!text.empty() && !lines.ended()) {
      ++line;
      const auto block = lines.Read(TakeLine(text));
      if (!block.ok() || !block->has_value()) continue;
      if (std::optional<Fault> fault = FaultOf(**block, line)) return fault;
    }
    return std::nullopt;
  }

 private:
  std::optional<Fault> FaultOf(const BlockModes& block, int line) {
    // Presets of a Heidenhain control are not among the job's work offsets.
    const bool preset = dialect_.syntax == Syntax::kKlartext;
    if (block.work_offset && !preset && OffsetName(*block.work_offset) != job_.work_offset) {
      return Fault{"POST_OTHER_OFFSET", line,
                   fmt::format("the post file {} chooses {}, and the job has {}: write {{work_offset}} there",
                               dialect_.name, OffsetName(*block.work_offset), job_.work_offset)};
    }
    const int number = job_.operation.tool.number;
    if (dialect_.syntax != Syntax::kRs274) return std::nullopt;
    if (block.tool_length == 430 && block['H'].value_or(-1.0) != number) {
      return Fault{
          "POST_OTHER_OFFSET", line,
          fmt::format(
              "the post file {} has {}, and the job's tool is T{}: write H{{tool}} there", dialect_.name,
              block['H'] ? fmt::format("G43 H{:g}", *block['H']) : std::string("G43 without H"), number)};
    }
    g94_ = g94_ || block.feed_mode == 940;
    g40_ = g40_ || block.compensation == 400;
    g80_ = g80_ || block.motion == 800 || block.ends_cycles;
    if (block.motion) feeds_ = *block.motion != 0 && *block.motion != 800;
    const bool moves = block['X'] || block['Y'] || block['Z'];
    if (!feeds_ || !moves || (g94_ && g40_ && g80_)) return std::nullopt;
    const char* missing = !g94_   ? "G94 (feeds per minute)"
                          : !g40_ ? "G40 (no radius compensation)"
                                  : "G80 (no cycle)";
    return Fault{"POST_LEAVES_TO_CONTROL", line,
                 fmt::format("the post file {} states no {} before the first feed", dialect_.name, missing)};
  }

  const Job& job_;
  const Dialect& dialect_;
  bool g94_ = false, g40_ = false, g80_ = false, feeds_ = false;
};

// The faults of a program of the job beside its path.
std::vector<Fault> FaultsOf(std::string_view text, const ProgramMotion& motion, const Job& job) {
  const Dialect& dialect = job.dialect;
  const Tool& tool = job.operation.tool;
  std::vector<Fault> faults;
  const ProgramMove* last_feed = nullptr;
  const ProgramMove* other_speed = nullptr;
  const double speed = std::max(1.0, tool.spindle_rpm);
  for (const ProgramMove& move : motion.moves) {
    if (move.kind != ProgramMove::Kind::kFeed) continue;
    last_feed = &move;
    // S is rounded to whole revolutions. Feeds with the spindle still are the verifier's.
    if (other_speed == nullptr && move.spindle_speed > 0.0F && std::abs(move.spindle_speed - speed) > 0.51)
      other_speed = &move;
  }
  if (last_feed == nullptr) return faults;
  // A program that calls no tool has -1 here.
  const auto other_tool =
      std::find_if(motion.moves.begin(), motion.moves.end(),
                   [&](const ProgramMove& move) { return move.tool >= 0 && move.tool != tool.number; });
  if (other_tool != motion.moves.end()) {
    faults.push_back({"POST_OTHER_TOOL", other_tool->line,
                      fmt::format("the post file {} calls tool {}, and the job has T{}: write {{tool}} there",
                                  dialect.name, other_tool->tool, tool.number)});
  }
  if (other_speed != nullptr) {
    faults.push_back({"POST_OTHER_SPEED", other_speed->line,
                      fmt::format("the post file {} lets the spindle turn at {:g} rpm, and the job has {:g}: "
                                  "write {{speed}} there",
                                  dialect.name, other_speed->spindle_speed, speed)});
  }
  const std::string coolant = CoolantLine(dialect, tool.coolant);
  const bool known =
      coolant.empty() || coolant.find("M7") != coolant.npos || coolant.find("M8") != coolant.npos;
  if (known && last_feed->coolant_on == coolant.empty()) {
    faults.push_back(
        {"POST_OTHER_COOLANT", last_feed->line,
         fmt::format("with the post file {} the coolant is {} while feeding, unlike in the job: write "
                     "{{coolant}} where it starts",
                     dialect.name, last_feed->coolant_on ? "on" : "off")});
  }
  if (std::optional<Fault> fault = WordCheck(job).FirstFault(text)) faults.push_back(*std::move(fault));
  if (const Diagnostic* const left = LeftToControl(motion, dialect)) {
    faults.push_back({"POST_LEAVES_TO_CONTROL", left->where.line.value_or(0),
                      fmt::format("the post file {} leaves to the control what the program must state: {}",
                                  dialect.name, WithoutLine(left->message))});
  }
  return faults;
}

// The fault of a start at a restart point; empty if there is none.
std::string FaultOfStart(const std::string& text, const absl::StatusOr<ProgramMotion>& tail, const Job& job) {
  if (!tail.ok())
    return fmt::format("it cannot be read: {}", WithoutLine(std::string(tail.status().message())));
  const bool feeds = std::any_of(tail->moves.begin(), tail->moves.end(), [](const ProgramMove& move) {
    return move.kind == ProgramMove::Kind::kFeed;
  });
  if (!feeds) return "";
  if (!tail->first_motion_is_up) return "the first motion is not straight up to machine zero";
  const bool still = std::any_of(tail->moves.begin(), tail->moves.end(), [](const ProgramMove& move) {
    return move.kind == ProgramMove::Kind::kFeed && move.spindle_speed == 0.0F;
  });
  if (still) return "the spindle stands still at a feed";
  const std::vector<Fault> faults = FaultsOf(text, *tail, job);
  return faults.empty() ? "" : faults.front().message;
}

}  // namespace

absl::StatusOr<Diagnostics> CheckPosted(const WrittenProgram& written, const ProgramMotion& whole,
                                        const Job& job, const RunContext& run) {
  const Dialect& dialect = job.dialect;
  Diagnostics errors;
  const auto add = [&](const Fault& fault) {
    Where where;
    if (fault.line > 0) where.line = fault.line;
    errors.push_back(MakeError(fault.code, fault.message, std::move(where)));
  };
  for (const Fault& fault : FaultsOf(written.text, whole, job)) add(fault);
  const std::vector<std::size_t> begins =
      written.restarts.empty() ? std::vector<std::size_t>() : LineBegins(written.text);
  for (std::size_t k = 0; k < written.restarts.size(); ++k) {
    PM_RETURN_IF_ERROR(run.Check());
    ReaderParams params;
    params.max_moves = std::max(params.max_moves, whole.moves.size() + 1);
    params.run = &run;
    params.dialect = dialect;
    params.control_deviation = job.control_deviation;
    const std::string text = TailOf(written, begins, written.restarts[k], dialect);
    const auto tail = ReadProgram(text, params);
    PM_RETURN_IF_ERROR(run.Check());
    const std::string fault = FaultOfStart(text, tail, job);
    if (fault.empty()) continue;
    const int line = written.restarts[k].first_line;
    add({"RESTART_INCOMPLETE", line,
         fmt::format("restart point {}: read as the start of a program, as a control may: {}", k + 1,
                     fault)});
    break;
  }
  return errors;
}

}  // namespace patchmill
