// Contours that touch edges. Those that finish some surface stay.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "cam/path/contour/contour_paths.h"
#include "tests/support/joined_surface.h"
#include "tests/support/profiles.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

struct Found {
  std::set<int> levels;
  std::size_t planned = 0;
};

// Levels that have contours. All should, because every level is planned for some surface.
Found LevelsOf(const Surface& surface, double radius, double scallop, double tolerance) {
  const Locator locator(surface, radius);
  ContourParams params;
  params.pass.scallop = scallop;
  params.pass.chord_tolerance = 0.5 * tolerance;
  params.pass.window.min = Radians(45.0);
  params.pass.floor_z = 0.0;
  const auto contours = ContourPaths(locator, params, RunContext(1));
  EXPECT_TRUE(contours.ok());
  Found found;
  for (const CutterPath& path : contours->paths) found.levels.insert(path.order_key);
  if (!found.levels.empty()) found.planned = static_cast<std::size_t>(*found.levels.rbegin()) + 1;
  return found;
}

// Cone bands that turn by half a degree: every contour rolls over a joint between two of them.
TEST(ContourEdges, BandsOfADome) {
  std::vector<Profile> bands;
  constexpr int kBands = 180;
  const auto at = [](int k) {
    const double a = 0.5 * kPi * k / kBands;
    return Vec2(10.0 * std::cos(a), 10.0 * std::sin(a));
  };
  for (int k = 0; k < kBands; ++k) bands.push_back(Line(at(k), at(k + 1)));
  for (const auto& [radius, scallop] : {std::pair{3.0, 0.01}, {6.0, 0.002}, {6.0, 0.0005}}) {
    const Found found = LevelsOf(JoinedSurface(Turned(bands)), radius, scallop, 0.01);
    EXPECT_GT(found.planned, 8u);
    EXPECT_EQ(found.levels.size(), found.planned) << radius << " " << scallop;
  }
}

// A square pin whose faces are narrower than chords are long: all points may lie at its corners.
TEST(ContourEdges, PinNarrowerThanChords) {
  for (const auto& [width, radius, tolerance] :
       {std::tuple{0.1, 3.0, 0.01}, {0.2, 10.0, 0.1}, {0.1, 10.0, 0.5}}) {
    PatchModel model;
    const std::vector<Vec2> corners = {{0, 0}, {width, 0}, {width, width}, {0, width}};
    const auto quad = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
      BezierPatch patch;
      patch.degree_u = patch.degree_v = 1;
      patch.points = {a, b, c, d};
      model.patches.push_back({"", std::move(patch)});
    };
    const double high = 4.0 * radius;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec2 &a = corners[k], &b = corners[(k + 1) % 4];
      quad(Lift(a, 0), Lift(a, high), Lift(b, 0), Lift(b, high));
    }
    quad(Lift(corners[0], high), Lift(corners[3], high), Lift(corners[1], high), Lift(corners[2], high));
    const Found found = LevelsOf(JoinedSurface(std::move(model)), radius, 0.01, tolerance);
    EXPECT_GT(found.planned, 5u);
    EXPECT_EQ(found.levels.size(), found.planned) << width << " " << radius;
  }
}

}  // namespace
}  // namespace patchmill
