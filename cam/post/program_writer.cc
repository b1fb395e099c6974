#include "cam/post/program_writer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cam/post/dialect.h"
#include "cam/post/number_format.h"
#include "cam/post/post_template.h"
#include "core/base/status.h"

namespace patchmill {

namespace {

constexpr double kLargestCoordinate = 1e6;  // mm
constexpr int kLargestLineNumber = 99'999;  // of N words; then they begin again
constexpr std::array<const char*, 3> kAxis = {"X", "Y", "Z"};
using Ticks = std::array<std::int64_t, 3>;

struct RoundedMove {
  bool rapid = false;
  Ticks to{};
  double feed = 0.0;
};

absl::Status Validate(const Toolpath& toolpath, const Tool& tool, const PostParams& params) {
  const auto bad = [](const std::string& message) { return absl::InvalidArgumentError(message); };
  if (params.program_number < 1 || params.program_number > 9999) {
    return bad(fmt::format("post.program_number = {}; must be in [1, 9999]", params.program_number));
  }
  if (!IsWorkOffset(params.work_offset)) {
    return bad(fmt::format("post.work_offset = \"{}\"; must be G54 to G59", params.work_offset));
  }
  if (!(params.controller_tolerance >= 0.0) || !std::isfinite(params.controller_tolerance)) {
    return bad(fmt::format("controller_tolerance = {} mm; must be >= 0", params.controller_tolerance));
  }
  if (!(tool.spindle_rpm > 0.0) || !(tool.spindle_rpm <= 1e6)) {
    return bad(fmt::format("tool.spindle_rpm = {}; must be in (0, 1e6]", tool.spindle_rpm));
  }
  if (tool.number < 1 || tool.number > 99999) {
    return bad(fmt::format("tool.number = {}; must be in [1, 99999]", tool.number));
  }
  if (tool.coolant != Coolant::kOff && CoolantLine(params.dialect, tool.coolant).empty()) {
    return bad(fmt::format("tool.coolant: the dialect {} has no word for it", params.dialect.name));
  }
  if (toolpath.moves.empty()) return bad("toolpath: no moves; nothing to write");
  const double largest =
      kLargestCoordinate - params.program_zero.cwiseAbs().maxCoeff() - toolpath.ball_radius;
  if (!std::isfinite(largest) || !std::isfinite(params.clearance_z) ||
      !(std::abs(params.clearance_z) <= largest)) {
    return bad(fmt::format("program zero, ball radius or clearance beyond {} mm", kLargestCoordinate));
  }
  for (std::size_t i = 0; i < toolpath.moves.size(); ++i) {
    const Move& move = toolpath.moves[i];
    if (!move.to.allFinite() || !(move.to.cwiseAbs().maxCoeff() <= largest)) {
      return bad(fmt::format("moves[{}].to is not within {} mm", i, kLargestCoordinate));
    }
    if (move.kind != MoveKind::kRapid && !(move.feed > 0.0 && move.feed <= 1e6)) {
      return bad(fmt::format("moves[{}].feed = {} mm/min; must be in (0, 1e6]", i, move.feed));
    }
  }
  return absl::OkStatus();
}

// Turns centres into rounded tips in the program frame. The first move is a rapid to the place over the first
// point, at the clearance plane or higher. Moves that vanish in rounding are dropped.
std::vector<RoundedMove> RoundMoves(const Toolpath& toolpath, const PostParams& params, int decimals) {
  const auto ticks = [&](const Vec3& centre) {
    const Vec3 tip = centre - Vec3(0, 0, toolpath.ball_radius) - params.program_zero;
    return Ticks{ToTicks(tip.x(), decimals), ToTicks(tip.y(), decimals), ToTicks(tip.z(), decimals)};
  };
  const std::int64_t clearance = ToTicks(params.clearance_z - params.program_zero.z(), decimals);
  std::vector<RoundedMove> moves;
  moves.reserve(toolpath.moves.size() + 2);
  Ticks at = ticks(toolpath.moves.front().to);
  at[2] = std::max(at[2], clearance);
  moves.push_back({.rapid = true, .to = at});
  for (const Move& move : toolpath.moves) {
    const Ticks to = ticks(move.to);
    if (to == at) continue;
    moves.push_back({.rapid = move.kind == MoveKind::kRapid, .to = to, .feed = move.feed});
    at = to;
  }
  if (at[2] < clearance) {
    at[2] = clearance;
    moves.push_back({.rapid = true, .to = at});
  }
  return moves;
}

// A coordinate as a program has it.
std::string PlaceText(const Dialect& dialect, std::int64_t ticks) {
  const bool plus = dialect.syntax == Syntax::kKlartext && ticks >= 0;
  return fmt::format("{}{}", plus ? "+" : "", FormatTicks(ticks, dialect.decimals));
}

// Writes blocks without repeating modal words.
class BlockWriter {
 public:
  explicit BlockWriter(const Dialect& dialect) : dialect_(dialect) {}

  // A line without a number, where lines need none.
  void Bare(std::string_view text) {
    if (IsKlartext()) text_ += fmt::format("{} ", number_++);  // every line is a numbered block
    text_ += text;
    text_ += dialect_.line_end;
  }
  void Line(std::string_view text) {
    const bool numbered = dialect_.line_number_step > 0 && text != "%" && text.front() != 'O';
    if (numbered && !IsKlartext()) {
      number_ += dialect_.line_number_step;
      if (number_ > kLargestLineNumber) number_ = dialect_.line_number_step;
      text_ += fmt::format("N{} ", number_);
    }
    Bare(text);
  }
  bool IsKlartext() const { return dialect_.syntax == Syntax::kKlartext; }
  // The position to which the lines before have sent the tool by G0.
  void StartAt(const Ticks& at) { at_ = at; }
  void Go(const RoundedMove& move) {
    std::string block;
    const auto add = [&](std::string_view word) {
      if (!block.empty()) block += ' ';
      block += word;
    };
    if (IsKlartext()) {
      add("L");
    } else if (move.rapid != rapid_) {
      add(move.rapid ? "G0" : "G1");
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (move.to[k] != at_[k]) add(kAxis[k] + PlaceText(dialect_, move.to[k]));
    }
    if (IsKlartext() && move.rapid) add("FMAX");
    if (!move.rapid && (rapid_ || move.feed != feed_)) {
      std::string feed = FormatShort(std::max(move.feed, 1e-4), 4);
      if (dialect_.feed_point && feed.find('.') == std::string::npos) feed += '.';
      add("F" + feed);
      feed_ = move.feed;
    }
    rapid_ = move.rapid;
    at_ = move.to;
    Line(block);
  }
  std::string Take() { return std::move(text_); }

 private:
  const Dialect& dialect_;
  std::string text_;
  int number_ = 0;
  Ticks at_{};
  bool rapid_ = true;
  double feed_ = 0.0;
};

std::string ToolLine(const Tool& tool) {
  std::string line = fmt::format("tool T{}: ball D {}", tool.number, FormatShort(2.0 * BallRadius(tool), 4));
  if (!tool.name.empty()) line += ", " + tool.name;
  if (tool.flute_length) line += ", flute " + FormatShort(*tool.flute_length, 3);
  if (tool.shank_diameter) line += ", shank D " + FormatShort(*tool.shank_diameter, 3);
  if (tool.stickout) line += ", stick-out " + FormatShort(*tool.stickout, 3);
  return line;
}

std::vector<std::string> HeaderTexts(const std::vector<RoundedMove>& moves, const Tool& tool,
                                     const PostParams& params, const Dialect& dialect) {
  Ticks low = moves.front().to, high = low;
  for (const RoundedMove& move : moves) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], move.to[k]);
      high[k] = std::max(high[k], move.to[k]);
    }
  }
  std::vector<std::string> texts = params.header;
  texts.push_back("units MM, feeds MM per minute; X Y Z is the tool tip, the lowest point of the ball");
  const auto zero = [&](int k) {
    return FormatTicks(ToTicks(params.program_zero[k], dialect.decimals), dialect.decimals);
  };
  const bool chooses = std::any_of(dialect.begin.begin(), dialect.begin.end(), [](const std::string& line) {
    return line.find("{work_offset}") != std::string::npos;
  });
  texts.push_back(fmt::format(
      "zero: {}, at X{} Y{} Z{} of the placed model; {}", params.zero_name, zero(0), zero(1), zero(2),
      chooses ? "work offset " + params.work_offset : std::string("the program chooses no work offset")));
  std::string range = "tip of all moves below machine zero:";
  for (std::size_t k = 0; k < 3; ++k) {
    range += fmt::format(" {} {} to {}", kAxis[k], FormatTicks(low[k], dialect.decimals),
                         FormatTicks(high[k], dialect.decimals));
    if (k < 2) range += ",";
  }
  texts.push_back(std::move(range));
  texts.push_back(ToolLine(tool));
  return texts;
}

// The line that says how far the control may leave the path. The tolerance is rounded down, so that the
// control does not get more than its share of the budget.
std::string PathLine(const Dialect& dialect, double tolerance) {
  if (dialect.follows_exactly) return {};
  if (dialect.path_tolerance.empty()) return tolerance > 0.0 ? dialect.assumed_path : dialect.exact_path;
  const auto ticks = static_cast<std::int64_t>(std::floor(tolerance * 1e4 * (1.0 + 1e-9)));
  if (ticks <= 0 || static_cast<double>(ticks) * 1e-4 < dialect.least_tolerance) return dialect.exact_path;
  PostValues values;
  values.tolerance = FormatTicks(ticks, 4);
  return *FillTemplate(dialect.path_tolerance, values);
}

}  // namespace

std::string CoolantLine(const Dialect& dialect, Coolant coolant) {
  switch (coolant) {
    case Coolant::kOff:
      return {};
    case Coolant::kFlood:
      return dialect.flood_on;
    case Coolant::kMist:
      return dialect.mist_on;
    case Coolant::kAir:
      return dialect.air_on;
  }
  return {};
}

bool IsWorkOffset(std::string_view word) {
  return word.size() == 3 && word[0] == 'G' && word[1] == '5' && word[2] >= '4' && word[2] <= '9';
}

absl::StatusOr<std::string> WriteProgram(const Toolpath& toolpath, const Tool& tool,
                                         const PostParams& params) {
  PM_RETURN_IF_ERROR(Validate(toolpath, tool, params));
  const Dialect& dialect = params.dialect;
  const std::vector<RoundedMove> moves = RoundMoves(toolpath, params, dialect.decimals);
  const auto place = [&](std::size_t k) { return PlaceText(dialect, moves.front().to[k]); };
  const PostValues values{.program = fmt::format("{:04}", params.program_number),
                          .work_offset = params.work_offset,
                          .tool = fmt::format("{}", tool.number),
                          .speed = FormatShort(tool.spindle_rpm, 1),
                          .coolant = CoolantLine(dialect, tool.coolant),
                          .path = PathLine(dialect, params.controller_tolerance),
                          .tolerance = {},
                          .x = place(0),
                          .y = place(1),
                          .z = place(2)};
  BlockWriter out(dialect);
  const auto write = [&](const std::vector<std::string>& lines) {
    for (const std::string& line : lines) {
      if (line == kHeaderLine) {
        for (const std::string& text : HeaderTexts(moves, tool, params, dialect)) {
          for (const std::string& comment : CommentLines(dialect, text)) out.Bare(comment);
        }
      } else if (const auto filled = FillTemplate(line, values)) {
        out.Line(*filled);
      }
    }
  };
  write(dialect.begin);
  out.StartAt(moves.front().to);
  for (std::size_t i = 1; i < moves.size(); ++i) out.Go(moves[i]);
  write(dialect.end);
  return out.Take();
}

}  // namespace patchmill
