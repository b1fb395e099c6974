#include "core/surface/part.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Bilinear;

PatchShape Square(double x, double y, double size) {
  return Bilinear({x, y, 0}, {x + size, y, 0}, {x, y + size, 0}, {x + size, y + size, 0});
}

Surface Build(const PatchModel& model) {
  auto network = BuildNetwork(model);
  EXPECT_TRUE(network.ok()) << network.status();
  auto surface = BuildSurface(*std::move(network), {}, RunContext(1));
  EXPECT_TRUE(surface.ok()) << surface.status();
  return *std::move(surface);
}

Surface Part(const Surface& whole, const std::vector<bool>& patches) {
  auto part = PartOf(whole, patches, RunContext(1));
  EXPECT_TRUE(part.ok()) << part.status();
  return *std::move(part);
}

TEST(PartOf, HasThePatchesAskedForInTheirOrder) {
  PatchModel model = testing::RandomBspline(1, {.spans = 3});
  model.patches[0].id = "spline";
  model.patches.push_back({"bowl", testing::RandomBezier(2, 3, 3, true)});
  model.patches.push_back({"left out", testing::RandomBezier(3, 2, 2, false)});
  model.patches.push_back({"flat", Square(30, 30, 4)});
  const Surface part = Part(Build(model), {true, true, false, true});
  ASSERT_EQ(part.network.model.patches.size(), 3u);
  const std::size_t from[] = {0, 1, 3};
  for (std::size_t i = 0; i < 3; ++i) {
    const Patch& given = model.patches[from[i]];
    EXPECT_EQ(part.network.model.patches[i].id, given.id);
    for (const double u : {0.0, 0.3, 1.0}) {
      for (const double v : {0.1, 0.9}) {
        EXPECT_LE((Evaluate(part, PatchId(i), u, v).p - Evaluate(given.shape, u, v).p).norm(), 1e-13);
      }
    }
  }
}

// The default follows the size of a model: what is joined in a large one would be apart in a part of it.
TEST(PartOf, IsJoinedWhereTheWholeIs) {
  const PatchModel model =
      testing::Join({testing::Single(Square(0, 0, 1000)), testing::Single(Square(2000, 0, 10)),
                     testing::Single(Square(2010.005, 0, 10))});
  const Surface whole = Build(model);
  ASSERT_TRUE(whole.network.Link({PatchId(1), 1}).neighbor.has_value());
  const Surface part = Part(whole, {false, true, true});
  EXPECT_TRUE(part.network.Link({PatchId(0), 1}).neighbor.has_value());
}

// A tolerance that is fine for the whole may be more than a small patch can have.
TEST(PartOf, OfATinyPatchOfALooselyJoinedModel) {
  PatchModel model =
      testing::Join({testing::Single(Square(0, 0, 1000)), testing::Single(Square(1100, 0, 1))});
  model.join_tolerance = 0.05;
  const Surface part = Part(Build(model), {false, true});
  EXPECT_EQ(part.pieces.size(), 1u);
  EXPECT_NEAR(part.network.join_tolerance, kMaxJoinTolerance * std::sqrt(2.0), 1e-12);
}

}  // namespace
}  // namespace patchmill
