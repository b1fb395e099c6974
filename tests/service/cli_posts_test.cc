// `patchmill posts` as a user meets it.
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/patchmill.h"

namespace patchmill {
namespace {

using testing::Finished;
using ::testing::HasSubstr;
using testing::Patchmill;
using testing::TempDir;

// A file with a text of the printed Fanuc post in place of another.
std::string Shop(const TempDir& out, const std::string& from, const std::string& to) {
  std::string text = Patchmill({"posts", "fanuc"}).out;
  EXPECT_NE(text.find(from), std::string::npos) << from;
  text.replace(text.find(from), from.size(), to);
  const std::string path = out / "shop.post";
  std::ofstream(path) << text;
  return path;
}

TEST(CliPosts, ChecksAFileWithoutFaults) {
  const TempDir out;
  const std::string path = Shop(out, "name = fanuc", "name = shop");
  const Finished run = Patchmill({"posts", "--check", path});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr(path + ": no faults; dialect shop\n"));
  EXPECT_THAT(run.out,
              HasSubstr("derived from fanuc: 1 line of its own, 1 of fanuc missing\n  + 5: name = shop\n"));
  EXPECT_THAT(run.out, HasSubstr("left to the control:\n"));
}

TEST(CliPosts, NamesTheLineOfAFault) {
  const TempDir out;
  const std::string path = Shop(out, "decimals = 3", "decimals = 9");
  const Finished run = Patchmill({"posts", "--check", path});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.out, HasSubstr(path + ":8: decimals: = \"9\"; must be a number from 2 to 6\n"));
  EXPECT_THAT(run.err, HasSubstr("1 fault\n"));
  EXPECT_EQ(Patchmill({"posts", "--check", out / "nowhere.post"}).status, 2);
  EXPECT_EQ(Patchmill({"posts", "fanuc", "--check", path}).status, 2);
}

}  // namespace
}  // namespace patchmill
