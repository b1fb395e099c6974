// What somebody may have meant: closed cases, and the fields of messages in JSON.
#include "proto/json/nearest_word.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "patchmill/v1/model.pb.h"
#include "proto/json/json_message.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;

TEST(NearestWord, TakesTheFewestChanges) {
  const std::vector<std::string> words = {"mill", "check", "faces", "fair", "verify", "--scallop", "--scale"};
  EXPECT_EQ(NearestWord("mil", words), "mill");
  EXPECT_EQ(NearestWord("milll", words), "mill");
  EXPECT_EQ(NearestWord("mlil", words), "mill");
  EXPECT_EQ(NearestWord("verfiy", words), "verify");
  EXPECT_EQ(NearestWord("--scalop", words), "--scallop");
  EXPECT_EQ(NearestWord("--scal", words), "--scale");
  EXPECT_EQ(NearestWord("check", words), "check");
}

TEST(NearestWord, IsNothingWhereNothingIsNear) {
  EXPECT_EQ(NearestWord("drill", {"verify", "check"}), "");
  EXPECT_EQ(NearestWord("", {"a"}), "a");
  EXPECT_EQ(NearestWord("x", {}), "");
  EXPECT_EQ(NearestWord(std::string(1000000, 'x'), {"x"}), "");
  EXPECT_EQ(NearestWord("abc", {"xyz"}), "");
}

std::string Complaint(const std::string& json) {
  v1::PatchModel model;
  return std::string(ReadJsonMessage(json, model).message());
}

TEST(NearestField, IsNamedInMessagesOfJson) {
  EXPECT_THAT(Complaint(R"({"patches": [{"bezier": {"degre_u": 3}}]})"), HasSubstr("Did you mean degree_u?"));
  EXPECT_THAT(Complaint(R"({"pathces": []})"), HasSubstr("Did you mean patches?"));
  EXPECT_THAT(Complaint(R"({"patches": [{"bezier": {"colour": 3}}]})"),
              HasSubstr("There are degree_u, degree_v, points"));
  EXPECT_EQ(Complaint(R"({"patches": []})"), "");
}

}  // namespace
}  // namespace patchmill
