// The funnel by itself, with stations made by hand over a known surface.
#include "cam/path/chord/fewest_chords.h"

#include <chrono>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace patchmill::testing;

constexpr double kR = 3.0;

// Stations along x over the plane z = 0, each with the contact below it.
struct Row {
  explicit Row(std::size_t count, double step) : surface(SurfaceOf(Plane(1000))), locator(surface, kR) {
    for (std::size_t k = 0; k < count; ++k) {
      const double x = step * static_cast<double>(k) - 900.0;
      contacts.push_back({PieceId(0), (x + 1000.0) / 2000.0, 0.5, Vec3(x, 0, 0)});
    }
    for (const SurfacePoint& contact : contacts) {
      stations.push_back({.center = contact.p + kR * Vec3::UnitZ(), .left = &contact, .right = &contact});
      stations.back().proven = true;
    }
  }
  std::vector<ChordVertex> Fewest(const ChordLimits& limits) const {
    return FewestChords(locator, stations, limits, [this](std::size_t k) { return stations[k].center; });
  }
  Surface surface;
  Locator locator;
  std::vector<SurfacePoint> contacts;
  std::vector<ChordStation> stations;
};

const ChordLimits kFine{.gouge = 1e-3, .excess = 1e-4, .deepest = 5e-4};

TEST(FewestChords, StraightNeedsItsEnds) {
  const Row row(500, 0.05);
  const auto vertices = row.Fewest(kFine);
  ASSERT_EQ(vertices.size(), 2u);
  EXPECT_EQ(vertices[0].station, 0u);
  EXPECT_EQ(vertices[1].station, 499u);
  EXPECT_EQ(vertices[0].below, 0.0);
  EXPECT_EQ(vertices[1].below, 0.0);
}

TEST(FewestChords, KeptStationsAndLongestChordsAreObeyed) {
  Row row(500, 0.05);
  row.stations[123].keep = row.stations[124].keep = true;
  ChordLimits limits = kFine;
  limits.longest = 2.0;
  std::vector<bool> found(500, false);
  const auto vertices = row.Fewest(limits);
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    found[vertices[k].station] = true;
    if (k > 0) {
      EXPECT_LE(0.05 * static_cast<double>(vertices[k].station - vertices[k - 1].station), 2.0 + 1e-9);
    }
  }
  EXPECT_TRUE(found[123] && found[124]);
  EXPECT_LT(vertices.size(), 20u);
}

// Corners of contours: up to rounding, the next station lies exactly in the direction in which the ball
// leaves the surface. Such a chord has no slope, and ends at the next station.
TEST(FewestChords, StationsStraightOutOfTheSurface) {
  Row row(200, 0.05);
  for (std::size_t k = 50; k < 60; ++k) row.stations[k].away = Vec3(std::cos(1e-9), std::sin(1e-9), 0);
  ChordLimits limits = kFine;
  limits.longest = 1.0;
  const auto vertices = row.Fewest(limits);
  EXPECT_EQ(vertices.back().station, 199u);
  for (std::size_t k = 1; k < vertices.size(); ++k) EXPECT_GT(vertices[k].station, vertices[k - 1].station);
}

// Centres that were raised above what their stations state. Chords from and to them go from station to
// station.
TEST(FewestChords, NothingIsAssumedOfRaisedCenters) {
  const Row row(100, 0.05);
  const auto raised = [&](std::size_t k) {
    return Vec3(row.stations[k].center + (k == 99 ? 0.5 : 0.0) * Vec3::UnitZ());
  };
  const auto vertices = FewestChords(row.locator, row.stations, kFine, raised);
  ASSERT_GE(vertices.size(), 3u);
  EXPECT_EQ(vertices[vertices.size() - 2].station, 98u);
}

// A surface that needs a vertex at every station: time grows in proportion to the number of stations.
TEST(FewestChords, LongRunsTakeTimeInProportion) {
  const auto seconds = [](std::size_t count) {
    Row row(count, 0.01);
    for (std::size_t k = 0; k < count; ++k) row.stations[k].center.z() += k % 2 == 0 ? 0.0 : 2e-3;
    const auto start = std::chrono::steady_clock::now();
    EXPECT_GT(row.Fewest({.gouge = 1e-3, .excess = 1e-4}).size(), count / 3);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  seconds(5000);
  const double few = seconds(10000), many = seconds(100000);
  EXPECT_LT(many, 30.0 * few + 0.1) << few;
}

}  // namespace
}  // namespace patchmill
