#include "cam/region/map/pass_regions.h"

#include <utility>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

// Two pieces of four columns of cells along u: region 0 with 1 in its middle, and region 2.
RegionMap Map() {
  RegionMap map;
  map.regions.resize(3);
  map.cells = 4;
  std::vector<RegionId> striped;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) striped.push_back(RegionId(i == 1 || i == 2 ? 1 : 0));
  }
  map.labels = {striped, std::vector<RegionId>(16, RegionId(2))};
  return map;
}

// A point of a pass at x = 8 (piece + u), so that parameters are lengths.
CutterPoint At(std::size_t piece, double u) {
  const Vec3 p(8.0 * (static_cast<double>(piece) + u), 0, 0);
  return {p, SurfacePoint{PieceId(piece), u, 0.5, p}, std::nullopt};
}

CutterPath Pass(std::vector<CutterPoint> points) {
  CutterPath pass;
  pass.points = std::move(points);
  return pass;
}

using Lengths = std::map<RegionId, double>;

TEST(LengthInRegions, AMoveCountsForWhatItLeadsOverNotForItsEnds) {
  const Lengths lengths = LengthInRegions(Pass({At(0, 0.0), At(0, 1.0)}), Map());
  ASSERT_EQ(lengths.size(), 2u);
  EXPECT_NEAR(lengths.at(RegionId(0)), 4.0, 1e-8);
  EXPECT_NEAR(lengths.at(RegionId(1)), 4.0, 1e-8);
}

TEST(LengthInRegions, BetweenPiecesItIsHalfAndHalf) {
  const Lengths lengths = LengthInRegions(Pass({At(0, 0.9), At(1, 0.4)}), Map());
  ASSERT_EQ(lengths.size(), 2u);
  EXPECT_NEAR(lengths.at(RegionId(0)), 2.0, 1e-8);
  EXPECT_NEAR(lengths.at(RegionId(2)), 2.0, 1e-8);
}

TEST(LengthInRegions, BeyondACornerItIsTheSecondContactsPiece) {
  CutterPoint corner = At(0, 1.0);
  corner.other_contact = At(1, 0.0).contact;
  const Lengths lengths = LengthInRegions(Pass({corner, At(1, 0.5)}), Map());
  EXPECT_NEAR(lengths.at(RegionId(2)), 4.0, 1e-8);
}

TEST(LengthInRegions, APointAloneHasARegionAndTheFloorHasNone) {
  EXPECT_GT(LengthInRegions(Pass({At(0, 0.5)}), Map()).at(RegionId(1)), 0.0);
  CutterPoint floor = At(0, 0.5);
  floor.contact.reset();
  EXPECT_TRUE(LengthInRegions(Pass({floor, floor}), Map()).empty());
  EXPECT_TRUE(LengthInRegions(Pass({At(0, 0.0), At(0, 1.0)}), RegionMap()).empty());
  EXPECT_TRUE(LengthInRegions(CutterPath(), Map()).empty());
}

}  // namespace
}  // namespace patchmill
