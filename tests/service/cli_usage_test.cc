// The command line as people type it: slips, defaults of a shop, pages made of the options.
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/service/patchmill.h"
#include "tests/service/requests.h"

namespace patchmill {
namespace {

using testing::Finished;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Patchmill;
using testing::Slurp;
using testing::TempDir;

const std::vector<std::string> kCommands = {"mill",     "check",  "faces", "convert",      "regions",
                                            "reach",    "verify", "posts", "capabilities", "lines",
                                            "evaluate", "build",  "edit",  "fair"};

TEST(CliUsage, NamesTheNearestCommandAndOption) {
  const auto error = [](const std::vector<std::string>& arguments) {
    const Finished run = Patchmill(arguments);
    EXPECT_EQ(run.status, 2);
    return run.err;
  };
  EXPECT_THAT(error({"mil", "part.step"}), HasSubstr("mil is no command; did you mean mill?"));
  EXPECT_THAT(error({"mill", "part.step", "-o", "part.ngc", "--scalop", "0.01"}),
              HasSubstr("--scalop is no option of mill; did you mean --scallop?"));
  EXPECT_THAT(error({"mill", "part.step", "-o", "part.ngc", "--scalop=0.01"}),
              HasSubstr("--scalop is no option of mill; did you mean --scallop?"));
  EXPECT_THAT(error({"check", "part.step", "--tool-diamter", "6", "--quite"}),
              ::testing::AllOf(HasSubstr("--tool-diameter?"), HasSubstr("--quiet?")));
  EXPECT_THAT(error({"mill", "a.step", "b.step", "-o", "part.ngc"}),
              HasSubstr("mill: b.step was not expected"));
  EXPECT_THAT(error({"mill", "\x1b[2Jpart", "two\x07", "-o", "x.ngc"}), Not(HasSubstr("\x07")));
  EXPECT_THAT(error({"xyzzy"}), HasSubstr("xyzzy is no command\n"));
}

TEST(CliUsage, FaultsAreSaidInPlainWords) {
  const TempDir dir;
  const std::string model = dir.Write("bump.pb", testing::Bump().SerializeAsString());
  const struct {
    std::vector<std::string> arguments;
    std::string message;
  } cases[] = {
      {{}, "patchmill: a command is missing; there are mill, check,"},
      {{"mill"}, "patchmill mill: MODEL is missing\n  for example: patchmill mill part.step -o part.ngc"},
      {{"mill", model}, "patchmill mill: --output is missing\n  for example: "},
      {{"mill", model, "-o"}, "patchmill mill: --output needs a value\n'patchmill mill --help' lists"},
      {{"mill", model, "-o", "x.ngc", "--feed"}, "--feed needs a value\n"},
      {{"mill", model, "-o", "x.ngc", "--feed", "1", "--feed", "2"},
       "--feed is given 2 times; give it once\n"},
      {{"mill", model, "-o", "x.ngc", "--translate", "1", "2"}, "--translate has 2 values; must have 3\n"},
      {{"mill", model, "-o", "x.ngc", "--coolant", "flod"},
       "--coolant flod; must be one of off, flood, mist, air; did you mean flood?\n"},
      {{"mill", model, "-o", "x.ngc", "--threads", "-1"}, "--threads -1; must be in [0, 64]\n"},
      {{"check", model, "--timeout", "0"}, "--timeout 0; must be in [0.001, 1000000]\n"},
      {{"regions", model, "--detail", "3"}, "--detail 3; must be in [0, 1]\n"},
      {{"verify", model, model, "--tool", "1=6", "--tool-diameter", "6"},
       "--tool-diameter and --tool exclude each other; give one of them\n"},
      {{"completion", "zsh"}, "patchmill completion: SHELL zsh; must be bash\n"},
      {{"check", model, "--server", "localhost"}, "--server localhost; must be HOST:PORT"},
      {{"check", model, "--server", "localhost:http"}, "--server localhost:http; must be HOST:PORT"},
      {{"mill", model, "-o", "x.ngc", "--coolant", std::string(100'000, 'x')}, "--coolant: xxx"},
  };
  for (const auto& c : cases) {
    const Finished run = Patchmill(c.arguments);
    EXPECT_EQ(run.status, 2) << c.message;
    EXPECT_THAT(run.err, HasSubstr(c.message));
    EXPECT_EQ(run.out, "") << c.message;
  }
}

// The service names fields; the user has files and options.
TEST(CliUsage, FaultsOfInputsNameTheirFileOrOption) {
  const TempDir dir;
  const std::string model = dir.Write("bump.pb", testing::Bump().SerializeAsString()),
                    square = dir.Write("square.bv", "5\n1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n");
  const struct {
    std::vector<std::string> arguments;
    std::string message;
  } cases[] = {
      {{"verify", model, square, "--tool-diameter", "6"}, "patchmill: " + square + ": line 1: "},
      {{"edit", square, "-o", dir / "x.json"},
       "patchmill: " + square + ": source.file.format = \"bv\"; must be json"},
      {{"fair", square, "-o", dir / "x.csv"}, "patchmill: " + square + ": unknown format \"bv\" of a curve"},
      {{"mill", model, "-o", dir / "x.ngc", "--machine", square},
       "no machine in JSON: begins with '5'; must begin with {\n"},
      {{"mill", model, "-o", dir / "x.ngc", "--tool", "1:6"},
       "patchmill: --tool 1:6: cannot read 1: No such file"},
      {{"evaluate", square, "--at", "7,0.5,0.5"}, "patchmill: --at: patch_index[0] = 7; must be in [0, 0]"},
      {{"mill", model, "-o", dir / "x.ngc", "--scallop", "-1", "--floor", "1e9", "--bend", "90"},
       "patchmill: --scallop: job.operations[0].scallop_mm = -1; must be "},
  };
  for (const auto& c : cases) {
    const Finished run = Patchmill(c.arguments);
    EXPECT_EQ(run.status, 2) << c.message;
    EXPECT_THAT(run.err, HasSubstr(c.message));
  }
  // All wrong fields are named in one round.
  const Finished all = Patchmill({"mill", model, "-o", dir / "x.ngc", "--scallop", "-1", "--bend", "90"});
  EXPECT_THAT(all.err, HasSubstr("\n  --bend: job.operations[0].zigzag_bend_deg = 90; must be "));
  EXPECT_THAT(all.err, Not(HasSubstr(" more")));
}

// Not in the words of the library that reads the command line, and no wider than a page.
TEST(CliUsage, HelpNamesValuesPlainly) {
  const std::string mill = Patchmill({"mill", "--help"}).out;
  EXPECT_THAT(mill, HasSubstr("\n  --scallop NUMBER "));
  EXPECT_THAT(mill, HasSubstr("\n  --strategy auto|contour|zigzag\n"));
  EXPECT_THAT(mill, HasSubstr("\n  -o,--output FILE "));
  EXPECT_THAT(mill, HasSubstr("\n  --translate X,Y,Z "));
  EXPECT_THAT(mill, HasSubstr("; default linuxcnc\n"));
  EXPECT_THAT(mill, HasSubstr("; needs --boundary\n"));
  const std::string man = Patchmill({"man"}).out;
  EXPECT_THAT(man, HasSubstr("\\fINUMBER\\fR\nscallop (cusp) height"));
  std::vector<std::string> pages = {man};
  for (const std::string& command : kCommands) {
    pages.push_back(Patchmill({command, "--help"}).out);
    std::istringstream lines(pages.back());
    for (std::string line; std::getline(lines, line);) {
      const bool is_whole = line.find(' ', 28) == std::string::npos;  // a word that cannot be broken
      EXPECT_TRUE(line.size() <= 100 || is_whole || line.rfind("  patchmill", 0) == 0) << line;
    }
  }
  for (const std::string& page : pages) {
    for (const char* word : {"FLOAT", "INT:", "TEXT:", "REQUIRED", "Excludes", "Subcommand", "default ["})
      EXPECT_EQ(page.find(word), std::string::npos) << word;
  }
}

TEST(CliUsage, HelpIsGroupedAndHasAnExample) {
  for (const std::string& command : kCommands) {
    const Finished run = Patchmill({command, "--help"});
    EXPECT_EQ(run.status, 0);
    EXPECT_THAT(run.out, HasSubstr("Example:\n  patchmill " + command + " ")) << command;
    EXPECT_THAT(run.out, HasSubstr("\nService:\n")) << command;
  }
  const std::string mill = Patchmill({"mill", "--help"}).out;
  std::size_t last = 0;
  for (const char* group :
       {"Part", "Tool", "Finish", "Stock and limits", "Motion", "Program", "Output", "Service"}) {
    EXPECT_THAT(mill, HasSubstr("\n" + std::string(group) + ":\n"));
    last = mill.find("\n" + std::string(group) + ":\n", 0);
    EXPECT_NE(last, std::string::npos);
  }
  // Nothing but --help itself is in no group.
  const std::string rest = mill.substr(mill.find("\nOptions:\n") + 10);
  EXPECT_EQ(rest.substr(0, rest.find("\n\n")).find("--", rest.find("--help") + 2), std::string::npos);
}

class CliDefaults : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string json;
    ASSERT_TRUE(google::protobuf::util::MessageToJsonString(testing::HillAndPit(), &json).ok());
    model_ = in_.Write("waves.json", json);
  }
  Finished Mill(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"mill", model_, "-o", out_ / "part.ngc", "--floor", "-8"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Patchmill(arguments);
  }
  TempDir in_, out_;
  std::string model_;
};

TEST_F(CliDefaults, OfAFileGiveTheSameProgram) {
  ASSERT_EQ(Mill({"--scallop", "0.1", "--tolerance", "0.03", "--spindle", "8000", "--post", "fanuc",
                  "--high-rapids"})
                .status,
            0);
  const std::string program = Slurp(out_ / "part.ngc");
  EXPECT_THAT(program, HasSubstr("S8000"));
  const std::string shop =
      in_.Write("shop.ini",
                "# our mill\nscallop = 0.1\nspindle = 8000\nhigh-rapids = true\none-way = false\n\n"
                "[mill]\ntolerance=0.03\npost = \"fanuc\"\n[verify]\ndialect = fanuc\n");
  for (const std::vector<std::string>& config :
       {std::vector<std::string>{"--config", shop}, std::vector<std::string>{"--config=" + shop}}) {
    const Finished run = Mill(config);
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(Slurp(out_ / "part.ngc"), program);
  }
  // The section of the command goes before what stands above all sections, in whatever order.
  const std::string both = in_.Write("both.ini", "spindle = 8000\nscallop = 0.1\n[mill]\nspindle = 9000\n");
  ASSERT_EQ(Mill({"--config", both}).status, 0);
  EXPECT_THAT(Slurp(out_ / "part.ngc"), HasSubstr("S9000"));
  // Lists of values do not swallow the model.
  const std::string lists =
      in_.Write("lists.ini", "scallop = 0.1\ntranslate = [0, 0, 5]\nobstacle = \"a=9: 60,0 70,0 70,9\"\n");
  EXPECT_EQ(Patchmill({"mill", "-o", out_ / "part.ngc", model_, "--config", lists}).status, 0);
  EXPECT_EQ(Mill({"--config", lists}).status, 0);
  // The command line goes before the file.
  ASSERT_EQ(Mill({"--config", shop, "--spindle", "9000"}).status, 0);
  EXPECT_THAT(Slurp(out_ / "part.ngc"), HasSubstr("S9000"));
}

TEST_F(CliDefaults, FaultsOfTheFileAreNamed) {
  const auto error = [&](const std::string& text) {
    const Finished run = Mill({"--config", in_.Write("bad.ini", text)});
    EXPECT_EQ(run.status, 2) << text;
    return run.err;
  };
  EXPECT_THAT(error("scalop = 0.1\n"), HasSubstr("scalop is no option; did you mean scallop?"));
  EXPECT_THAT(error("[mil]\nscallop = 0.1\n"), HasSubstr("sections are named as commands"));
  EXPECT_THAT(error("[mill]\nkind = contour\n"), HasSubstr("mill.kind is no option"));
  EXPECT_THAT(error("high-rapids = perhaps\n"), HasSubstr("high-rapids = perhaps; must be true or false"));
  EXPECT_THAT(error("scallop = much\n"), HasSubstr("\"much\" is not a finite number"));
  EXPECT_THAT(error("scallop = much\n"),
              HasSubstr("--scallop comes from --config " + in_ / "bad.ini" + ".\n"));
  EXPECT_THAT(error("# shop\nscallop\n"),
              HasSubstr("bad.ini: line 2: \"scallop\"; must be NAME = VALUE, [COMMAND]"));
  EXPECT_THAT(error("= 3\n"), HasSubstr("line 1: \"= 3\"; must be"));
  EXPECT_THAT(error("scallop =\n"), HasSubstr("line 1: \"scallop =\"; must be"));
  EXPECT_THAT(error("\n[mill\n"), HasSubstr("line 2: \"[mill\"; must be"));
  EXPECT_THAT(error("\xff\xfe"), HasSubstr("line 1: "));
  EXPECT_THAT(error("spindle = \"8000\n"), HasSubstr("line 1: \"8000 has no closing quote"));
  EXPECT_THAT(error("help = true\n"), HasSubstr("help is no option\n"));
  EXPECT_EQ(Mill({"--config", in_ / "missing.ini"}).status, 2);
  EXPECT_EQ(Mill({"--config"}).status, 2);
}

TEST_F(CliDefaults, OneCommandLineServesSeveralCommands) {
  const std::vector<std::string> options = {"--scallop", "0.1", "--tolerance",   "0.03",   "--floor", "-8",
                                            "--feed",    "900", "--high-rapids", "--bend", "10"};
  std::vector<std::string> regions = {"regions", model_};
  regions.insert(regions.end(), options.begin(), options.end());
  const Finished run = Patchmill(regions);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("patchmill regions: without effect: --bend --feed --high-rapids"));
  std::vector<std::string> reach = {"reach",           model_, "--flute-length",   "20",
                                    "--tool-diameter", "6",    "--tool-diameters", "2,6"};
  reach.insert(reach.end(), options.begin(), options.end());
  const Finished table = Patchmill(reach);
  EXPECT_EQ(table.status, 0) << table.err;
  EXPECT_THAT(table.err, HasSubstr("--flute-length"));
  EXPECT_THAT(Patchmill({"reach", "--help"}).out, Not(HasSubstr("--flute-length")));
}

TEST_F(CliDefaults, PicturesThatNobodyWritesAreNamed) {
  const std::vector<std::string> coarse = {"--scallop", "0.1", "--tolerance", "0.03"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), coarse.begin(), coarse.end());
    return Mill(more).err;
  };
  const char* const idle = "patchmill mill: without effect: --picture-view --picture-size\n";
  EXPECT_THAT(with({"--picture-view", "top", "--picture-size", "640x480"}), HasSubstr(idle));
  EXPECT_THAT(with({"--picture-view", "top", "--preview", out_ / "x.svg", "--picture-size", "640x480"}),
              HasSubstr(idle));
  EXPECT_THAT(with({"--picture-view", "top", "--preview", out_ / "x.png"}), Not(HasSubstr("without effect")));
  // Defaults of a shop are for all jobs.
  EXPECT_THAT(with({"--config", in_.Write("shop.ini", "picture-view = top\n")}),
              Not(HasSubstr("without effect")));
}

TEST_F(CliDefaults, ResultsGoToTheStandardOutput) {
  const Finished run =
      Patchmill({"mill", model_, "-o", "-", "--floor", "-8", "--scallop", "0.1", "--tolerance", "0.03"});
  ASSERT_EQ(run.status, 0) << run.err;
  ASSERT_EQ(Mill({"--scallop", "0.1", "--tolerance", "0.03"}).status, 0);
  EXPECT_EQ(run.out, Slurp(out_ / "part.ngc"));
  const Finished both = Patchmill({"mill", model_, "-o", "-", "--report", "-"});
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.err, HasSubstr("two results go to the standard output; give one of them a file"));
  EXPECT_EQ(both.out, "");
  const Finished map = Patchmill({"regions", model_, "-o", "-", "--floor", "-8"});
  ASSERT_EQ(map.status, 0) << map.err;
  EXPECT_EQ(map.out.front(), '{');
  EXPECT_EQ(map.out.substr(map.out.size() - 2), "}\n");
}

TEST_F(CliDefaults, InputsComeFromTheStandardInput) {
  ASSERT_EQ(Mill({"--scallop", "0.1", "--tolerance", "0.03"}).status, 0);
  const std::string line = PATCHMILL_BIN "/patchmill check - < " + model_;
  EXPECT_EQ(testing::Run({"/bin/bash", "-c", line}).out, Patchmill({"check", model_}).out);
  const std::string verify = PATCHMILL_BIN "/patchmill verify " + model_ +
                             " - --tool-diameter 6 --floor -8 --scallop 0.1 --tolerance 0.03 < " +
                             out_ / "part.ngc";
  const Finished judged = testing::Run({"/bin/bash", "-c", verify});
  EXPECT_EQ(judged.status, 0) << judged.err;
  EXPECT_THAT(judged.out, HasSubstr("finish    PASSED"));
  // A file is no result of the command that reads it, whatever its name.
  const Finished over =
      testing::Run({"/bin/bash", "-c", PATCHMILL_BIN "/patchmill convert - " + model_ + " < " + model_});
  EXPECT_EQ(over.status, 2);
  EXPECT_THAT(over.err, HasSubstr("is an input"));
}

TEST_F(CliDefaults, TheUnitOfAFileWithoutOneIsStated) {
  const std::string square = in_.Write("square.bv", "5\n1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n");
  const std::string inches = Patchmill({"check", square, "--length-unit", "inch"}).out;
  EXPECT_THAT(inches, HasSubstr("X 25.400 Y 25.400"));
  EXPECT_THAT(inches, Not(HasSubstr("states no unit")));
  EXPECT_THAT(Patchmill({"check", square}).out, HasSubstr("the file states no unit"));
  const Finished stated = Patchmill({"check", model_, "--length-unit", "inch"});
  EXPECT_EQ(stated.status, 2);
  EXPECT_THAT(stated.err, HasSubstr("--length-unit"));
}

TEST_F(CliDefaults, AxesAreReadInCapitals) {
  EXPECT_EQ(Patchmill({"check", model_, "--up", "Z"}).out, Patchmill({"check", model_, "--up", "z"}).out);
  EXPECT_EQ(Patchmill({"check", model_, "--up", "-X"}).out, Patchmill({"check", model_, "--up", "-x"}).out);
}

TEST_F(CliDefaults, AMissingUnitAndASlipSayWhatToWrite) {
  const Finished unit =
      Patchmill({"check", in_.Write("nounit.json", R"({"patches": [{"id": "a", "bezier": {"degree_u": 1,
    "degree_v": 1, "points": [0, 0, 0, 0, 9, 0, 9, 0, 0, 9, 9, 0]}}]})")});
  EXPECT_EQ(unit.status, 2);
  EXPECT_THAT(unit.err, HasSubstr("nounit.json"));
  EXPECT_THAT(unit.err, HasSubstr("add \"length_unit\": \"LENGTH_UNIT_MILLIMETER\""));
  const Finished slip =
      Patchmill({"check", in_.Write("slip.json", R"({"length_unit": "LENGTH_UNIT_MILLIMETER", "patches":
    [{"id": "a", "bezier": {"degre_u": 1}}]})")});
  EXPECT_EQ(slip.status, 2);
  EXPECT_THAT(slip.err, HasSubstr("slip.json"));
  EXPECT_THAT(slip.err, HasSubstr("Did you mean degree_u?"));
}

// The words that the script offers at the end of a line, which bash has cut into these words.
std::string Offered(const std::string& line, const std::string& folder) {
  const TempDir dir;
  const std::string script = dir.Write("completion.bash", Patchmill({"completion", "bash"}).out);
  const std::string code =
      "cd '" + folder + "' && source " + script + "; COMP_WORDS=(" + line +
      "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _patchmill; printf '%s,' \"${COMPREPLY[@]}\"";
  const Finished run = patchmill::testing::Run({"/bin/bash", "-c", code});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  return run.out;
}

TEST(CliPages, CompleteCommandsOptionsAndValues) {
  const TempDir dir;
  const auto offered = [&](const std::string& line) { return Offered(line, dir / ""); };
  EXPECT_EQ(offered("patchmill mi"), "mill,");
  EXPECT_EQ(offered("patchmill mill --scal"), "--scallop,--scale,");
  EXPECT_EQ(offered("patchmill mill --coolant f"), "flood,");
  EXPECT_EQ(offered("patchmill mill part.json --coolant = f"), "flood,");
  EXPECT_EQ(offered("patchmill mill part.json --coolant ="), "off,flood,mist,air,");
  EXPECT_EQ(offered("patchmill completion b"), "bash,");
  for (const std::string& command : kCommands)
    EXPECT_THAT(offered("patchmill " + command.substr(0, command.size() - 1)), HasSubstr(command));
  // The defaults of a shop may stand before the command, and may be named as one.
  EXPECT_EQ(offered("patchmill --config shop.ini mi"), "mill,");
  EXPECT_EQ(offered("patchmill --config = mill mi"), "mill,");
  EXPECT_EQ(offered("patchmill --config shop.ini mill --coolant f"), "flood,");
}

TEST(CliPages, CompletePostsByNameAndByFile) {
  const TempDir dir;
  dir.Write("fast mill.post", "");
  dir.Write("folder", "");
  const auto offered = [&](const std::string& line) { return Offered(line, dir / ""); };
  std::string names;
  const std::string list = Patchmill({"posts"}).out;
  const std::regex name("\n([a-z0-9]+) ");
  for (std::sregex_iterator it(list.begin(), list.end(), name), end; it != end; ++it)
    names += (*it)[1].str() + ",";
  EXPECT_THAT(names, HasSubstr("fanuc,"));
  EXPECT_EQ(offered("patchmill mill --post ''"), names + "fast mill.post,./folder,");
  EXPECT_EQ(offered("patchmill mill --post fa"), "fanuc,fast mill.post,");
  EXPECT_EQ(offered("patchmill mill --post = fan"), "fanuc,");
  EXPECT_EQ(offered("patchmill verify a.json a.ngc --dialect gr"), "grbl,");
  EXPECT_EQ(offered("patchmill posts hei"), "heidenhain,");
}

// A line as it is typed at a terminal, with tabs; what bash then runs instead of patchmill.
std::string Typed(const std::string& line, const std::string& folder) {
  const TempDir dir;
  const std::string script = dir.Write("completion.bash", Patchmill({"completion", "bash"}).out);
  int terminal = -1;
  const pid_t shell = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (shell == 0) {
    setenv("TERM", "dumb", 1);
    setenv("PS1", "", 1);
    if (chdir(folder.c_str()) == 0) execl("/bin/bash", "bash", "--norc", "--noprofile", "-i", nullptr);
    _exit(127);
  }
  std::string setting = "stty -echo; bind 'set bell-style none'; source " + script +
                        "; patchmill() { printf '<%s>' ran \"$@\"; echo; exit; }; echo ready\n";
  std::string shown;
  const auto wait = [&](const std::string& text) {
    pollfd event{terminal, POLLIN, 0};
    char bytes[4096];
    while (shown.find(text) == shown.npos && poll(&event, 1, 20'000) > 0) {
      const ssize_t n = read(terminal, bytes, sizeof bytes);
      if (n <= 0) break;
      shown.append(bytes, static_cast<std::size_t>(n));
    }
  };
  EXPECT_EQ(write(terminal, setting.data(), setting.size()), static_cast<ssize_t>(setting.size()));
  wait("ready\r\n");
  const std::string keys = line + "\n";
  EXPECT_EQ(write(terminal, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  wait("<ran>");
  wait(">\r\n");
  kill(shell, SIGKILL);
  waitpid(shell, nullptr, 0);
  close(terminal);
  const std::size_t from = shown.rfind("<ran>");
  return from == shown.npos ? shown : shown.substr(from, shown.find('\r', from) - from);
}

TEST(CliPages, CompleteFilesWithBlanksWhole) {
  const TempDir dir;
  dir.Write("my part.json", "");
  dir.Write("shop defaults.ini", "");
  dir.Write("fast mill.post", "");
  std::filesystem::create_directory(dir / "new parts");
  dir.Write("new parts/door handle.step", "");
  const auto typed = [&](const std::string& line) { return Typed(line, dir / ""); };
  EXPECT_EQ(typed("patchmill check my\t"), "<ran><check><my part.json>");
  EXPECT_EQ(typed("patchmill che\t ne\tdo\t--qui\t"), "<ran><check><new parts/door handle.step><--quiet>");
  EXPECT_EQ(typed("patchmill check \"new p\tdo\t"), "<ran><check><new parts/door handle.step>");
  EXPECT_EQ(typed("patchmill --config sh\tmi\t my\t"),
            "<ran><--config><shop defaults.ini><mill><my part.json>");
  EXPECT_EQ(typed("patchmill mill 'my part.json' --config sh\t"),
            "<ran><mill><my part.json><--config><shop defaults.ini>");
  EXPECT_EQ(typed("patchmill mill my\t--only 'lid left' --post fas\t"),
            "<ran><mill><my part.json><--only><lid left><--post><fast mill.post>");
  EXPECT_EQ(typed("patchmill mill my\t--only 'lid left' --coolant fl\t"),
            "<ran><mill><my part.json><--only><lid left><--coolant><flood>");
}

TEST(CliPages, TheManualHasAllCommandsAndOptions) {
  const Finished man = Patchmill({"man"});
  ASSERT_EQ(man.status, 0);
  EXPECT_EQ(man.out.substr(0, 4), ".TH ");
  for (const std::string& command : kCommands) {
    EXPECT_THAT(man.out, HasSubstr("\n.SS " + command + "\n"));
    const std::string help = Patchmill({command, "--help"}).out;
    const std::regex option("\n  (-[a-z],)?--([a-z0-9-]+)");
    for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it) {
      EXPECT_THAT(man.out, HasSubstr("\\-\\-" + std::regex_replace((*it)[2].str(), std::regex("-"), "\\-")))
          << command;
    }
  }
}

}  // namespace
}  // namespace patchmill
