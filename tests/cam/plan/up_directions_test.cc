// What each axis of a part shows, against closed forms.
#include "cam/plan/up_directions.h"

#include <gtest/gtest.h>

#include "core/base/status.h"
#include "tests/support/faced_box.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

std::vector<UpDirection> Measure(PatchModel model, const Placement& placement = {}) {
  const Surface surface = SurfaceOf(Place(placement, std::move(model)));
  auto directions = MeasureUpDirections(surface, placement, RunContext());
  PM_CHECK(directions.ok());
  return *std::move(directions);
}

// A box of 10 mm and a plate of 20 x 20 above it, not joined.
PatchModel Roofed() {
  PatchModel model = FacedBox(10.0, 2);
  const std::size_t first = model.faces.size();
  PatchModel roof = FacedBox(20.0, 2);
  for (Patch& patch : roof.patches) {
    patch.id += "r";
    patch.face = FaceId(patch.face->index() + first);
    for (Vec3& p : std::get<BezierPatch>(patch.shape).points)
      p = Vec3(p.x() - 5.0, p.y() - 5.0, 15.0 + 0.1 * p.z());
    model.patches.push_back(patch);
  }
  for (ModelFace face : roof.faces) {
    face.id += "r";
    model.faces.push_back(face);
  }
  return model;
}

TEST(UpDirections, ABoxIsTheSameFromAllSides) {
  const auto directions = Measure(FacedBox(10.0, 3));
  ASSERT_EQ(directions.size(), 6u);
  for (const UpDirection& d : directions) {
    EXPECT_NEAR(d.facing_area, 100.0, 1e-9);
    EXPECT_EQ(d.hidden_area, 0.0);
    EXPECT_EQ(d.level_face_count, 1);
  }
  EXPECT_EQ(BestUp(directions), UpAxis::kZ);
}

TEST(UpDirections, ARoofHidesWhatIsBelow) {
  const auto directions = Measure(Roofed());
  const auto of = [&](UpAxis axis) {
    return *std::find_if(directions.begin(), directions.end(),
                         [&](const UpDirection& d) { return d.up == axis; });
  };
  EXPECT_NEAR(of(UpAxis::kZ).facing_area, 500.0, 1e-9);
  EXPECT_NEAR(of(UpAxis::kZ).hidden_area, 100.0, 5.0);
  EXPECT_EQ(of(UpAxis::kZ).level_face_count, 2);
  EXPECT_NEAR(of(UpAxis::kNegZ).facing_area, 500.0, 1e-9);
  EXPECT_NEAR(of(UpAxis::kNegZ).hidden_area, 100.0, 5.0);  // of the plate, by the box
  EXPECT_NEAR(of(UpAxis::kX).facing_area, 140.0, 1e-9);
  EXPECT_NEAR(of(UpAxis::kX).hidden_area, 0.0, 1.0);
  EXPECT_EQ(BestUp(directions), UpAxis::kZ);
}

// The axes are those of the model, however it is placed.
TEST(UpDirections, DoNotDependOnThePlacement) {
  const auto plain = Measure(Roofed());
  for (const UpAxis up : {UpAxis::kY, UpAxis::kX, UpAxis::kNegZ, UpAxis::kNegY, UpAxis::kNegX}) {
    const auto turned = Measure(Roofed(), {.scale = 2.0, .up = up, .translation = Vec3(3, 4, 5)});
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_EQ(turned[k].up, plain[k].up);
      EXPECT_NEAR(turned[k].facing_area, 4.0 * plain[k].facing_area, 1e-6);
      EXPECT_NEAR(turned[k].hidden_area, 4.0 * plain[k].hidden_area, 20.0);
    }
  }
}

TEST(UpDirections, NothingIsSaidOfAModelWithoutFaces) {
  EXPECT_TRUE(Measure(Sphere(Vec3::Zero(), 5.0)).empty());
}

}  // namespace
}  // namespace patchmill
