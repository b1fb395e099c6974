// Described in: SINUMERIK 840D sl / 828D, programming manuals "Fundamentals" and "Job planning", lists of
// instructions.
#include "cam/post/siemens_names.h"

#include <algorithm>
#include <span>

namespace patchmill {
namespace {

using enum NameUse;

constexpr std::string_view kFlow =
    "jumps, loops and variables are not supported; post the program without them";
constexpr std::string_view kSubprogram = "subprograms are not supported; post the program without them";
constexpr std::string_view kCycle = "cycles are not supported; post the program with the moves of the cycle";
constexpr std::string_view kSpline = "splines are not read; post the program with straight moves and arcs";
constexpr std::string_view kArc = "this form of an arc is not read; post arcs with I, J and K or with CR=";
constexpr std::string_view kPolar =
    "polar coordinates and angles are not read; post the program with X, Y and Z";
constexpr std::string_view kCorner = "the control inserts chamfers and roundings by itself; post the moves";
constexpr std::string_view kSoft = "soft approach and retraction move by a way that the program does not say";
constexpr std::string_view kFrames =
    "it shifts, turns, scales or mirrors the program by what the control holds";
constexpr std::string_view kKinematics =
    "kinematics of rotary axes are not judged; post a program of three axes";
constexpr std::string_view kOffset = "an offset other than zero is not read";
constexpr std::string_view kSync = "actions beside the program may move the machine";
constexpr std::string_view kAxes = "it moves or exchanges axes by itself";

constexpr SiemensName kKeywords[] = {
    // Dynamics: they change speeds, not the path.
    {"SOFT"},
    {"BRISK"},
    {"DRIVE"},
    {"FFWON"},
    {"FFWOF"},
    {"DYNNORM"},
    {"DYNPOS"},
    {"DYNROUGH"},
    {"DYNSEMIFIN"},
    {"DYNFINISH"},
    {"DYNPREC"},
    {"CFC"},
    {"CFTCP"},
    {"CFIN"},
    {"FNORM"},
    {"FLIN"},
    {"RTLION"},
    {"RTLIOF"},
    // Look-ahead, buffers, display, protection, orientation that nothing follows.
    {"STOPRE"},
    {"FIFOCTRL"},
    {"STARTFIFO"},
    {"STOPFIFO"},
    {"SPATH"},
    {"UPATH"},
    {"SPCON"},
    {"SPCOF"},
    {"CUT2D"},
    {"CUT2DF"},
    {"NORM"},
    {"KONT"},
    {"KONTC"},
    {"KONTT"},
    {"DIAMOF"},
    {"WALIMON"},
    {"WALIMOF"},
    {"CDOF"},
    {"CDOF2"},
    {"CDON"},
    {"ORIWKS"},
    {"ORIMKS"},
    {"ORIAXES"},
    {"ORIVECT"},
    {"ORIEULER"},
    {"ORIRPY"},
    {"ORIRPY2"},
    {"ORIVIRT1"},
    {"ORISOF"},
    {"TRAFOOF"},
    {"PAROTOF"},
    {"TOROTOF"},
    {"TCOFR"},
    {"TCOABS"},
    {"SPIF1"},
    {"CP"},
    {"PTPG0"},
    {"CPRECOF"},
    {"CUTCONOF"},
    {"OSOF"},
    {"MIRROROF"},
    {"LF"},
    {"CPRECON"},
    // Compressors and other smoothing.
    {"COMPON", kMerges},
    {"COMPCURV", kMerges},
    {"COMPCAD", kMerges},
    {"COMPSURF", kMerges},
    {"COMPPATH", kMerges},
    {"COMPOF", kEndsMerging},
    {"SUPA", kMachine},
    {"TRANS", kFrame},
    {"ATRANS", kFrame},
    {"ROT", kFrame},
    {"AROT", kFrame},
    {"ROTS", kFrame},
    {"AROTS", kFrame},
    {"CROTS", kFrame},
    {"SCALE", kFrame},
    {"ASCALE", kFrame},
    {"MIRROR", kFrame},
    {"AMIRROR", kFrame},
    {"MCALL", kIgnored},  // without a call beside it, it ends one
    {"TRAORI", kTool},
    {"PAROT", kRefused, kFrames},
    {"TOROT", kRefused, kFrames},
    {"TOFRAME", kRefused, kFrames},
    {"MEAFRAME", kRefused, kFrames},
    {"TOFRAMEX", kRefused, kFrames},
    {"TOFRAMEY", kRefused, kFrames},
    {"TOFRAMEZ", kRefused, kFrames},
    {"TRANSMIT", kRefused, kKinematics},
    {"TRACYL", kRefused, kKinematics},
    {"TCARR", kRefused, kKinematics},
    {"TCOFRX", kRefused, kKinematics},
    {"TCOFRY", kRefused, kKinematics},
    {"TCOFRZ", kRefused, kKinematics},
    {"CT", kRefused, kArc},
    {"CIP", kRefused, kArc},
    {"INVCW", kRefused, kArc},
    {"INVCCW", kRefused, kArc},
    {"ASPLINE", kRefused, kSpline},
    {"BSPLINE", kRefused, kSpline},
    {"CSPLINE", kRefused, kSpline},
    {"POLY", kRefused, kSpline},
    {"IF", kRefused, kFlow},
    {"ELSE", kRefused, kFlow},
    {"ENDIF", kRefused, kFlow},
    {"FOR", kRefused, kFlow},
    {"ENDFOR", kRefused, kFlow},
    {"WHILE", kRefused, kFlow},
    {"ENDWHILE", kRefused, kFlow},
    {"LOOP", kRefused, kFlow},
    {"ENDLOOP", kRefused, kFlow},
    {"CASE", kRefused, kFlow},
    {"GOTO", kRefused, kFlow},
    {"GOTOF", kRefused, kFlow},
    {"GOTOB", kRefused, kFlow},
    {"GOTOC", kRefused, kFlow},
    {"GOTOS", kRefused, kFlow},
    {"DEF", kRefused, kFlow},
    {"REDEF", kRefused, kFlow},
    {"REPEAT", kRefused, kFlow},
    {"REPEATB", kRefused, kFlow},
    {"UNTIL", kRefused, kFlow},
    {"PROC", kRefused, kSubprogram},
    {"EXTERN", kRefused, kSubprogram},
    {"CALL", kRefused, kSubprogram},
    {"PCALL", kRefused, kSubprogram},
    {"EXTCALL", kRefused, kSubprogram},
    {"RET", kRefused, kSubprogram},
    {"WHEN", kRefused, kSync},
    {"WHENEVER", kRefused, kSync},
    {"EVERY", kRefused, kSync},
    {"DO", kRefused, kSync},
    {"ID", kRefused, kSync},
    {"IDS", kRefused, kSync},
    {"FROM", kRefused, kSync},
    {"MEAS", kRefused, kSync},
    {"REPOSL", kRefused, kAxes},
    {"REPOSA", kRefused, kAxes},
    {"FXS", kRefused, kAxes},
};

constexpr SiemensName kAddresses[] = {
    // Limits of compressors, of dynamics and of the spindle.
    {"CTOL"},
    {"OTOL"},
    {"ATOL"},
    {"STOLF"},
    {"LIMS"},
    {"OVR"},
    {"FRCM"},
    {"FRC"},
    {"SPOS", kSpindle},
    {"SPOSA", kSpindle},
    {"ACCLIMA"},
    {"RND", kZeroOnly, kCorner},
    {"RNDM", kZeroOnly, kCorner},
    {"CHF", kZeroOnly, kCorner},
    {"CHR", kZeroOnly, kCorner},
    {"OFFN", kZeroOnly, kOffset},
    {"TOFFL", kZeroOnly, kOffset},
    {"TOFFR", kZeroOnly, kOffset},
    {"TOFF", kZeroOnly, kOffset},
    {"TCARR", kZeroOnly, kKinematics},
    {"A", kZeroOnly, kKinematics},
    {"B", kZeroOnly, kKinematics},
    {"C", kZeroOnly, kKinematics},
    {"A2", kZeroOnly, kKinematics},
    {"B2", kZeroOnly, kKinematics},
    {"C2", kZeroOnly, kKinematics},
    {"A3", kRefused, kKinematics},
    {"B3", kRefused, kKinematics},
    {"C3", kRefused, kKinematics},
    {"AR", kRefused, kArc},
    {"I1", kRefused, kArc},
    {"J1", kRefused, kArc},
    {"K1", kRefused, kArc},
    {"AP", kRefused, kPolar},
    {"RP", kRefused, kPolar},
    {"ANG", kRefused, kPolar},
    {"ANG1", kRefused, kPolar},
    {"ANG2", kRefused, kPolar},
    {"RPL", kRefused, kFrames},
    {"DISR", kRefused, kSoft},
    {"DISCL", kRefused, kSoft},
    {"DISRP", kRefused, kSoft},
    {"FAD", kRefused, kSoft},
};

constexpr SiemensName kCalls[] = {
    // Messages, pictures of the stock, and groups of the editor.
    {"MSG"},
    {"WORKPIECE"},
    {"GROUP_BEGIN"},
    {"GROUP_END"},
    {"GROUP_ADDEND"},
    {"SETMS"},
    {"FGROUP"},
    {"TRAFOOF"},
    {"SPI"},
    {"STOPRE"},
    {"SBLOF"},
    {"SBLON"},
    {"TRAORI", kTool},
    {"TRANSMIT", kRefused, kKinematics},
    {"TRACYL", kRefused, kKinematics},
    {"TRAANG", kRefused, kKinematics},
    {"CASE", kRefused, kFlow},
    {"IF", kRefused, kFlow},
    {"WHILE", kRefused, kFlow},
    {"EXTCALL", kRefused, kSubprogram},
    {"POS", kRefused, kAxes},
    {"POSA", kRefused, kAxes},
};

const SiemensName* FindName(std::span<const SiemensName> names, std::string_view name) {
  const auto found =
      std::find_if(names.begin(), names.end(), [&](const SiemensName& known) { return known.name == name; });
  return found == names.end() ? nullptr : &*found;
}

bool StartsWith(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

}  // namespace

const SiemensName* FindKeyword(std::string_view name) { return FindName(kKeywords, name); }

const SiemensName* FindAddress(std::string_view name) {
  if (const SiemensName* const known = FindName(kAddresses, name); known != nullptr) return known;
  static constexpr SiemensName kVariable = {"", kRefused, "assignments and parameters are not supported"};
  const bool parameter = name.size() > 1 && name[0] == 'R' && name[1] >= '0' && name[1] <= '9';
  return parameter || StartsWith(name, "$") ? &kVariable : nullptr;
}

const SiemensName* FindCall(std::string_view name) {
  if (const SiemensName* const known = FindName(kCalls, name); known != nullptr) return known;
  static constexpr SiemensName kCycles = {"", kRefused, kCycle};
  for (const char* const start : {"CYCLE", "HOLES", "POCKET", "SLOT", "LONGHOLE", "E_", "F_"}) {
    if (StartsWith(name, start)) return &kCycles;
  }
  return nullptr;
}

}  // namespace patchmill
