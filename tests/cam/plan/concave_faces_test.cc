#include "cam/plan/concave_faces.h"

#include <gtest/gtest.h>

#include "core/base/status.h"
#include "tests/support/faced_turning.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

std::vector<ConcaveFaces> Groups(PatchModel model) {
  auto network = BuildNetwork(std::move(model));
  PM_CHECK(network.ok());
  auto surface = BuildSurface(*std::move(network), SurfaceParams{}, RunContext());
  PM_CHECK(surface.ok());
  const auto figures = MeasureFaces(*surface, RunContext());
  PM_CHECK(figures.ok());
  auto groups = GroupConcaveFaces(*surface, *figures, RunContext());
  PM_CHECK(groups.ok());
  return *std::move(groups);
}

// A counterbore with a fillet at the foot of its wide part: two cylinders and a torus, each a group.
TEST(GroupConcaveFaces, ByKindAndRadius) {
  TurnedFace wide = Bore(8, 10, 7);
  wide.halves = true;
  const TurnedFace fillet{Round({8, 7}, {8, 6}, {7, 6}), SurfaceKind::kTorus, 1, true};
  const std::vector<ConcaveFaces> groups = Groups(TurnedPart(
      {Pin(20, 0, 10), Ring(20, 8, 10), wide, fillet, Ring(7, 3, 6), Bore(3, 6, 0), Ring(3, 20, 0)}));
  ASSERT_EQ(groups.size(), 3U);
  EXPECT_EQ(groups[0].kind, SurfaceKind::kCylinder);
  EXPECT_NEAR(groups[0].radius, 3.0, 1e-9);
  EXPECT_EQ(groups[0].faces, std::vector<FaceId>{FaceId(6)});
  EXPECT_NEAR(groups[0].area, 2 * kPi * 3 * 6, 1e-6);
  EXPECT_NEAR(groups[1].radius, 8.0, 1e-9);
  EXPECT_EQ(groups[1].faces.size(), 2U);
  EXPECT_NEAR(groups[1].area, 2 * kPi * 8 * 3, 1e-6);
  EXPECT_EQ(groups[2].kind, SurfaceKind::kTorus);
  EXPECT_NEAR(groups[2].radius, 1.0, 1e-6);
  EXPECT_EQ(groups[2].faces, std::vector<FaceId>{FaceId(4)});
}

// Two fillets of one radius, and one of another.
TEST(GroupConcaveFaces, EqualRadiiAreOneGroup) {
  const auto fillet = [](double z, double r) {
    return TurnedFace{Round({8, z + r}, {8, z}, {8 - r, z}), SurfaceKind::kTorus, r, true};
  };
  const std::vector<ConcaveFaces> groups = Groups(TurnedPart({fillet(0, 2), fillet(20, 1), fillet(40, 2)}));
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_NEAR(groups[0].radius, 1.0, 1e-6);
  EXPECT_EQ(groups[0].faces, std::vector<FaceId>{FaceId(1)});
  EXPECT_NEAR(groups[1].radius, 2.0, 1e-6);
  EXPECT_EQ(groups[1].faces.size(), 2U);
}

TEST(GroupConcaveFaces, ConvexPartsAndModelsWithoutFacesHaveNone) {
  EXPECT_TRUE(Groups(TurnedPart({Pin(5, 0, 10), Ring(5, 0, 10)})).empty());
  PatchModel plain = TurnedPart({Bore(3, 10, 0)});
  plain.faces.clear();
  for (Patch& patch : plain.patches) patch.face.reset();
  EXPECT_TRUE(Groups(plain).empty());
}

}  // namespace
}  // namespace patchmill
