// What is said of a post file without a part.
#include "cam/plan/check_post.h"

#include <absl/strings/str_replace.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patchmill {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// The Fanuc post file with texts replaced, each of which it has.
std::string OwnFanuc(const std::vector<std::pair<std::string, std::string>>& changes) {
  std::string text = FindDialect("fanuc")->text;
  for (const auto& [from, to] : changes) {
    EXPECT_NE(text.find(from), std::string::npos) << from;
    text = absl::StrReplaceAll(text, {{from, to}});
  }
  return text;
}

std::vector<std::string> Messages(const PostCheck& check) {
  std::vector<std::string> messages;
  for (const PostFault& fault : check.faults) messages.push_back(fault.message);
  return messages;
}

TEST(CheckPostFile, ShippedFilesHaveNoFaults) {
  for (const Dialect& dialect : Dialects()) {
    const PostCheck check = CheckPostFile(dialect.text);
    EXPECT_THAT(Messages(check), IsEmpty()) << dialect.name;
    EXPECT_EQ(check.name, dialect.name);
    EXPECT_EQ(check.base, dialect.name);
    EXPECT_TRUE(check.own_lines.empty() && check.missing_lines.empty()) << dialect.name;
  }
}

TEST(CheckPostFile, SaysWhatIsDerived) {
  const PostCheck check =
      CheckPostFile(OwnFanuc({{"name = fanuc", "name = shop\n# ours"}, {"M9\n", "M9\nM5\n"}}));
  EXPECT_THAT(Messages(check), IsEmpty());
  EXPECT_EQ(check.name, "shop");
  EXPECT_EQ(check.base, "fanuc");
  ASSERT_EQ(check.own_lines.size(), 2u);
  EXPECT_EQ(check.own_lines[0].text, "name = shop");
  EXPECT_EQ(check.own_lines[0].line, 5);
  EXPECT_EQ(check.own_lines[1].text, "M5");
  EXPECT_THAT(check.missing_lines, ElementsAre("name = fanuc"));
}

TEST(CheckPostFile, NamesEveryFaultOfTheLines) {
  const PostCheck check = CheckPostFile(
      OwnFanuc({{"decimals = 3", "decimals = 9"}, {"[arcs]", "[arc]"}, {"S{speed} M3", "S{sped} M3"}}));
  ASSERT_EQ(check.faults.size(), 4u) << ::testing::PrintToString(Messages(check));
  EXPECT_THAT(check.faults[0].message, HasSubstr("decimals: = \"9\""));
  EXPECT_THAT(check.faults[1].message, HasSubstr("\"[arc]\": must be [control]"));
  EXPECT_THAT(check.faults[2].message, HasSubstr("{sped} is not a placeholder"));
  EXPECT_THAT(check.faults[3].message, HasSubstr("{sped} is not a placeholder"));
  EXPECT_LT(check.faults[2].line, check.faults[3].line);
}

TEST(CheckPostFile, NamesWhatTheProgramLacks) {
  const PostCheck unknown = CheckPostFile(OwnFanuc({{"[end]\n", "[end]\nM77\n"}}));
  ASSERT_EQ(unknown.faults.size(), 1u);
  EXPECT_THAT(unknown.faults[0].message, HasSubstr("\"M77\": M77 is not supported"));
  EXPECT_GT(unknown.faults[0].line, 0);
  const PostCheck tool = CheckPostFile(OwnFanuc({{"T{tool} M6", "T{tool}\nT5 M6"}}));
  ASSERT_FALSE(tool.faults.empty());
  EXPECT_THAT(tool.faults[0].message, HasSubstr("POST_OTHER_TOOL"));
}

// A post whose start ends with G1 lets the first rapid run as a feed.
TEST(CheckPostFile, AStartThatEndsWithAFeedIsAFault) {
  const PostCheck check = CheckPostFile(OwnFanuc({{"G43 H{tool} Z{z}", "G43 H{tool}\nG1 Z{z} F200."}}));
  ASSERT_EQ(check.faults.size(), 2u) << "[begin] and [restart]";
  EXPECT_THAT(check.faults[0].message, HasSubstr("G1 is in force after it"));
  EXPECT_THAT(check.faults[1].message, HasSubstr("G1 is in force after it"));
  EXPECT_THAT(Messages(CheckPostFile(OwnFanuc({{"G43 H{tool} Z{z}", "G43 H{tool} Z{z}\nG91"}})))[0],
              HasSubstr("G91 is in force after it"));
  EXPECT_THAT(Messages(CheckPostFile(OwnFanuc({{"G43 H{tool} Z{z}", "G1 G43 H{tool} Z{z} F200.\nG0"}}))),
              IsEmpty());
}

TEST(CheckPostFile, SaysWhatIsLeftToTheControl) {
  const auto left = [](const std::string& text) {
    return ::testing::PrintToString(CheckPostFile(text).left_to_control);
  };
  EXPECT_THAT(left(FindDialect("fanuc")->text),
              HasSubstr("no word limits how far the control leaves the path"));
  EXPECT_THAT(left(FindDialect("grbl")->text), HasSubstr("the length of the tool"));
  EXPECT_EQ(left(FindDialect("haas")->text), "{}");
  const std::string own = OwnFanuc(
      {{"name = fanuc", "name = shop"}, {"[words]", "[words]\nM77 = none"}, {"[end]\n", "[end]\nM77\n"}});
  EXPECT_THAT(left(own), HasSubstr("WORD_EXPLAINED: M77 is taken for what [words]"));
}

TEST(CheckPostFile, IsBoundedForAnyText) {
  EXPECT_EQ(CheckPostFile(std::string(1'000'000, 'x')).faults.size(), 1u);
  EXPECT_LE(CheckPostFile("[control]\n" + std::string(90'000, '\n') + std::string(1'000, 'a')).faults.size(),
            110u);
  std::string lines = "[control]\n";
  for (int k = 0; k < 10'000; ++k) lines += "a = b\n";
  EXPECT_LE(CheckPostFile(lines).faults.size(), 110u);
  EXPECT_FALSE(CheckPostFile("").faults.empty());
}

}  // namespace
}  // namespace patchmill
