#include "cam/plan/check_post.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "cam/plan/posted_program.h"
#include "cam/post/program_assumptions.h"
#include "cam/post/program_lines.h"
#include "cam/post/program_reader.h"

namespace patchmill {
namespace {

// The lines of a post file that say something, with their numbers.
std::vector<PostCheck::OwnLine> SpeakingLines(std::string_view text) {
  std::vector<PostCheck::OwnLine> lines;
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = TakeLine(text);
    const std::size_t begin = line.find_first_not_of(" \t"), end = line.find_last_not_of(" \t");
    if (begin == line.npos || line[begin] == '#') continue;
    lines.push_back({number, std::string(line.substr(begin, end - begin + 1))});
  }
  return lines;
}

// Fills the fields about `base` for one candidate, and returns how many lines both have.
std::size_t Compare(std::string_view text, const Dialect& base, PostCheck& check) {
  std::map<std::string, int> left;
  std::vector<PostCheck::OwnLine> base_lines = SpeakingLines(base.text);
  for (const PostCheck::OwnLine& line : base_lines) ++left[line.text];
  check.base = base.name;
  check.own_lines.clear();
  check.missing_lines.clear();
  std::size_t shared = 0;
  for (PostCheck::OwnLine& line : SpeakingLines(text)) {
    const auto found = left.find(line.text);
    if (found != left.end() && found->second > 0) {
      --found->second;
      ++shared;
    } else {
      check.own_lines.push_back(std::move(line));
    }
  }
  for (PostCheck::OwnLine& line : base_lines) {
    const auto found = left.find(line.text);
    if (found->second == 0) continue;
    --found->second;
    check.missing_lines.push_back(std::move(line.text));
  }
  return shared;
}

void FindBase(std::string_view text, PostCheck& check) {
  std::size_t most = 0;
  PostCheck best;
  for (const Dialect& dialect : Dialects()) {
    PostCheck candidate;
    const std::size_t shared = Compare(text, dialect, candidate);
    if (shared <= most) continue;
    most = shared;
    best = std::move(candidate);
  }
  check.base = std::move(best.base);
  check.own_lines = std::move(best.own_lines);
  check.missing_lines = std::move(best.missing_lines);
}

// A short path in the air, and the job whose program it is.
Toolpath SmallPath() {
  Toolpath path;
  path.ball_radius = 3.0;
  path.moves = {{.kind = MoveKind::kRapid, .to = Vec3(1, 2, 30)},
                {.kind = MoveKind::kRapid, .to = Vec3(4, 6, 30)},
                {.kind = MoveKind::kPlunge, .to = Vec3(4, 6, 20), .feed = 100.0},
                {.kind = MoveKind::kCut, .to = Vec3(14, 6, 20), .feed = 200.0},
                {.kind = MoveKind::kRapid, .to = Vec3(14, 6, 30)}};
  return path;
}

Job SmallJob(const Dialect& dialect) {
  Job job;
  job.dialect = dialect;
  Tool& tool = job.operation.tool;
  tool.cutter = BallEnd{3.0};
  tool.number = 7;
  tool.spindle_rpm = 1234.0;
  if (!dialect.flood_on.empty()) tool.coolant = Coolant::kFlood;
  return job;
}

PostParams ParamsOf(const Job& job, ProgramUnit unit) {
  PostParams params;
  params.dialect = job.dialect;
  params.unit = unit;
  params.work_offset = job.work_offset;
  params.clearance_z = 30.0;
  const Dialect& dialect = job.dialect;
  if (!dialect.path_tolerance.empty()) params.controller_tolerance = std::max(0.01, dialect.least_tolerance);
  params.restart_points = !dialect.restart.empty();
  params.sections = {{.first_move = 1, .comment = "pass", .restart = params.restart_points}};
  return params;
}

std::string LineOf(std::string_view text, const std::string& message) {
  int line = 0;
  for (const char c : message.substr(std::min<std::size_t>(message.size(), 5))) {
    if (c < '0' || c > '9') break;
    line = std::min(10 * line + (c - '0'), 1'000'000);
  }
  std::string_view found;
  for (int k = 0; k < line && !text.empty(); ++k) found = TakeLine(text);
  return std::string(found);
}

// Without "line 12: " before it.
std::string Bare(const std::string& message) {
  const std::size_t colon = message.find(": ");
  return message.compare(0, 5, "line ") == 0 && colon != message.npos ? message.substr(colon + 2) : message;
}

// The line of the post file that wrote a line of the program; 0 if that is not sure.
int SourceOf(std::string_view post, std::string line) {
  if (line.size() > 1 && line[0] == 'N' && line.find(' ') != line.npos) line.erase(0, line.find(' ') + 1);
  int found = 0;
  for (const PostCheck::OwnLine& own : SpeakingLines(post)) {
    if (own.text == line) found = found == 0 ? own.line : found;
  }
  return found;
}

void CheckProgram(const Job& job, ProgramUnit unit, std::string_view post, PostCheck& check) {
  const auto add = [&](const std::string& program, const std::string& message) {
    const std::string line = LineOf(program, message);
    const std::string said = line.empty() ? Bare(message) : fmt::format("\"{}\": {}", line, Bare(message));
    const PostFault fault{SourceOf(post, line), "in the program that it writes: " + said};
    const bool known = std::any_of(check.faults.begin(), check.faults.end(), [&](const PostFault& other) {
      return other.line == fault.line && other.message == fault.message;
    });
    if (!known) check.faults.push_back(fault);
  };
  const auto written = WriteProgramWithLines(SmallPath(), job.operation.tool, ParamsOf(job, unit));
  if (!written.ok()) return add("", std::string(written.status().message()));
  const auto motion = ReadProgram(written->text, {.dialect = job.dialect});
  if (!motion.ok()) return add(written->text, std::string(motion.status().message()));
  if (!motion->first_motion_is_up) add("", "the first motion is not straight up to machine zero");
  if (!motion->last_motion_is_up) add("", "the last motion is not straight up");
  const auto faults = CheckPosted(*written, *motion, job, RunContext());
  if (!faults.ok()) return;
  for (const Diagnostic& fault : *faults) {
    const int line = fault.where.line.value_or(0);
    add(written->text, line > 0 ? fmt::format("line {}: {} {}", line, fault.code, fault.message)
                                : fmt::format("{} {}", fault.code, fault.message));
  }
  const std::vector<std::string> codes = AssumptionCodes(motion->assumptions);
  for (const Diagnostic& finding : motion->assumptions) {
    const bool assumed = std::find(codes.begin(), codes.end(), finding.code) != codes.end();
    const std::string sentence = fmt::format("{}: {}", finding.code, Bare(finding.message));
    std::vector<std::string>& left = check.left_to_control;
    if (assumed && faults->empty() && std::find(left.begin(), left.end(), sentence) == left.end())
      left.push_back(sentence);
  }
}

void AddPathOf(const Dialect& dialect, PostCheck& check) {
  if (!dialect.follows_exactly && dialect.path_tolerance.empty()) {
    check.left_to_control.push_back(fmt::format(
        "no word limits how far the control leaves the path: programs use \"{}\"{}", dialect.exact_path,
        dialect.assumed_path.empty()
            ? ""
            : fmt::format(", or \"{}\" with --control-deviation", dialect.assumed_path)));
  }
  if (!dialect.length_offset)
    check.left_to_control.push_back(
        "the length of the tool: the control has no length offsets (length_offset = no)");
  if (dialect.restart.empty())
    check.left_to_control.push_back("nothing at restart points: [restart] is missing");
}

}  // namespace

PostCheck CheckPostFile(std::string_view text) {
  PostCheck check;
  ReadPost post = ReadPostFile(text);
  check.faults = std::move(post.faults);
  check.name = post.dialect.name;
  if (text.size() > kLongestPostFile) return check;
  FindBase(text, check);
  if (!check.faults.empty()) return check;
  const Job job = SmallJob(post.dialect);
  CheckProgram(job, ProgramUnit::kMillimeter, text, check);
  if (HasUnit(post.dialect, ProgramUnit::kInch)) CheckProgram(job, ProgramUnit::kInch, text, check);
  AddPathOf(post.dialect, check);
  return check;
}

}  // namespace patchmill
