#include "cam/post/program_writer.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cam/post/dialect.h"
#include "cam/post/number_format.h"
#include "core/base/status.h"

namespace patchmill {

namespace {

constexpr double kLargestCoordinate = 1e6;  // mm
constexpr std::array<const char*, 3> kAxis = {"X", "Y", "Z"};
using Ticks = std::array<std::int64_t, 3>;

struct RoundedMove {
  bool rapid = false;
  Ticks to{};
  double feed = 0.0;
};

std::string JoinDialects() {
  std::string list;
  for (const std::string& name : KnownDialects()) list += (list.empty() ? "" : ", ") + name;
  return list;
}

absl::Status Validate(const Toolpath& toolpath, const Tool& tool, const PostParams& params) {
  const auto bad = [](const std::string& message) { return absl::InvalidArgumentError(message); };
  if (FindDialect(params.dialect) == nullptr) {
    return bad(fmt::format("post.dialect = \"{}\"; must be one of: {}", params.dialect, JoinDialects()));
  }
  if (!IsWorkOffset(params.work_offset)) {
    return bad(fmt::format("post.work_offset = \"{}\"; must be G54 to G59", params.work_offset));
  }
  if (!(params.controller_tolerance > 0.0) || !std::isfinite(params.controller_tolerance)) {
    return bad(fmt::format("controller_tolerance = {} mm; must be > 0", params.controller_tolerance));
  }
  if (!(tool.spindle_rpm > 0.0) || !(tool.spindle_rpm <= 1e6)) {
    return bad(fmt::format("tool.spindle_rpm = {}; must be in (0, 1e6]", tool.spindle_rpm));
  }
  if (tool.number < 1 || tool.number > 99999) {
    return bad(fmt::format("tool.number = {}; must be in [1, 99999]", tool.number));
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

// Writes blocks without repeating modal words.
class BlockWriter {
 public:
  explicit BlockWriter(int decimals) : decimals_(decimals) {}

  void Line(std::string_view text) {
    text_ += text;
    text_ += '\n';
  }
  // The first motion from machine zero: X and Y above everything, then Z alone.
  void First(const RoundedMove& move) {
    Line(fmt::format("G0 X{} Y{}", FormatTicks(move.to[0], decimals_), FormatTicks(move.to[1], decimals_)));
    Line(fmt::format("Z{}", FormatTicks(move.to[2], decimals_)));
    at_ = move.to;
  }
  void Go(const RoundedMove& move) {
    std::string block;
    const auto add = [&](std::string_view word) {
      if (!block.empty()) block += ' ';
      block += word;
    };
    if (move.rapid != rapid_) add(move.rapid ? "G0" : "G1");
    for (std::size_t k = 0; k < 3; ++k) {
      if (move.to[k] != at_[k]) add(kAxis[k] + FormatTicks(move.to[k], decimals_));
    }
    if (!move.rapid && (rapid_ || move.feed != feed_)) {
      add(fmt::format("F{}", FormatShort(std::max(move.feed, 1e-4), 4)));
      feed_ = move.feed;
    }
    rapid_ = move.rapid;
    at_ = move.to;
    Line(block);
  }
  std::string Take() { return std::move(text_); }

 private:
  int decimals_;
  std::string text_;
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
  texts.push_back(fmt::format("zero: {}, at X{} Y{} Z{} of the placed model; work offset {}",
                              params.zero_name, zero(0), zero(1), zero(2), params.work_offset));
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

const std::string& CoolantWord(const Dialect& dialect, Coolant coolant) {
  static const std::string none;
  switch (coolant) {
    case Coolant::kOff:
      return none;
    case Coolant::kFlood:
      return dialect.flood_on;
    case Coolant::kMist:
      return dialect.mist_on;
    case Coolant::kAir:
      return dialect.air_on;
  }
  return none;
}

}  // namespace

bool IsWorkOffset(std::string_view word) {
  return word.size() == 3 && word[0] == 'G' && word[1] == '5' && word[2] >= '4' && word[2] <= '9';
}

std::vector<std::string> KnownDialects() {
  std::vector<std::string> names;
  for (const Dialect& dialect : Dialects()) names.push_back(dialect.name);
  return names;
}

absl::StatusOr<std::string> WriteProgram(const Toolpath& toolpath, const Tool& tool,
                                         const PostParams& params) {
  PM_RETURN_IF_ERROR(Validate(toolpath, tool, params));
  const Dialect& dialect = *FindDialect(params.dialect);
  const std::vector<RoundedMove> moves = RoundMoves(toolpath, params, dialect.decimals);

  BlockWriter out(dialect.decimals);
  for (const std::string& text : HeaderTexts(moves, tool, params, dialect)) {
    for (const std::string& line : CommentLines(dialect, text)) out.Line(line);
  }
  out.Line(fmt::format(fmt::runtime(dialect.safe_start), params.work_offset));
  // The tolerance is rounded down, so that the control does not get more than its share of the budget.
  const auto tolerance_ticks =
      static_cast<std::int64_t>(std::floor(params.controller_tolerance * 1e4 * (1.0 + 1e-9)));
  out.Line(tolerance_ticks > 0
               ? fmt::format(fmt::runtime(dialect.path_tolerance), FormatTicks(tolerance_ticks, 4))
               : dialect.exact_path);
  out.Line(dialect.home_z);
  out.Line(fmt::format(fmt::runtime(dialect.tool_change), tool.number));
  out.Line(fmt::format(fmt::runtime(dialect.spindle_on), FormatShort(tool.spindle_rpm, 1)));
  const std::string& coolant = CoolantWord(dialect, tool.coolant);
  if (!coolant.empty()) out.Line(coolant);
  out.Line(fmt::format(fmt::runtime(dialect.tool_length), tool.number));

  out.First(moves.front());
  for (std::size_t i = 1; i < moves.size(); ++i) out.Go(moves[i]);

  out.Line(dialect.coolant_off);
  out.Line(dialect.spindle_off);
  out.Line(dialect.home_z);
  out.Line(dialect.restore);
  out.Line(dialect.end);
  return out.Take();
}

}  // namespace patchmill
