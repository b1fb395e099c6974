// Readers of strokes (.curves) and of polygon meshes (.obj): what they take, and what they refuse.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/obj.h"
#include "core/io/strokes.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(ReadStrokes, TakesStrokesOneAfterTheOther) {
  const auto strokes = ReadStrokes("v 2\n0 0 0\n1 2 3\n# a comment\r\nv 1\n4 5 6\n");
  ASSERT_TRUE(strokes.ok()) << strokes.status();
  ASSERT_EQ(strokes->size(), 2u);
  EXPECT_EQ((*strokes)[0][1], Vec3(1, 2, 3));
  EXPECT_EQ((*strokes)[1], std::vector<Vec3>{Vec3(4, 5, 6)});
}

TEST(ReadStrokes, NamesTheLineOfAFault) {
  for (const auto& [text, start] : {std::pair{"", "line 1: the text holds no stroke"},
                                    {"w 1\n", "line 1: "},
                                    {"v 0\n", "line 1: "},
                                    {"v 2\n0 0 0\n", "line 3: the text ends"},
                                    {"v 1\n0 0 nan\n", "line 2: "}}) {
    EXPECT_THAT(std::string(ReadStrokes(text).status().message()), StartsWith(start)) << text;
  }
}

TEST(ReadObj, TakesAllFormsOfCorners) {
  const auto mesh = ReadObj(
      "o cage\nv 0 0 0\nv 1 0 0 1\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1 2/5 3//1 4/1/1\nf -4 -3 -1 # last\n");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->points.size(), 4u);
  EXPECT_EQ(mesh->faces, (std::vector<std::vector<int>>{{0, 1, 2, 3}, {0, 1, 3}}));
}

TEST(ReadObj, NamesTheLineOfAFault) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 2 0\n";
  for (const auto& [text, part] : {std::pair{std::string(""), "line 1: the text holds no face"},
                                   {std::string("v 0 0\n"), "line 1: a point needs three numbers"},
                                   {points + "f 1 2\n", "line 6: a face has 2 corners"},
                                   {points + "f 1 2 3 4 5\n", "line 6: a face has 5 corners"},
                                   {points + "f 1 2 6\n", "line 6: corner 6 does not exist"},
                                   {points + "f 1 2 0\n", "line 6: corner 0 does not exist"},
                                   {points + "f 1 2 x\n", "line 6: \"x\" is no corner"}}) {
    EXPECT_THAT(std::string(ReadObj(text).status().message()), HasSubstr(part)) << text;
  }
}

}  // namespace
}  // namespace patchmill
