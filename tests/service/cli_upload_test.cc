// Models that are too large for one message: the command line sends them in pieces.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/daemon.h"
#include "tests/service/patchmill.h"
#include "tests/support/files.h"

namespace patchmill {
namespace {

using testing::Daemon;
using testing::Finished;
using ::testing::HasSubstr;
using testing::Patchmill;
using testing::Slurp;
using testing::TempDir;

const std::string kBlanks(std::size_t{70} << 20, ' ');

Finished Mill(const TempDir& folder, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {"mill", folder / "mouse.json", "--scallop", "0.3", "--tolerance", "0.05",
                                    "-o",   folder / "out.ngc"};
  words.insert(words.end(), more.begin(), more.end());
  return Patchmill(words);
}

// Blanks behind the same model make the file larger than a message.
TEST(CliUpload, ALargeFileGivesTheBytesOfTheSmallOne) {
  const std::string mouse = testing::ReadRepositoryFile("examples/mouse.json");
  const TempDir small, large;
  small.Write("mouse.json", mouse);
  large.Write("mouse.json", mouse + kBlanks);
  const Finished plain = Mill(small);
  ASSERT_EQ(plain.status, 0) << plain.err;
  const std::string program = Slurp(small / "out.ngc");
  Daemon daemon(PATCHMILL_BIN "/patchmilld");
  for (const bool remote : {false, true}) {
    std::vector<std::string> where;
    if (remote) where = {"--server", daemon.target()};
    const Finished finished = Mill(large, where);
    ASSERT_EQ(finished.status, 0) << finished.err;
    EXPECT_EQ(Slurp(large / "out.ngc"), program) << remote;
    where.insert(where.begin(), {"check", large / "mouse.json"});
    const Finished checked = Patchmill(where);
    EXPECT_EQ(checked.status, 0) << checked.err;
    EXPECT_EQ(checked.out, Patchmill({"check", small / "mouse.json"}).out) << remote;
  }
}

TEST(CliUpload, ALargeFileThatIsWrongSaysWhatIsWrong) {
  const TempDir folder;
  folder.Write("mouse.json",
               R"({"lengthUnit":"LENGTH_UNIT_MILLIMETER","patches":[{"bezier":{"degreeU":99}}]})" + kBlanks);
  const Finished wrong = Mill(folder);
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("degree"));
  folder.Write("mouse.json", "{" + kBlanks);
  EXPECT_EQ(Mill(folder).status, 2);
}

TEST(CliUpload, AFileBeyondTheLimitIsRefusedBeforeItIsSent) {
  const TempDir folder;
  const std::string path = folder.Write("mouse.json", "");
  std::filesystem::resize_file(path, (std::size_t{256} << 20) + 1);
  const Finished wrong = Mill(folder);
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("256 MiB"));
}

}  // namespace
}  // namespace patchmill
