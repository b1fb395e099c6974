// Where results go: all or none of them, through links, into pipes, and what signals leave behind.
#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/service/patchmill.h"
#include "tests/service/requests.h"

namespace patchmill {
namespace {

using namespace std::chrono_literals;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Patchmill;
using testing::Process;
using testing::Slurp;
using testing::TempDir;
using ::testing::UnorderedElementsAre;

const std::string kPatchmill = PATCHMILL_BIN "/patchmill";

mode_t ModeOf(const std::string& path) {
  struct stat info {};
  EXPECT_EQ(stat(path.c_str(), &info), 0) << path;
  return info.st_mode & 07777;
}

bool IsPipe(const std::string& path) {
  struct stat info {};
  return lstat(path.c_str(), &info) == 0 && S_ISFIFO(info.st_mode);
}

class CliFiles : public ::testing::Test {
 protected:
  std::vector<std::string> Mill(const std::string& program, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"mill", bump_, "-o", program, "--tolerance", "0.02", "--floor", "-1"};
    if (std::find(more.begin(), more.end(), "--scallop") == more.end())
      words.insert(words.end(), {"--scallop", "0.05"});
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  // The program of a shell that runs these words after `setting`.
  static std::vector<std::string> InShell(const std::string& setting, const std::vector<std::string>& words) {
    std::vector<std::string> command = {"/bin/bash", "-c", setting + "; exec \"$@\"", "bash", kPatchmill};
    command.insert(command.end(), words.begin(), words.end());
    return command;
  }
  static std::vector<std::string> Command(std::vector<std::string> words) {
    words.insert(words.begin(), kPatchmill);
    return words;
  }
  bool HasTemporary() const {
    const std::vector<std::string> names = out_.Names();
    return std::any_of(names.begin(), names.end(),
                       [](const std::string& name) { return name.starts_with(".patchmill-"); });
  }
  // Whether a temporary file is there within a minute: all but the pipes is written then.
  bool WaitForTemporary() const {
    for (int i = 0; i < 3000 && !HasTemporary(); ++i) std::this_thread::sleep_for(20ms);
    return HasTemporary();
  }

  TempDir in_, out_;
  std::string bump_ = in_.Write("bump.pb", testing::Bump().SerializeAsString());
  std::string long_ = in_.Write("long.pb", testing::Bump(380.0).SerializeAsString());  // minutes of work
};

TEST_F(CliFiles, LinksStayAndModesAreKept) {
  out_.Write("part.ngc", "old");
  ASSERT_EQ(chmod((out_ / "part.ngc").c_str(), 0640), 0);
  std::filesystem::create_symlink("part.ngc", out_ / "second");
  std::filesystem::create_symlink("second", out_ / "first");
  std::filesystem::create_symlink("report.json", out_ / "to_nothing");
  const Finished run = Patchmill(Mill(out_ / "first", {"--report", out_ / "to_nothing"}));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(out_.Names(), UnorderedElementsAre("part.ngc", "first", "second", "to_nothing", "report.json"));
  for (const char* link : {"first", "second", "to_nothing"})
    EXPECT_TRUE(std::filesystem::is_symlink(out_ / link)) << link;
  EXPECT_THAT(Slurp(out_ / "part.ngc"), HasSubstr("G21"));
  EXPECT_EQ(ModeOf(out_ / "part.ngc"), mode_t{0640});
  EXPECT_EQ(ModeOf(out_ / "report.json"), ModeOf(out_.Write("plain", "")));
}

TEST_F(CliFiles, ALinkAndItsTargetAreOneFile) {
  std::filesystem::create_symlink("part.ngc", out_ / "link");
  const Finished run = Patchmill(Mill(out_ / "link", {"--report", out_ / "part.ngc"}));
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr("is the output file of two results"));
  std::filesystem::create_symlink(bump_, out_ / "model");
  const Finished input = Patchmill(Mill(out_ / "model"));
  EXPECT_EQ(input.status, 2);
  EXPECT_THAT(input.err, HasSubstr("is an input"));
}

TEST_F(CliFiles, CircularLinksAreSaidBeforeTheJob) {
  std::filesystem::create_symlink("b", out_ / "a");
  std::filesystem::create_symlink("a", out_ / "b");
  const Finished run = Patchmill(Mill(out_ / "a"));
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, HasSubstr("cannot write " + out_ / "a" + ": Too many levels of symbolic links"));
}

TEST_F(CliFiles, AFileThatMayNotBeWrittenIsNotReplaced) {
  out_.Write("part.ngc", "released");
  ASSERT_EQ(chmod((out_ / "part.ngc").c_str(), 0444), 0);
  std::vector<std::string> command = Command(Mill(out_ / "part.ngc"));
  if (geteuid() == 0) {  // who may write everything
    for (const TempDir* dir : {&in_, &out_}) ASSERT_EQ(chmod((*dir / "").c_str(), 0777), 0);
    const std::vector<std::string> other = {"/usr/bin/setpriv", "--reuid=65534", "--clear-groups"};
    command.insert(command.begin(), other.begin(), other.end());
    std::vector<std::string> version = other;
    version.insert(version.end(), {kPatchmill, "--version"});
    if (testing::Run(version).status != 0) GTEST_SKIP() << "other users cannot start " << kPatchmill;
  }
  const Finished run = testing::Run(command);
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, HasSubstr("cannot write " + out_ / "part.ngc" + ": Permission denied"));
  EXPECT_EQ(Slurp(out_ / "part.ngc"), "released");
}

// The program is written last, and the disk is full by then.
TEST_F(CliFiles, ResultsAreWrittenAllOrNone) {
  const std::vector<std::string> words =
      Mill(out_ / "part.ngc", {"--report", out_ / "report.json", "--scallop", "0.002"});
  ASSERT_EQ(Patchmill(words).status, 0);
  const std::size_t program = Slurp(out_ / "part.ngc").size();
  ASSERT_GT(program, Slurp(out_ / "report.json").size() + 2048);
  out_.Write("part.ngc", "old program");
  out_.Write("report.json", "old report");
  const Finished run =
      testing::Run(InShell(fmt::format("trap '' XFSZ; ulimit -f {}", program / 1024 - 1), words));
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, HasSubstr("cannot write " + out_ / "part.ngc" + ": File too large"));
  EXPECT_EQ(Slurp(out_ / "part.ngc"), "old program");
  EXPECT_EQ(Slurp(out_ / "report.json"), "old report");
  EXPECT_THAT(out_.Names(), UnorderedElementsAre("part.ngc", "report.json"));
}

TEST_F(CliFiles, APipeIsWrittenAndStaysAPipe) {
  ASSERT_EQ(mkfifo((out_ / "pipe").c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = Slurp(out_ / "pipe"); });
  const Finished run = Patchmill(Mill(out_ / "pipe"));
  reader.join();
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(IsPipe(out_ / "pipe"));
  ASSERT_EQ(Patchmill(Mill(out_ / "part.ngc")).status, 0);
  EXPECT_EQ(read, Slurp(out_ / "part.ngc"));
}

TEST_F(CliFiles, AReaderThatHasGoneLeavesNothing) {
  std::string line = kPatchmill;
  for (const std::string& word : Mill("-", {"--report", out_ / "report.json"})) line += " '" + word + "'";
  const Finished run = testing::Run({"/bin/bash", "-c", line + " | true; exit ${PIPESTATUS[0]}"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, HasSubstr("cannot write the standard output: Broken pipe"));
  EXPECT_THAT(out_.Names(), IsEmpty());
}

TEST_F(CliFiles, APipeWithoutAReaderObeysSignals) {
  ASSERT_EQ(mkfifo((out_ / "pipe").c_str(), 0600), 0);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    Process process(Command(Mill(out_ / "pipe", {"--report", out_ / "report.json"})));
    ASSERT_TRUE(WaitForTemporary()) << process.Err();
    process.Signal(number);
    EXPECT_EQ(process.Wait(), 1);
    EXPECT_THAT(process.Err(), HasSubstr("patchmill: interrupted"));
    EXPECT_THAT(out_.Names(), UnorderedElementsAre("pipe"));
  }
}

TEST_F(CliFiles, APipeWithoutAWriterObeysSignals) {
  ASSERT_EQ(mkfifo((in_ / "part.json").c_str(), 0600), 0);
  Process process(Command({"check", in_ / "part.json"}));
  std::this_thread::sleep_for(500ms);
  process.Signal(SIGTERM);
  EXPECT_EQ(process.Wait(), 1);
  EXPECT_THAT(process.Err(), HasSubstr("patchmill: interrupted"));
}

TEST_F(CliFiles, AHangUpEndsAJobUnlessItIsIgnored) {
  const std::vector<std::string> words = {"mill",  long_,         "-o",   out_ / "part.ngc", "--scallop",
                                          "0.002", "--tolerance", "0.01", "--tool-diameter", "2"};
  Process plain(Command(words));
  Process nohup(InShell("trap '' HUP", words));
  std::this_thread::sleep_for(700ms);
  for (const Process* process : {&plain, &nohup}) process->Signal(SIGHUP);
  EXPECT_EQ(plain.Wait(), 1);
  EXPECT_THAT(plain.Err(), HasSubstr("interrupted"));
  std::this_thread::sleep_for(300ms);
  EXPECT_THAT(nohup.Err(), IsEmpty());
  nohup.Signal(SIGTERM);
  EXPECT_EQ(nohup.Wait(), 1);
  EXPECT_THAT(out_.Names(), IsEmpty());
}

}  // namespace
}  // namespace patchmill
