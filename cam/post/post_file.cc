// The reader of post files.
#include <algorithm>
#include <charconv>
#include <functional>
#include <utility>

#include <absl/strings/ascii.h>
#include <fmt/format.h>

#include "cam/post/dialect.h"
#include "cam/post/gcode_modes.h"
#include "cam/post/post_end.h"
#include "cam/post/post_faults.h"
#include "cam/post/post_template.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr std::size_t kMostFaults = 100;   // that are named
constexpr std::size_t kLongestLine = 200;  // characters

absl::Status Bad(const std::string& message) { return absl::InvalidArgumentError(message); }

std::string_view Trimmed(std::string_view text) {
  while (!text.empty() && absl::ascii_isspace(static_cast<unsigned char>(text.front())))
    text.remove_prefix(1);
  while (!text.empty() && absl::ascii_isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
  return text;
}

std::string Quoted(std::string_view text) { return fmt::format("\"{}\"", text.substr(0, 60)); }

absl::Status ReadNumber(std::string_view value, double least, double most, double& out) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc() || end != value.data() + value.size() || !(number >= least && number <= most))
    return Bad(fmt::format("= {}; must be a number from {:g} to {:g}", Quoted(value), least, most));
  out = number;
  return absl::OkStatus();
}

template <class Integer>
absl::Status ReadInteger(std::string_view value, int least, int most, Integer& out) {
  double number = 0.0;
  PM_RETURN_IF_ERROR(ReadNumber(value, least, most, number));
  out = static_cast<Integer>(number);
  if (static_cast<double>(out) != number)
    return Bad(fmt::format("= {}; must be a whole number", Quoted(value)));
  return absl::OkStatus();
}

// One of two words.
absl::Status ReadChoice(std::string_view value, std::string_view no, std::string_view yes, bool& out) {
  if (value != no && value != yes) return Bad(fmt::format("= {}; must be {} or {}", Quoted(value), no, yes));
  out = value == yes;
  return absl::OkStatus();
}

absl::Status ReadText(std::string_view value, std::string& out) {
  out = value;
  return absl::OkStatus();
}

// Two marks with a space between, or one that runs to the end of the line.
absl::Status ReadComment(std::string_view value, Dialect& out) {
  const std::size_t gap = value.find(' ');
  out.comment_open = value.substr(0, gap);
  out.comment_close = gap == std::string_view::npos ? "" : Trimmed(value.substr(gap));
  if ((out.comment_open == "(" && out.comment_close == ")") ||
      (out.comment_open == ";" && out.comment_close.empty()))
    return absl::OkStatus();
  return Bad(fmt::format("= {}; must be \"( )\" or \";\"", Quoted(value)));
}

absl::Status ReadName(std::string_view value, std::string& out) {
  for (const char c : value) {
    if (!absl::ascii_islower(static_cast<unsigned char>(c)) &&
        !absl::ascii_isdigit(static_cast<unsigned char>(c)) && c != '-' && c != '_')
      return Bad(fmt::format("= {}; must consist of a-z, 0-9, - and _", Quoted(value)));
  }
  if (value.size() > 40) return Bad("must have at most 40 characters");
  return ReadText(value, out);
}

absl::Status ReadSyntax(std::string_view value, Syntax& out) {
  constexpr std::pair<std::string_view, Syntax> kKnown[] = {
      {"rs274", Syntax::kRs274}, {"siemens", Syntax::kSiemens}, {"klartext", Syntax::kKlartext}};
  for (const auto& [name, syntax] : kKnown) {
    if (name != value) continue;
    out = syntax;
    return absl::OkStatus();
  }
  return Bad(fmt::format("= {}; must be rs274, siemens or klartext", Quoted(value)));
}

absl::Status ReadFamily(std::string_view value, WordFamily& out) {
  const std::optional<WordFamily> family = FamilyOf(value);
  if (!family) {
    return Bad(fmt::format("= {}; must be fanuc, grbl, haas, heidenhain, linuxcnc, mach3 or siemens",
                           Quoted(value)));
  }
  out = *family;
  return absl::OkStatus();
}

absl::Status ReadPathTemplate(std::string_view value, bool with_tolerance, std::string& out) {
  PM_RETURN_IF_ERROR(CheckTemplate(value));
  const bool has = value.find("{tolerance}") != std::string_view::npos;
  if (has != with_tolerance || value.find('{') != value.rfind('{'))
    return Bad(with_tolerance ? "must hold {tolerance} and no other placeholder"
                              : "must hold no placeholder");
  return ReadText(value, out);
}

// "G17 G19": any of the three, once each.
absl::Status ReadPlanes(std::string_view value, EnumArray<ArcPlane, bool>& out) {
  constexpr EnumArray<ArcPlane, std::string_view> kWords{{{"G17", "G18", "G19"}}};
  for (std::string_view rest = value; !rest.empty();) {
    const std::string_view word = rest.substr(0, rest.find(' '));
    rest = Trimmed(rest.substr(word.size()));
    bool known = false;
    for (const ArcPlane plane : Enumerators<ArcPlane>()) {
      if (kWords[plane] != word) continue;
      if (out[plane]) return Bad(fmt::format("{} is given twice", word));
      out[plane] = known = true;
    }
    if (!known) return Bad(fmt::format("= {}; must be one or more of G17, G18 and G19", Quoted(value)));
  }
  return absl::OkStatus();
}

absl::Status ReadUnit(std::string_view value, std::string& out) {
  if (value.find_first_of("{}") != std::string_view::npos) return Bad("must hold no placeholder");
  return ReadText(value, out);
}

// A line that switches the coolant on.
absl::Status ReadCoolant(std::string_view value, std::string& out) {
  if (value.find("M9") != std::string_view::npos || value.find("M09") != std::string_view::npos)
    return Bad(fmt::format("= {}; M9 switches the coolant off", Quoted(value)));
  return ReadPathTemplate(value, false, out);
}

using Reader = std::function<absl::Status(std::string_view, Dialect&)>;

// All keys by "section.key".
const std::map<std::string, Reader, std::less<>>& Keys() {
  using View = std::string_view;
  static const auto* const keys = new std::map<std::string, Reader, std::less<>>{
      {"control.name", [](View v, Dialect& d) { return ReadName(v, d.name); }},
      {"control.title", [](View v, Dialect& d) { return ReadText(v, d.title); }},
      {"control.syntax", [](View v, Dialect& d) { return ReadSyntax(v, d.syntax); }},
      {"control.reads_as", [](View v, Dialect& d) { return ReadFamily(v, d.family); }},
      {"control.decimals",
       [](View v, Dialect& d) { return ReadInteger(v, 2, 6, d.decimals[ProgramUnit::kMillimeter]); }},
      {"control.decimals_inch",
       [](View v, Dialect& d) { return ReadInteger(v, 3, 7, d.decimals[ProgramUnit::kInch]); }},
      {"control.unit_mm",
       [](View v, Dialect& d) { return ReadUnit(v, d.unit_word[ProgramUnit::kMillimeter]); }},
      {"control.unit_inch", [](View v, Dialect& d) { return ReadUnit(v, d.unit_word[ProgramUnit::kInch]); }},
      {"control.comment", [](View v, Dialect& d) { return ReadComment(v, d); }},
      {"control.comment_length",
       [](View v, Dialect& d) { return ReadInteger(v, 20, 250, d.max_comment_length); }},
      {"control.upper_case", [](View v, Dialect& d) { return ReadChoice(v, "no", "yes", d.upper_case); }},
      {"control.feed_point", [](View v, Dialect& d) { return ReadChoice(v, "no", "yes", d.feed_point); }},
      {"control.coordinate_point",
       [](View v, Dialect& d) { return ReadChoice(v, "no", "yes", d.coordinate_point); }},
      {"control.length_offset",
       [](View v, Dialect& d) { return ReadChoice(v, "no", "yes", d.length_offset); }},
      {"control.feed_unit",
       [](View v, Dialect& d) { return ReadChoice(v, "before", "new", d.feed_in_new_unit); }},
      {"control.arc_turns", [](View v, Dialect& d) { return ReadChoice(v, "no", "yes", d.arc_turns); }},
      {"control.arc_radius_slack",
       [](View v, Dialect& d) { return ReadNumber(v, 0.001, 0.1, d.arc_radius_slack); }},
      {"control.arc_radius_slack_in",
       [](View v, Dialect& d) { return ReadNumber(v, 0.00004, 0.004, d.arc_radius_slack_in); }},
      {"control.d0_is_no_offset",
       [](View v, Dialect& d) { return ReadChoice(v, "no", "yes", d.d0_is_no_offset); }},
      {"control.line_numbers",
       [](View v, Dialect& d) { return ReadInteger(v, 0, kMaxLineNumberStep, d.line_number_step); }},
      {"control.machine_top", [](View v, Dialect& d) { return ReadNumber(v, -50.0, 0.0, d.machine_top); }},
      {"control.line_end",
       [](View v, Dialect& d) {
         bool crlf = false;
         PM_RETURN_IF_ERROR(ReadChoice(v, "lf", "crlf", crlf));
         d.line_end = crlf ? "\r\n" : "\n";
         return absl::OkStatus();
       }},
      {"path.follows",
       [](View v, Dialect& d) { return ReadChoice(v, "tolerance", "exactly", d.follows_exactly); }},
      {"path.tolerance", [](View v, Dialect& d) { return ReadPathTemplate(v, true, d.path_tolerance); }},
      {"path.tolerance_least", [](View v, Dialect& d) { return ReadNumber(v, 0.0, 1.0, d.least_tolerance); }},
      {"path.exact", [](View v, Dialect& d) { return ReadPathTemplate(v, false, d.exact_path); }},
      {"path.exact_inch", [](View v, Dialect& d) { return ReadPathTemplate(v, false, d.exact_path_inch); }},
      {"path.assumed", [](View v, Dialect& d) { return ReadPathTemplate(v, false, d.assumed_path); }},
      {"path.planner",
       [](View v, Dialect& d) { return ReadChoice(v, "junction", "linuxcnc", d.linuxcnc_planner); }},
      {"arcs.planes", [](View v, Dialect& d) { return ReadPlanes(v, d.arcs.planes); }},
      {"arcs.helices", [](View v, Dialect& d) { return ReadChoice(v, "no", "yes", d.arcs.helices); }},
      {"arcs.largest_radius",
       [](View v, Dialect& d) { return ReadNumber(v, 1.0, 1e5, d.arcs.largest_radius); }},
      {"arcs.largest_sweep",
       [](View v, Dialect& d) {
         double degrees = 0.0;
         PM_RETURN_IF_ERROR(ReadNumber(v, 90.0, 360.0, degrees));
         d.arcs.largest_sweep = Radians(degrees);
         return absl::OkStatus();
       }},
      {"arcs.centre",
       [](View v, Dialect& d) { return ReadChoice(v, "modal", "start", d.arcs.center_from_start); }},
      {"coolant.flood", [](View v, Dialect& d) { return ReadCoolant(v, d.flood_on); }},
      {"coolant.mist", [](View v, Dialect& d) { return ReadCoolant(v, d.mist_on); }},
      {"coolant.air", [](View v, Dialect& d) { return ReadCoolant(v, d.air_on); }},
  };
  return *keys;
}

std::string KeysOf(std::string_view section) {
  std::string list;
  for (const auto& [key, reader] : Keys()) {
    if (key.compare(0, section.size(), section) == 0 && key[section.size()] == '.')
      list += fmt::format("{}{}", list.empty() ? "" : ", ", key.substr(section.size() + 1));
  }
  return list;
}

// Words that move the tool, call another program, or shift, turn, scale or mirror coordinates on controls of
// any maker, by their families. Whoever says that they do nothing would have a wrong motion judged.
bool MayMove(char letter, double number) {
  const int whole = static_cast<int>(number);
  const bool plain = number == whole;
  const auto within = [whole](int first, int last) { return whole >= first && whole <= last; };
  if (letter == 'M') return within(96, 99) || whole == 198;
  // Look-ahead, exact stop of one line, and words that cancel.
  for (const int harmless : {5, 8, 9, 15, 50, 69, 97})
    if (plain && whole == harmless) return false;
  if (number == 5.1 || within(61, 64)) return false;
  return within(0, 102) || within(104, 186) || within(188, 600);
}

// "G05.1" as "G5.1". INVALID_ARGUMENT for anything but a G or M word, and for a word that the reader of
// programs knows by itself: its meaning must not be taken away.
absl::StatusOr<std::string> ReadSpelling(std::string_view spelling) {
  double number = 0.0;
  const char* end = spelling.data() + spelling.size();
  const bool code = spelling.size() >= 2 && spelling.size() <= 8 &&
                    (spelling[0] == 'G' || spelling[0] == 'M') &&
                    spelling.find_first_not_of("0123456789.", 1) == std::string_view::npos &&
                    std::from_chars(spelling.data() + 1, end, number, std::chars_format::fixed).ptr == end;
  if (!code) return Bad(fmt::format("{} is not a G or M word", Quoted(spelling)));
  if (SortModes({.words = {{spelling[0], number}}}, Dialect()).ok())
    return Bad(fmt::format("{} has a meaning of its own, which cannot be changed", spelling));
  const std::string plain = fmt::format("{}{:.10g}", spelling[0], number);
  if (MayMove(spelling[0], number)) {
    return Bad(
        fmt::format("{} moves the tool, calls a program or changes coordinates on some controls: a program "
                    "with it cannot be judged, so no post file can explain it away",
                    spelling));
  }
  return plain;
}

// "G187 = tolerance E" or "M83 = none".
absl::Status ReadWord(std::string_view given, std::string_view meaning, Dialect& out) {
  PM_ASSIGN_OR_RETURN(const std::string spelling, ReadSpelling(given));
  DialectWord word;
  if (meaning.size() == 11 && meaning.substr(0, 10) == "tolerance " &&
      absl::ascii_isupper(static_cast<unsigned char>(meaning[10]))) {
    word.tolerance_letter = meaning[10];
  } else if (meaning != "none") {
    return Bad(
        fmt::format("{} = {}; must be \"none\" or \"tolerance\" and a letter", spelling, Quoted(meaning)));
  }
  if (!out.words.emplace(spelling, word).second) return Bad(fmt::format("{} is given twice", spelling));
  return absl::OkStatus();
}

// Reads the lines one after the other.
class PostFileReader {
 public:
  void Line(std::string_view line, int number) {
    line_ = number;
    if (faults_.size() >= kMostFaults) return;
    if (const absl::Status read = Read(line); !read.ok()) Add(number, read);
  }

  ReadPost Take(std::string_view text) {
    // What a faulty line would have set is not missed a second time.
    const bool readable = faults_.empty();
    CheckMissing(readable);
    if (readable) CheckLines();
    if (!seen_.contains("control.decimals_inch"))
      dialect_.decimals[ProgramUnit::kInch] = dialect_.decimals[ProgramUnit::kMillimeter] + 1;
    if (dialect_.title.empty()) dialect_.title = dialect_.name;
    dialect_.text = text;
    if (faults_.empty()) CheckModes();
    return {std::move(dialect_), std::move(faults_)};
  }

 private:
  void Add(int line, const absl::Status& status) { faults_.push_back({line, std::string(status.message())}); }
  void Whole(const std::string& message) { faults_.push_back({0, message}); }

  absl::Status Read(std::string_view line) {
    const std::string_view text = Trimmed(line);
    if (text.empty() || text.front() == '#') return absl::OkStatus();
    for (const char c : text) {
      if (c < 0x20 || c > 0x7e) {
        return Bad(
            fmt::format("byte 0x{:02X}: only printable ASCII is allowed, without tabs and without a byte "
                        "order mark",
                        static_cast<unsigned char>(c)));
      }
    }
    if (text.size() > kLongestLine) return Bad(fmt::format("longer than {} characters", kLongestLine));
    if (text.front() == '[') return Section(text);
    if (section_ == kFaultySection) return absl::OkStatus();
    if (section_.empty()) {
      section_ = kFaultySection;
      return Bad("text before the first section, [control]");
    }
    if (section_ == "begin" || section_ == "restart" || section_ == "end") return Template(text);
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) return Bad("must be \"key = value\"");
    const std::string_view key = Trimmed(text.substr(0, equals)), value = Trimmed(text.substr(equals + 1));
    if (section_ == "words") return ReadWord(key, value, dialect_);
    return Key(key, value);
  }

  void CheckMissing(bool readable) {
    for (const char* const key : {"name", "comment", "comment_length"}) {
      if (!seen_.contains(fmt::format("control.{}", key))) Whole(fmt::format("[control] {} is missing", key));
    }
    const bool empty_begin = readable && dialect_.begin.empty(), empty_end = readable && dialect_.end.empty();
    if (empty_begin || !seen_.contains("[begin]")) Whole("[begin] is missing");
    if (empty_end || !seen_.contains("[end]")) Whole("[end] is missing");
  }

  // Whether the lines have the placeholders that they need, and the keys agree.
  void CheckLines() {
    for (const char axis : {'x', 'y', 'z'}) {
      const std::string place = fmt::format("{{{}}}", axis);
      if (!dialect_.begin.empty() && !Has(dialect_.begin, place))
        Whole(fmt::format("[begin] nowhere sends the tool to {}", place));
      if (!dialect_.restart.empty() && !Has(dialect_.restart, place))
        Whole(fmt::format("[restart] nowhere sends the tool to {}", place));
    }
    if (const absl::Status units = CheckUnits(); !units.ok()) Add(0, units);
    for (const char* placeholder : {"{work_offset}", "{speed}", "{path}", "{tool}", "{coolant}", "{unit}"}) {
      // The unit of a Heidenhain program is that of its first line, wherever it is started.
      if (dialect_.syntax == Syntax::kKlartext && placeholder == std::string_view("{unit}")) continue;
      if (!dialect_.restart.empty() && Has(dialect_.begin, placeholder) &&
          !Has(dialect_.restart, placeholder))
        Whole(
            fmt::format("[restart] has no {}, which [begin] has: the control may start there", placeholder));
    }
    if (!dialect_.follows_exactly) {
      if (dialect_.exact_path.empty()) Whole("[path] exact is missing, and it does not follow exactly");
      if (!Has(dialect_.begin, "{path}")) Whole("[begin] nowhere has {path}, which the accuracy rests on");
    }
    const bool other_planes = dialect_.arcs.planes[ArcPlane::kZx] || dialect_.arcs.planes[ArcPlane::kYz];
    const bool any_plane = other_planes || dialect_.arcs.planes[ArcPlane::kXy];
    if (dialect_.arcs.helices && !any_plane) Whole("[arcs] helices = yes, and planes is missing");
    if (dialect_.syntax == Syntax::kKlartext && (other_planes || dialect_.arcs.helices))
      Whole("[arcs] klartext programs have arcs in the plane G17 only, and no helices");
  }

  // The modes in which [begin] and [restart] leave the control.
  void CheckModes() {
    for (const UnexpectedMode& mode : UnexpectedModes(dialect_, dialect_.begin))
      faults_.push_back({begin_lines_[mode.index], mode.message});
    for (const UnexpectedMode& mode : UnexpectedModes(dialect_, dialect_.restart))
      faults_.push_back({restart_lines_[mode.index], mode.message});
  }

  static bool Has(const std::vector<std::string>& lines, std::string_view placeholder) {
    for (const std::string& line : lines) {
      if (line.find(placeholder) != std::string::npos) return true;
    }
    return false;
  }

  // Lines with {unit} need its words, and the words need such a line.
  absl::Status CheckUnits() const {
    const bool used = Has(dialect_.begin, "{unit}");
    const bool mm = !dialect_.unit_word[ProgramUnit::kMillimeter].empty();
    const bool inch = !dialect_.unit_word[ProgramUnit::kInch].empty();
    if (used && !mm) return Bad("[begin] has {unit}, and [control] unit_mm is missing");
    if (!used && (mm || inch))
      return Bad("[control] has unit_mm or unit_inch, and [begin] nowhere has {unit}");
    return absl::OkStatus();
  }

  absl::Status Section(std::string_view text) {
    for (const char* name : {"control", "path", "arcs", "coolant", "words", "begin", "restart", "end"}) {
      if (text == fmt::format("[{}]", name)) {
        section_ = name;
        if (!seen_.insert({std::string(text), true}).second)
          return Bad(fmt::format("{} is given twice", text));
        return absl::OkStatus();
      }
    }
    section_ = kFaultySection;
    return Bad(
        fmt::format("{}: must be [control], [path], [arcs], [coolant], [words], [begin], [restart] or [end]",
                    Quoted(text)));
  }

  absl::Status Template(std::string_view text) {
    PM_RETURN_IF_ERROR(CheckTemplate(text));
    if (text.front() == '/')
      return Bad("a line with / may be skipped at the control, so it cannot be relied on");
    if (section_ == "restart" && text == kHeaderLine) return Bad("[restart] has no {header}");
    if (section_ == "begin") begin_lines_.push_back(line_);
    if (section_ == "restart") restart_lines_.push_back(line_);
    std::vector<std::string>& lines = section_ == "begin"     ? dialect_.begin
                                      : section_ == "restart" ? dialect_.restart
                                                              : dialect_.end;
    lines.emplace_back(text);
    return absl::OkStatus();
  }

  absl::Status Key(std::string_view key, std::string_view value) {
    const std::string full = fmt::format("{}.{}", section_, key);
    const auto known = Keys().find(full);
    if (known == Keys().end()) {
      return Bad(fmt::format("[{}] has no key {}; it has {}", section_, Quoted(key), KeysOf(section_)));
    }
    if (!seen_.insert({full, true}).second) return Bad(fmt::format("{} is given twice", key));
    if (value.empty()) return Bad(fmt::format("{} has no value", key));
    const absl::Status read = known->second(value, dialect_);
    if (read.ok()) return read;
    return Bad(fmt::format("{}: {}", key, std::string(read.message())));
  }

  static constexpr std::string_view kFaultySection = "?";  // its lines are passed over

  Dialect dialect_;
  std::string_view section_;
  int line_ = 0;
  std::vector<int> begin_lines_, restart_lines_;  // of the file, for each line of the program
  std::map<std::string, bool> seen_;
  std::vector<PostFault> faults_;
};

}  // namespace

ReadPost ReadPostFile(std::string_view text) {
  if (text.size() > kLongestPostFile)
    return {Dialect(), {{0, fmt::format("longer than {} characters", kLongestPostFile)}}};
  PostFileReader reader;
  int line = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    reader.Line(text.substr(begin, end - begin), ++line);
    begin = end + 1;
  }
  return reader.Take(text);
}

absl::StatusOr<Dialect> ParseDialect(std::string_view text) {
  ReadPost post = ReadPostFile(text);
  if (post.faults.empty()) return std::move(post.dialect);
  const PostFault& first = post.faults.front();
  return Bad(first.line > 0 ? fmt::format("line {}: {}", first.line, first.message) : first.message);
}

}  // namespace patchmill
