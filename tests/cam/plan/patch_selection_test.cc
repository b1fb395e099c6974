// Patches by what a person calls them.
#include "cam/plan/patch_selection.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/status.h"
#include "tests/support/faced_box.h"

namespace patchmill {
namespace {

using testing::FacedBox;
using ::testing::HasSubstr;

PatchNetwork Joined(PatchModel model) {
  auto network = BuildNetwork(std::move(model));
  PM_CHECK(network.ok());
  return *std::move(network);
}

PatchNetwork Box() {
  PatchModel model = FacedBox(10.0, 2);
  model.faces[3].kind = model.faces[4].kind = SurfaceKind::kCylinder;
  model.faces[3].radius = 2.0;
  model.faces[4].radius = 4.0;
  model.patches[0].id = "f6";  // a client's own id wins over the face's
  return Joined(std::move(model));
}

// The faces of which all patches are selected, as digits, and "!" if a part of another face is.
std::string Faces(const PatchNetwork& network, const std::vector<std::string>& names) {
  const auto selected = SelectPatches(network, names, "selection.patch_ids", RunContext());
  if (!selected.ok()) return std::string(selected.status().message());
  std::string text;
  for (std::size_t f = 0; f < network.model.faces.size(); ++f) {
    int all = 0, on = 0;
    for (std::size_t k = 0; k < selected->size(); ++k) {
      if (network.model.patches[k].face != FaceId(f)) continue;
      ++all;
      on += (*selected)[k] ? 1 : 0;
    }
    if (on == all) text += std::to_string(f + 1);
    if (on > 0 && on < all) text += "!";
  }
  return text;
}

TEST(PatchSelection, ByEveryName) {
  const PatchNetwork box = Box();
  EXPECT_EQ(Faces(box, {"f2"}), "2");
  EXPECT_EQ(Faces(box, {"f2", "f3"}), "23");
  EXPECT_EQ(Faces(box, {"name=wall"}), "3456");
  EXPECT_EQ(Faces(box, {"name=lid"}), "2");
  EXPECT_EQ(Faces(box, {"body=BOX"}), "123456");
  EXPECT_EQ(Faces(box, {"color=#ff0000"}), "3456");
  EXPECT_EQ(Faces(box, {"color=#FF0000"}), "3456");
  EXPECT_EQ(Faces(box, {"kind=cylinder"}), "45");
  EXPECT_EQ(Faces(box, {"kind=plane"}), "1236");
  EXPECT_EQ(Faces(box, {"radius<=2"}), "4");
  EXPECT_EQ(Faces(box, {"radius>=2"}), "45");
  EXPECT_EQ(Faces(box, {"kind=cylinder&radius>=3"}), "5");
  EXPECT_EQ(Faces(box, {"name=wall&kind=plane", "f2"}), "236");
  EXPECT_EQ(Faces(box, {"#4"}), "!");
  EXPECT_EQ(Faces(box, {"f6"}), "!");
  EXPECT_EQ(Faces(box, {"face:f6"}), "6");
}

TEST(PatchSelection, NothingNamedIsNothingSelected) {
  const auto selected = SelectPatches(Box(), {}, "selection.patch_ids", RunContext());
  ASSERT_TRUE(selected.ok());
  EXPECT_TRUE(selected->empty());
}

TEST(PatchSelection, SmoothNeighbours) {
  EXPECT_EQ(Faces(Box(), {"f2+"}), "2");
  // A strip of four level faces and a wall at its end.
  PatchModel model;
  for (int k = 0; k < 5; ++k) {
    model.faces.emplace_back().id = "s" + std::to_string(k + 1);
    const double x = 10.0 * k;
    PatchShape shape = k < 4 ? testing::Bilinear({x, 0, 0}, {x + 10, 0, 0}, {x, 5, 0}, {x + 10, 5, 0})
                             : testing::Bilinear({x, 0, 0}, {x, 0, 9}, {x, 5, 0}, {x, 5, 9});
    model.patches.push_back({"", std::move(shape), FaceId(static_cast<std::size_t>(k))});
  }
  const PatchNetwork strip = Joined(std::move(model));
  EXPECT_EQ(Faces(strip, {"s1+"}), "1234");
  EXPECT_EQ(Faces(strip, {"face:s3+"}), "1234");
  EXPECT_EQ(Faces(strip, {"s5+"}), "5");
}

// A level face of one patch beside one of two: their edge is a T-junction.
TEST(PatchSelection, SmoothNeighboursAcrossTJunctions) {
  PatchModel model;
  for (const char* id : {"a", "b", "wall"}) model.faces.emplace_back().id = id;
  const auto add = [&](const Vec3& o, const Vec3& u, const Vec3& v, std::size_t face) {
    model.patches.push_back({"", testing::Bilinear(o, o + u, o + v, o + u + v), FaceId(face)});
  };
  add({0, 0, 0}, {10, 0, 0}, {0, 10, 0}, 0);
  add({10, 0, 0}, {10, 0, 0}, {0, 5, 0}, 1);
  add({10, 5, 0}, {10, 0, 0}, {0, 5, 0}, 1);
  add({0, 10, 0}, {5, 0, 0}, {0, 0, 5}, 2);
  add({5, 10, 0}, {5, 0, 0}, {0, 0, 5}, 2);
  const PatchNetwork surface = Joined(std::move(model));
  EXPECT_EQ(Faces(surface, {"a+"}), "12");
  EXPECT_EQ(Faces(surface, {"b+"}), "12");
  EXPECT_EQ(Faces(surface, {"wall+"}), "3");
}

TEST(PatchSelection, MessagesHoldNoControlCharacters) {
  PatchModel model = FacedBox(10.0, 1);
  model.faces[0].name = "a\x1b[31m\nb";
  model.faces[1].name = std::string(49, 'x') + "\xc3\xa9";  // cut before the e with an accent
  const std::string message = Faces(Joined(std::move(model)), {"name=\x1b"});
  EXPECT_THAT(message, HasSubstr("a?[31m?b"));
  for (const char c : message) EXPECT_GE(static_cast<unsigned char>(c), 0x20);
  EXPECT_THAT(message, HasSubstr(std::string(49, 'x')));
  EXPECT_THAT(message, ::testing::Not(HasSubstr("\xc3")));
}

TEST(PatchSelection, ACancelEndsIt) {
  const PatchNetwork box = Box();
  RunContext run;
  run.Cancel();
  EXPECT_EQ(SelectPatches(box, {"f2"}, "selection.patch_ids", run).status().code(),
            absl::StatusCode::kCancelled);
}

TEST(PatchSelection, WhatIsWrongIsSaid) {
  const PatchNetwork box = Box();
  EXPECT_THAT(Faces(box, {"f2", "f9"}), HasSubstr("selection.patch_ids[1] = \"f9\"; must be a patch id"));
  EXPECT_THAT(Faces(box, {"f9"}), HasSubstr("a face id (f1 to f6"));
  EXPECT_THAT(Faces(box, {"#24"}), HasSubstr("#0 to #23"));
  EXPECT_THAT(Faces(box, {"kind=ball"}), HasSubstr("kind is one of cylinder, plane"));
  EXPECT_THAT(Faces(box, {"color=red"}), HasSubstr("color is one of #ff0000"));
  EXPECT_THAT(Faces(box, {"layer=3"}), HasSubstr("none has a layer"));
  EXPECT_THAT(Faces(box, {"radius=3"}), HasSubstr("radius<=3 or radius>=3"));
  EXPECT_THAT(Faces(box, {"radius<=x"}), HasSubstr("radius<=3 or radius>=3"));
  EXPECT_THAT(Faces(box, {"radius<=nan"}), HasSubstr("radius<=3 or radius>=3"));
  EXPECT_THAT(Faces(box, {"radius"}), HasSubstr("radius<=3 or radius>=3"));
  EXPECT_THAT(Faces(box, {"radius<=1"}), HasSubstr("no such face meets all its conditions"));
  EXPECT_THAT(Faces(box, {"kind=plane&radius>=1"}), HasSubstr("no such face meets all its conditions"));
  EXPECT_THAT(Faces(box, {""}), HasSubstr("must be a patch id"));
  EXPECT_THAT(Faces(box, {"&"}), HasSubstr("must be a patch id"));
  PatchModel bare = FacedBox(10.0, 1);
  bare.faces.clear();
  for (Patch& patch : bare.patches) patch.face.reset();
  EXPECT_THAT(Faces(Joined(std::move(bare)), {"kind=plane"}),
              HasSubstr("must be a patch id of the model or #0 to #5"));
}

}  // namespace
}  // namespace patchmill
