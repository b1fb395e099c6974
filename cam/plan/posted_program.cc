#include "cam/plan/posted_program.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "cam/post/program_assumptions.h"
#include "cam/post/program_reader.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

Diagnostic Fault(const char* code, int line, const std::string& message) {
  Where where;
  if (line > 0) where.line = line;
  return MakeError(code, message, std::move(where));
}

// What the user says of the control is no fault of the program.
bool IsStatedByUser(std::string_view code, const Dialect& dialect) {
  if (code == "LENGTH_OFFSET_ASSUMED") return !dialect.length_offset;
  return code == "CONTROL_DEVIATION_ASSUMED" || code == "MACHINE_Z_ASSUMED" || code == "WORD_EXPLAINED" ||
         (code == "PATH_MODE_ASSUMED" && dialect.follows_exactly) || code == "FEED_IN_UNIT_BEFORE";
}

// The first assumption that the program itself should have ruled out; nullptr if there is none.
const Diagnostic* LeftToControl(const ProgramMotion& motion, const Dialect& dialect) {
  const auto found =
      std::find_if(motion.assumptions.begin(), motion.assumptions.end(),
                   [&](const Diagnostic& assumption) { return !IsStatedByUser(assumption.code, dialect); });
  return found == motion.assumptions.end() ? nullptr : &*found;
}

const ProgramMove* FirstFeed(const ProgramMotion& motion) {
  const auto found = std::find_if(motion.moves.begin(), motion.moves.end(), [](const ProgramMove& move) {
    return move.kind == ProgramMove::Kind::kFeed;
  });
  return found == motion.moves.end() ? nullptr : &*found;
}

// The beginnings of the lines of a text: entry k is that of line k + 1.
std::vector<std::size_t> LineBegins(std::string_view text) {
  std::vector<std::size_t> begins = {0};
  for (std::size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + 1))
    begins.push_back(at + 1);
  return begins;
}

// The program that the control runs if it is started at the restart point. A Heidenhain control has the
// unit from the first line of the whole program.
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

// What is wrong with the start; empty if nothing is.
std::string FaultOf(const absl::StatusOr<ProgramMotion>& tail, const ProgramMotion& whole,
                    const Dialect& dialect) {
  if (!tail.ok())
    return fmt::format("it cannot be read as a program: {}", std::string(tail.status().message()));
  const ProgramMove* const feed = FirstFeed(*tail);
  if (feed == nullptr) return "";
  if (!tail->first_motion_is_up) return "the first motion is not straight up to machine zero";
  const ProgramMove& usual = *FirstFeed(whole);
  if (feed->spindle_speed != usual.spindle_speed) {
    return fmt::format("the spindle turns at {:g} rpm, and at {:g} in the whole program", feed->spindle_speed,
                       usual.spindle_speed);
  }
  if (feed->coolant_on != usual.coolant_on)
    return fmt::format("the coolant is {}, unlike in the whole program", feed->coolant_on ? "on" : "off");
  if (const Diagnostic* const left = LeftToControl(*tail, dialect))
    return "a mode is left to the control: " + left->message;
  return "";
}

}  // namespace

absl::StatusOr<Diagnostics> CheckPosted(const WrittenProgram& written, const ProgramMotion& whole,
                                        const Job& job, const RunContext& run) {
  const Dialect& dialect = job.dialect;
  const Tool& tool = job.operation.tool;
  Diagnostics faults;
  const ProgramMove* const feed = FirstFeed(whole);
  if (feed == nullptr) return faults;
  // A program that calls no tool has -1 here.
  const auto other_tool = std::find_if(whole.moves.begin(), whole.moves.end(), [&](const ProgramMove& move) {
    return move.tool >= 0 && move.tool != tool.number;
  });
  if (other_tool != whole.moves.end()) {
    faults.push_back(
        Fault("POST_OTHER_TOOL", other_tool->line,
              fmt::format("the post file {} calls tool {}, and the job has T{}: write {{tool}} there",
                          dialect.name, other_tool->tool, tool.number)));
  }
  const auto other_speed = std::find_if(whole.moves.begin(), whole.moves.end(), [&](const ProgramMove& move) {
    // S may be rounded to whole revolutions.
    return move.kind == ProgramMove::Kind::kFeed &&
           std::abs(move.spindle_speed - job.operation.tool.spindle_rpm) > 1.0;
  });
  if (other_speed != whole.moves.end() && other_speed->spindle_speed > 0.0F) {
    faults.push_back(
        Fault("POST_OTHER_SPEED", other_speed->line,
              fmt::format("line {}: the post file {} lets the spindle turn at {:g} rpm, and the job has "
                          "{:g}: write {{speed}} there",
                          other_speed->line, dialect.name, other_speed->spindle_speed,
                          job.operation.tool.spindle_rpm)));
  }
  if (const Diagnostic* const left = LeftToControl(whole, dialect)) {
    faults.push_back(
        Fault("POST_LEAVES_TO_CONTROL", left->where.line.value_or(0),
              fmt::format("the post file {} leaves to the control what the program must state: {}",
                          dialect.name, left->message)));
  }
  const std::vector<std::size_t> begins =
      written.restarts.empty() ? std::vector<std::size_t>() : LineBegins(written.text);
  for (std::size_t k = 0; k < written.restarts.size(); ++k) {
    PM_RETURN_IF_ERROR(run.Check());
    ReaderParams params;
    params.max_moves = std::max(params.max_moves, whole.moves.size() + 1);
    params.run = &run;
    params.dialect = dialect;
    params.control_deviation = job.control_deviation;
    const auto tail = ReadProgram(TailOf(written, begins, written.restarts[k], dialect), params);
    PM_RETURN_IF_ERROR(run.Check());
    const std::string fault = FaultOf(tail, whole, dialect);
    if (fault.empty()) continue;
    const int line = written.restarts[k].first_line;
    faults.push_back(
        Fault("RESTART_INCOMPLETE", line,
              fmt::format("restart point {}, line {}: with [restart] of the post file {} as the start of a "
                          "program, {}",
                          k + 1, line, dialect.name, fault)));
    break;
  }
  return faults;
}

}  // namespace patchmill
