// Figures of faces against closed forms.
#include "core/surface/face_figures.h"

#include <gtest/gtest.h>

#include "tests/support/faced_box.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

std::vector<FaceFigures> Measure(PatchModel model, int threads = 1) {
  const Surface surface = SurfaceOf(std::move(model));
  auto figures = MeasureFaces(surface, RunContext(threads));
  PM_CHECK(figures.ok());
  return *std::move(figures);
}

PatchModel AsOneFace(PatchModel model) {
  model.faces.emplace_back().id = "f1";
  for (Patch& patch : model.patches) patch.face = FaceId(std::size_t{0});
  return model;
}

TEST(FaceFigures, OfABox) {
  const auto figures = Measure(FacedBox(10.0, 3));
  ASSERT_EQ(figures.size(), 6u);
  const double tilts[] = {kPi, 0.0, 0.5 * kPi, 0.5 * kPi, 0.5 * kPi, 0.5 * kPi};
  for (std::size_t f = 0; f < 6; ++f) {
    EXPECT_EQ(figures[f].patch_count, 9);
    EXPECT_NEAR(figures[f].area, 100.0, 1e-9);
    EXPECT_NEAR(figures[f].tilt_min, tilts[f], 1e-12);
    EXPECT_NEAR(figures[f].tilt_max, tilts[f], 1e-12);
  }
  EXPECT_EQ(figures[1].box.min, Vec3(0, 0, 10));
  EXPECT_EQ(figures[1].box.max, Vec3(10, 10, 10));
}

TEST(FaceFigures, OfRoundSurfaces) {
  const auto sphere = Measure(AsOneFace(Sphere(Vec3(1, 2, 3), 5.0, Half::kUpper)));
  EXPECT_NEAR(sphere[0].area, 2 * kPi * 25, 1e-7);
  EXPECT_NEAR(sphere[0].tilt_min, 0.0, 0.1);  // the pole itself has no normal
  EXPECT_NEAR(sphere[0].tilt_max, 0.5 * kPi, 1e-9);
  EXPECT_NEAR(sphere[0].box.max.z(), 8.0, 1e-12);
  const auto torus = Measure(AsOneFace(Torus(Vec3::Zero(), 20.0, 6.0)));
  EXPECT_NEAR(torus[0].area, 4 * kPi * kPi * 120, 1e-6);
  EXPECT_NEAR(torus[0].tilt_max, kPi, 1e-9);
}

TEST(FaceFigures, DoNotDependOnThreadsAndTakeFacesWithoutPatches) {
  PatchModel model = FacedBox(10.0, 2);
  model.faces.emplace_back().id = "lost";
  const auto one = Measure(model), two = Measure(model, 2);
  for (std::size_t f = 0; f < 7; ++f) EXPECT_EQ(one[f].area, two[f].area);
  EXPECT_EQ(one[6].patch_count, 0);
  EXPECT_TRUE(one[6].box.Empty());
}

TEST(FaceFigures, ACancelEndsIt) {
  const Surface surface = SurfaceOf(FacedBox(10.0, 2));
  RunContext run;
  run.Cancel();
  EXPECT_FALSE(MeasureFaces(surface, run).ok());
}

}  // namespace
}  // namespace patchmill
