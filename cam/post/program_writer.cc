#include "cam/post/program_writer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cam/post/dialect.h"
#include "cam/post/number_format.h"
#include "cam/post/post_template.h"
#include "cam/post/round_arc.h"
#include "core/base/status.h"

namespace patchmill {

namespace {

constexpr double kLargestCoordinate = 1e6;  // mm
constexpr int kLargestLineNumber = 99'999;  // of N words; longer programs repeat them
constexpr std::size_t kLinesAround = 200;   // more than stand before and after the moves
constexpr std::array<const char*, 3> kAxis = {"X", "Y", "Z"};
constexpr std::array<const char*, 3> kCenter = {"I", "J", "K"};
constexpr EnumArray<ArcPlane, const char*> kPlaneWord{{{"G17", "G18", "G19"}}};
constexpr EnumArray<ArcPlane, std::size_t> kThirdAxis{{{2, 1, 0}}};

struct RoundedArc {
  ArcPlane plane = ArcPlane::kXy;
  bool clockwise = false;
  Ticks center{};  // from the start of the arc
};

struct RoundedMove {
  bool rapid = false;
  Ticks to{};
  double feed = 0.0;
  std::optional<RoundedArc> arc = {};
  std::size_t of = 0;  // the toolpath's move that it is a part of
};

absl::Status Validate(const Toolpath& toolpath, const Tool& tool, const PostParams& params) {
  const auto bad = [](const std::string& message) { return absl::InvalidArgumentError(message); };
  if (params.program_number < 1 || params.program_number > 9999) {
    return bad(fmt::format("post.program_number = {}; must be in [1, 9999]", params.program_number));
  }
  if (!HasUnit(params.dialect, params.unit))
    return bad(fmt::format("post.unit: the dialect {} has no programs in inches", params.dialect.name));
  const bool siemens = params.dialect.syntax == Syntax::kSiemens;
  if (!IsWorkOffset(params.work_offset) || (siemens && params.work_offset >= "G58")) {
    return bad(fmt::format("post.work_offset = \"{}\"; must be G54 to {}", params.work_offset,
                           siemens ? "G57 (G58 and G59 shift the frame on these controls)" : "G59"));
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
  if (params.restart_points && params.dialect.restart.empty()) {
    return bad(
        fmt::format("post.restart_points: the dialect {} has no section [restart]", params.dialect.name));
  }
  if (!(params.chord_sagitta > 0.0))
    return bad(fmt::format("chord_sagitta = {} mm; must be > 0", params.chord_sagitta));
  for (std::size_t i = 0; i < toolpath.moves.size(); ++i) {
    const Move& move = toolpath.moves[i];
    if (move.arc && !(move.arc->center.cwiseAbs().maxCoeff() <= 2.0 * kLargestCoordinate))
      return bad(fmt::format("moves[{}].arc.center is not within {} mm", i, 2.0 * kLargestCoordinate));
    if (!move.to.allFinite() || !(move.to.cwiseAbs().maxCoeff() <= largest)) {
      return bad(fmt::format("moves[{}].to is not within {} mm", i, kLargestCoordinate));
    }
    if (move.kind != MoveKind::kRapid && !(move.feed > 0.0 && move.feed <= 1e6)) {
      return bad(fmt::format("moves[{}].feed = {} mm/min; must be in (0, 1e6]", i, move.feed));
    }
  }
  return absl::OkStatus();
}

// A section among the rounded moves.
struct RoundedSection {
  std::size_t first_move = 0;
  const ProgramSection* section = nullptr;
  bool restart = false;  // lines that begin a program anew stand before it
  Ticks place{};         // of a restart: over the end of its first move
};

struct RoundedMoves {
  std::vector<RoundedMove> moves;
  std::vector<RoundedSection> sections;
};

// Turns centres into rounded tips in the program frame. The first move is a rapid to the place over the first
// point, at the clearance plane or higher. Moves that vanish in rounding are dropped.
class MoveRounder {
 public:
  MoveRounder(const Toolpath& toolpath, const PostParams& params)
      : toolpath_(toolpath),
        params_(params),
        tick_(TickOf(params.dialect, params.unit)),
        shift_(params.program_zero + Vec3(0, 0, toolpath.ball_radius)) {}

  RoundedMoves Round() {
    const std::int64_t clearance = Tick(params_.clearance_z - params_.program_zero.z());
    moves_.reserve(toolpath_.moves.size() + 2);
    at_ = At(toolpath_.moves.front().to - shift_);
    at_[2] = std::max(at_[2], clearance);
    moves_.push_back({.rapid = true, .to = at_});
    std::vector<RoundedSection> sections;
    auto next = params_.sections.begin();
    for (std::size_t k = 0; k < toolpath_.moves.size(); ++k) {
      const Move& move = toolpath_.moves[k];
      for (; next != params_.sections.end() && next->first_move <= k; ++next) {
        const bool restart = params_.restart_points && next->restart && k > 0;
        if (restart) {
          at_ = At(move.to - shift_);
          at_[2] = std::max(at_[2], clearance);
        }
        sections.push_back({moves_.size(), &*next, restart, at_});
      }
      const std::size_t first = moves_.size();
      if (move.arc && k > 0) {
        Turn(toolpath_.moves[k - 1].to, move);
      } else {
        Go(move.to - shift_, move.feed, move.kind == MoveKind::kRapid);
      }
      for (std::size_t i = first; i < moves_.size(); ++i) moves_[i].of = k;
    }
    if (at_[2] < clearance) {
      at_[2] = clearance;
      moves_.push_back({.rapid = true, .to = at_, .of = toolpath_.moves.size()});
    }
    return {std::move(moves_), std::move(sections)};
  }

 private:
  std::int64_t Tick(double mm) const { return ToTicks(mm, params_.dialect, params_.unit); }
  Ticks At(const Vec3& tip) const { return {Tick(tip.x()), Tick(tip.y()), Tick(tip.z())}; }

  void Go(const Vec3& tip, double feed, bool rapid) {
    const Ticks to = At(tip);
    if (to == at_) return;
    moves_.push_back({.rapid = rapid, .to = to, .feed = feed});
    at_ = to;
  }

  // An arc as one or more blocks, or as chords where that is not possible.
  void Turn(const Vec3& from, const Move& move) {
    const DialectArcs& limits = params_.dialect.arcs;
    const Arc arc{move.arc->plane, move.arc->center - Xy(ToPlane(move.arc->plane, shift_)),
                  move.arc->clockwise};
    const ArcEnds ends{from - shift_, move.to - shift_};
    const double radius = (Xy(ToPlane(arc.plane, ends.from)) - arc.center).norm();
    if (limits.planes[arc.plane] && radius <= limits.largest_radius) {
      constexpr double kSlack = 2e-3;  // rad
      const double parts = std::ceil(Sweep(arc, ends) / (limits.largest_sweep + kSlack));
      // Shorter arcs are easier to round.
      if (TurnIn(parts, {arc, ends}, move.feed) || TurnIn(2.0 * parts, {arc, ends}, move.feed)) return;
    }
    for (const Vec3& tip : ChordEnds(arc, ends, params_.chord_sagitta)) Go(tip, move.feed, false);
  }

  // Adds the arc as so many blocks. Adds nothing, and returns false, if one of them cannot be rounded.
  bool TurnIn(double parts, const ExactArc& exact, double feed) {
    const Arc& arc = exact.arc;
    const std::size_t third = kThirdAxis[arc.plane];
    std::vector<RoundedMove> blocks;
    Ticks at = at_;
    for (double k = 0.0; k < parts; k += 1.0) {
      const ArcEnds part{PlaceOn(arc, exact.ends, k / parts), PlaceOn(arc, exact.ends, (k + 1.0) / parts)};
      const Ticks to = At(part.to);
      const auto center = RoundedCenter({arc, part}, at, to, tick_);
      if (!center || (!params_.dialect.arcs.helices && to[third] != at[third])) return false;
      blocks.push_back({.to = to, .feed = feed, .arc = RoundedArc{arc.plane, arc.clockwise, *center}});
      at = to;
    }
    moves_.insert(moves_.end(), blocks.begin(), blocks.end());
    at_ = at;
    return true;
  }

  const Toolpath& toolpath_;
  const PostParams& params_;
  const double tick_;  // mm
  const Vec3 shift_;   // from the tip in the program frame to the centre
  Ticks at_{};
  std::vector<RoundedMove> moves_;
};

// A coordinate as a program has it.
std::string PlaceText(const PostParams& params, std::int64_t ticks) {
  const bool plus = params.dialect.syntax == Syntax::kKlartext && ticks >= 0;
  return fmt::format("{}{}", plus ? "+" : "", FormatTicks(ticks, params.dialect.decimals[params.unit]));
}

// A feed as a program has it. In inches and on Heidenhain it is rounded down: half a step of the last decimal
// may be more than anyone allows above a limit. Heidenhain counts feeds of programs in inches in tenths, and
// reads three decimals.
std::string FeedText(double mm_per_min, const PostParams& params) {
  const bool klartext = params.dialect.syntax == Syntax::kKlartext, inch = params.unit == ProgramUnit::kInch;
  const int decimals = klartext ? 3 : 4;
  const double step = std::pow(10.0, -decimals);
  const double feed =
      std::max(mm_per_min / kMillimetersPer[params.unit] * (klartext && inch ? 10.0 : 1.0), step);
  if (!klartext && !inch) return FormatShort(feed, decimals);
  return FormatShort(std::floor(feed / step * (1.0 + 1e-12)) * step, decimals);
}

// Writes blocks without repeating modal words.
class BlockWriter {
 public:
  // `lines`: about as many will be written. The step of their numbers is so small that no number repeats, if
  // that is possible.
  BlockWriter(const PostParams& params, std::size_t lines)
      : params_(params),
        dialect_(params.dialect),
        step_(static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(dialect_.line_number_step),
                                                     std::max<std::size_t>(kLargestLineNumber / lines, 1)))) {
  }

  // A line without a number, where lines need none.
  void Bare(std::string_view text) {
    if (IsKlartext()) text_ += fmt::format("{} ", number_++);  // every line is a numbered block
    text_ += text;
    text_ += dialect_.line_end;
    ++lines_;
  }
  void Line(std::string_view text) {
    const bool numbered = step_ > 0 && text != "%" && text.front() != 'O';
    if (numbered && !IsKlartext()) {
      number_ += step_;
      if (number_ > kLargestLineNumber) number_ = step_;
      text_ += fmt::format("N{} ", number_);
    }
    Bare(text);
  }
  bool IsKlartext() const { return dialect_.syntax == Syntax::kKlartext; }
  // The lines before have sent the tool there by G0, and every mode is as at the start of a program.
  void StartAt(const Ticks& at) {
    at_ = at;
    rapid_ = true;
    motion_ = "G0";
    plane_ = {};
    feed_ = 0.0;
  }
  void Go(const RoundedMove& move) {
    std::string block;
    const auto add = [&](std::string_view word) {
      if (!block.empty()) block += ' ';
      block += word;
    };
    if (IsKlartext()) {
      if (move.arc) Pole(*move.arc);
      add(move.arc ? "C" : "L");
    } else {
      if (move.arc && plane_ != move.arc->plane) {
        add(kPlaneWord[*(plane_ = move.arc->plane)]);
        motion_ = {};  // stated anew in another plane
      }
      const char* motion = move.rapid ? "G0" : !move.arc ? "G1" : move.arc->clockwise ? "G2" : "G3";
      if (motion_ != motion) add(motion_ = motion);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const bool in_plane = move.arc && k != kThirdAxis[move.arc->plane];
      if (in_plane || move.to[k] != at_[k]) add(kAxis[k] + PlaceText(params_, move.to[k]));
    }
    if (move.arc && IsKlartext()) add(move.arc->clockwise ? "DR-" : "DR+");
    for (std::size_t k = 0; move.arc && !IsKlartext() && k < 3; ++k) {
      if (k != kThirdAxis[move.arc->plane]) add(kCenter[k] + PlaceText(params_, move.arc->center[k]));
    }
    if (IsKlartext() && move.rapid) add("FMAX");
    if (!move.rapid && (rapid_ || move.feed != feed_)) {
      std::string feed = FeedText(move.feed, params_);
      if (dialect_.feed_point && feed.find('.') == std::string::npos) feed += '.';
      add("F" + feed);
      feed_ = move.feed;
    }
    rapid_ = move.rapid;
    at_ = move.to;
    Line(block);
  }
  // After the last move: the plane is G17 again, as other programs may expect.
  void EndMoves() {
    if (plane_ && *plane_ != ArcPlane::kXy) Line(kPlaneWord[ArcPlane::kXy]);
  }
  int lines() const { return lines_; }  // that are written
  std::string Take() { return std::move(text_); }

 private:
  // The centre of the arc that begins here.
  void Pole(const RoundedArc& arc) {
    Line(fmt::format("CC X{} Y{}", PlaceText(params_, at_[0] + arc.center[0]),
                     PlaceText(params_, at_[1] + arc.center[1])));
  }

  const PostParams& params_;
  const Dialect& dialect_;
  const int step_;  // of line numbers; 0: none
  std::string text_;
  int lines_ = 0;
  int number_ = 0;
  Ticks at_{};
  bool rapid_ = true;
  std::string_view motion_ = "G0";
  std::optional<ArcPlane> plane_;  // none before the first arc
  double feed_ = 0.0;
};

// The least and the greatest place of all moves along each axis.
struct TickRange {
  Ticks low{}, high{};
};
TickRange RangeOf(const std::vector<RoundedMove>& moves, const PostParams& params) {
  Ticks at = moves.front().to;
  TickRange range{at, at};
  const auto add = [&](const Ticks& place) {
    for (std::size_t k = 0; k < 3; ++k) {
      range.low[k] = std::min(range.low[k], place[k]);
      range.high[k] = std::max(range.high[k], place[k]);
    }
  };
  const double unit = TickOf(params.dialect, params.unit);
  const auto tick = [&](double mm) { return ToTicks(mm, params.dialect, params.unit); };
  const auto place = [&](const Ticks& t) {
    return Vec3(unit * Vec3(static_cast<double>(t[0]), static_cast<double>(t[1]), static_cast<double>(t[2])));
  };
  for (const RoundedMove& move : moves) {
    if (move.arc) {
      const Vec3 center = place(at) + place(move.arc->center);
      const Arc arc{move.arc->plane, Xy(ToPlane(move.arc->plane, center)), move.arc->clockwise};
      for (const Vec3& p : TurningPlaces(arc, {place(at), place(move.to)}))
        add({tick(p.x()), tick(p.y()), tick(p.z())});
    }
    add(move.to);
    at = move.to;
  }
  return range;
}

std::string ToolLine(const Tool& tool, ProgramUnit unit) {
  const auto length = [&](double mm, int decimals) {
    return unit == ProgramUnit::kInch ? FormatShort(mm / kMillimetersPer[unit], 4)
                                      : FormatShort(mm, decimals);
  };
  std::string line = fmt::format("tool T{}: ball D {}", tool.number, length(2.0 * BallRadius(tool), 4));
  if (!tool.name.empty()) line += ", " + tool.name;
  if (tool.flute_length) line += ", flute " + length(*tool.flute_length, 3);
  if (tool.shank_diameter) line += ", shank D " + length(*tool.shank_diameter, 3);
  if (tool.stickout) line += ", stick-out " + length(*tool.stickout, 3);
  return line;
}

std::vector<std::string> HeaderTexts(const std::vector<RoundedMove>& moves, const Tool& tool,
                                     const PostParams& params) {
  const Dialect& dialect = params.dialect;
  const auto [low, high] = RangeOf(moves, params);
  std::vector<std::string> texts;
  if (params.unit == ProgramUnit::kInch)
    texts.push_back("program in INCH; lengths in the comments down to \"units INCH\" are in MM");
  texts.insert(texts.end(), params.header.begin(), params.header.end());
  const auto text = [&](std::int64_t ticks) { return FormatTicks(ticks, dialect.decimals[params.unit]); };
  if (params.unit == ProgramUnit::kMillimeter) {
    texts.push_back("units MM, feeds MM per minute; X Y Z is the tool tip, the lowest point of the ball");
  } else {
    texts.push_back(fmt::format(
        "units INCH, feeds {}INCH per minute; X Y Z is the tool tip, the lowest point of the ball",
        dialect.syntax == Syntax::kKlartext ? "1/10 " : ""));
  }
  const auto zero = [&](int k) { return text(ToTicks(params.program_zero[k], dialect, params.unit)); };
  const bool chooses = std::any_of(dialect.begin.begin(), dialect.begin.end(), [](const std::string& line) {
    return line.find("{work_offset}") != std::string::npos;
  });
  texts.push_back(fmt::format(
      "zero: {}, at X{} Y{} Z{} of the placed model; {}", params.zero_name, zero(0), zero(1), zero(2),
      chooses ? "work offset " + params.work_offset : std::string("the program chooses no work offset")));
  std::string range = "tip of all moves below machine zero:";
  for (std::size_t k = 0; k < 3; ++k) {
    range += fmt::format(" {} {} to {}", kAxis[k], text(low[k]), text(high[k]));
    if (k < 2) range += ",";
  }
  texts.push_back(std::move(range));
  texts.push_back(ToolLine(tool, params.unit));
  return texts;
}

// The line that says how far the control may leave the path. The tolerance is rounded down, so that the
// control does not get more than its share of the budget.
std::string PathLine(const PostParams& params) {
  const Dialect& dialect = params.dialect;
  const bool inch = params.unit == ProgramUnit::kInch;
  const std::string& exact =
      inch && !dialect.exact_path_inch.empty() ? dialect.exact_path_inch : dialect.exact_path;
  const double tolerance = params.controller_tolerance;
  if (dialect.follows_exactly) return {};
  if (dialect.path_tolerance.empty()) return tolerance > 0.0 ? dialect.assumed_path : exact;
  const int decimals = inch ? 5 : 4;
  const double tick = kMillimetersPer[params.unit] * std::pow(10.0, -decimals);
  const auto ticks = static_cast<std::int64_t>(std::floor(tolerance / tick * (1.0 + 1e-9)));
  if (ticks <= 0 || static_cast<double>(ticks) * tick < dialect.least_tolerance) return exact;
  PostValues values;
  values.tolerance = FormatTicks(ticks, decimals);
  return *FillTemplate(dialect.path_tolerance, values);
}

std::string SectionText(const ProgramSection& section, ProgramUnit unit) {
  if (!section.tip) return section.comment;
  const double mm = kMillimetersPer[unit];
  return fmt::format("{}, tip Z{:.{}f} to Z{:.{}f}", section.comment, section.tip->high / mm,
                     unit == ProgramUnit::kInch ? 4 : 3, section.tip->low / mm,
                     unit == ProgramUnit::kInch ? 4 : 3);
}

// machine_top in the program's unit, not below it.
std::string TopText(const PostParams& params) {
  const double top = params.dialect.machine_top / kMillimetersPer[params.unit];
  return FormatShort(std::ceil(top * 1e4 - 1e-6) * 1e-4, 4);
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
  PM_ASSIGN_OR_RETURN(WrittenProgram program, WriteProgramWithLines(toolpath, tool, params));
  return std::move(program.text);
}

absl::StatusOr<WrittenProgram> WriteProgramWithLines(const Toolpath& toolpath, const Tool& tool,
                                                     const PostParams& params) {
  PM_RETURN_IF_ERROR(Validate(toolpath, tool, params));
  const Dialect& dialect = params.dialect;
  const auto rounded = MoveRounder(toolpath, params).Round();
  const auto& moves = rounded.moves;
  const auto& sections = rounded.sections;
  const auto place = [&](std::size_t k) { return PlaceText(params, moves.front().to[k]); };
  PostValues values{.program = fmt::format("{:04}", params.program_number),
                    .work_offset = params.work_offset,
                    .tool = fmt::format("{}", tool.number),
                    .speed = FormatShort(std::max(1.0, tool.spindle_rpm), 0),
                    .coolant = CoolantLine(dialect, tool.coolant),
                    .path = PathLine(params),
                    .tolerance = {},
                    .x = place(0),
                    .y = place(1),
                    .z = place(2),
                    .unit = dialect.unit_word[params.unit],
                    .top = TopText(params)};
  BlockWriter out(params, moves.size() + kLinesAround * (1 + sections.size()));
  const auto write = [&](const std::vector<std::string>& lines) {
    for (const std::string& line : lines) {
      if (line == kHeaderLine) {
        for (const std::string& text : HeaderTexts(moves, tool, params)) {
          for (const std::string& comment : CommentLines(dialect, text)) out.Bare(comment);
        }
      } else if (const auto filled = FillTemplate(line, values)) {
        out.Line(*filled);
      }
    }
  };
  write(dialect.begin);
  out.StartAt(moves.front().to);
  const auto comment = [&](const std::string& text) {
    for (const std::string& line : CommentLines(dialect, text)) out.Bare(line);
  };
  std::vector<int> lines(toolpath.moves.size(), 0);
  std::vector<WrittenProgram::Restart> restarts;
  auto next = sections.begin();
  for (std::size_t i = 1; i < moves.size(); ++i) {
    for (; next != sections.end() && next->first_move <= i; ++next) {
      comment(SectionText(*next->section, params.unit));
      if (!next->restart) continue;
      if (!restarts.empty()) restarts.back().end_line = out.lines() + 1;
      comment(fmt::format("restart point {}: the control may start at the next line, with T{} in the spindle",
                          restarts.size() + 1, tool.number));
      restarts.push_back({out.lines() + 1, 0});
      values.x = PlaceText(params, next->place[0]);
      values.y = PlaceText(params, next->place[1]);
      values.z = PlaceText(params, next->place[2]);
      write(dialect.restart);
      out.StartAt(next->place);
    }
    const int before = out.lines();
    out.Go(moves[i]);
    if (moves[i].of < lines.size() && lines[moves[i].of] == 0) lines[moves[i].of] = before + 1;
  }
  out.EndMoves();
  write(dialect.end);
  if (!restarts.empty()) restarts.back().end_line = out.lines() + 1;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i] == 0) lines[i] = lines[i - 1];
  }
  return WrittenProgram{out.Take(), std::move(lines), std::move(restarts)};
}

}  // namespace patchmill
