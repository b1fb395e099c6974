// Which side of upright walls is air.
#include "core/surface/air_sides.h"

#include <gtest/gtest.h>

#include "core/diffgeo/forms.h"
#include "tests/support/joined_surface.h"
#include "tests/support/walls.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

// Where the tool stands at the middle of a patch: its direction from there, or nothing where it has two
// sides.
std::optional<Vec3> AirOf(const Surface& surface, std::size_t patch) {
  const Piece& piece = surface.piece(surface.first_piece[patch]);
  const auto facing = FacingAt(Evaluate(piece, 0.5, 0.5));
  if (!facing || facing->both) return std::nullopt;
  return facing->e;
}

// The walls of [-30,30] x [-20,20] all look in (sign -1) or out (+1).
void ExpectWallsLook(const Surface& surface, std::size_t first, double sign) {
  const Vec3 out[] = {{0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  for (std::size_t k = 0; k < 4; ++k) {
    const auto air = AirOf(surface, first + k);
    ASSERT_TRUE(air) << k;
    EXPECT_LT((*air - sign * out[k]).norm(), 1e-9) << k << ": " << air->transpose();
  }
}

TEST(AirSides, WallsAroundAFloorLookIn) {
  ExpectWallsLook(JoinedSurface(Join({Level(-30, -20, 30, 20, 0), Walls(30, 20, 0, 25)})), 1, -1.0);
}

TEST(AirSides, WallsUnderATopLookOut) {
  ExpectWallsLook(JoinedSurface(Join({Level(-30, -20, 30, 20, 25), Walls(30, 20, 0, 25)})), 1, 1.0);
}

TEST(AirSides, WallsOfAClosedBlockLookOut) {
  ExpectWallsLook(
      JoinedSurface(Join({Level(-30, -20, 30, 20, 25), Level(-30, -20, 30, 20, 0), Walls(30, 20, 0, 25)})), 2,
      1.0);
}

bool IsUnderside(const Surface& surface, std::size_t patch) {
  const SurfaceJet jet = Evaluate(surface.piece(surface.first_piece[patch]), 0.5, 0.5);
  return jet.sides.IsUnderside(jet.du.cross(jet.dv).normalized().z());
}

// Of a closed block the bottom, and no more. Nothing of a block without a wall, whichever way its patches
// run.
TEST(AirSides, ABottomIsTheUndersideOfAClosedBlock) {
  PatchModel block = ClosedBlock(30, 20, 25);
  const Surface closed = JoinedSurface(block);
  int undersides = 0;
  for (std::size_t k = 0; k < block.patches.size(); ++k) {
    const Piece& piece = closed.piece(closed.first_piece[k]);
    const bool bottom = Position(piece, 0.3, 0.3).z() == 0.0 && Position(piece, 0.7, 0.7).z() == 0.0;
    EXPECT_EQ(IsUnderside(closed, k), bottom) << k;
    undersides += bottom;
  }
  EXPECT_GT(undersides, 0);
  std::erase_if(block.patches,
                [](const Patch& patch) { return std::abs(Position(patch.shape, 0.3, 0.3).x()) == 30.0; });
  const Surface open = JoinedSurface(block);
  for (std::size_t k = 0; k < block.patches.size(); ++k) EXPECT_FALSE(IsUnderside(open, k)) << k;
}

// A closed body without upright walls: the lower half of a ball, up to where it is a wall.
TEST(AirSides, TheLowerHalfOfABallIsItsUnderside) {
  const Surface ball = JoinedSurface(Sphere(Vec3::Zero(), 10, Half::kAll));
  for (const Piece& piece : ball.pieces) {
    for (const double u : {0.2, 0.5, 0.8}) {
      for (const double v : {0.2, 0.5, 0.8}) {
        const SurfaceJet jet = Evaluate(piece, u, v);
        EXPECT_EQ(jet.sides.IsUnderside(jet.du.cross(jet.dv).normalized().z()),
                  jet.p.z() < -10.0 * kMostWallSlope);
      }
    }
  }
}

// The walls of a box that leans in look up from behind, those of a block that widens upwards from inside.
TEST(AirSides, WallsThatOverhangHaveTheSideOfWhatTheyAreJoinedTo) {
  for (const double lean : {1e-5, 1e-3, 0.02, 0.3, 1.0}) {
    for (const bool block : {false, true}) {
      SCOPED_TRACE(std::to_string(lean) + (block ? " block" : " box"));
      PatchModel model = block ? ClosedBlock(30, 20, 25) : OpenBox(30, 20, 25);
      const double out = block ? lean : -lean;
      for (Patch& patch : model.patches) {
        for (Vec3& p : std::get<BezierPatch>(patch.shape).points) {
          if (p.z() < 12.0) continue;
          p.x() += out * std::copysign(1.0, p.x());
          p.y() += out * std::copysign(1.0, p.y());
        }
      }
      const Surface surface = JoinedSurface(model);
      EXPECT_TRUE(surface.two_sided_walls.empty());
      for (std::size_t wall = block ? 2 : 1; wall < surface.first_piece.size(); ++wall) {
        const Vec3 p = Evaluate(surface.piece(surface.first_piece[wall]), 0.5, 0.5).p;
        const auto air = AirOf(surface, wall);
        ASSERT_TRUE(air);
        EXPECT_EQ(air->dot(p - Vec3(0, 0, p.z())) > 0.0, block) << wall;
        EXPECT_LT(air->z(), 0.0) << wall;
      }
    }
  }
}

TEST(AirSides, AWallThatWavesHasOneSide) {
  for (const double shift : {1e-5, 1e-3, 0.05}) {
    const Surface surface = JoinedSurface(WavingBox(30, 20, 25, shift));
    for (std::size_t wall = 1; wall < 5; ++wall) {
      const Piece& piece = surface.piece(surface.first_piece[wall]);
      for (int k = 0; k <= 50; ++k) {
        const SurfaceJet jet = Evaluate(piece, 0.5, k / 50.0);
        const auto facing = FacingAt(jet);
        ASSERT_TRUE(facing && !facing->both);
        EXPECT_LT(facing->e.dot(jet.p - Vec3(0, 0, jet.p.z())), 0.0) << shift << " " << wall << " " << k;
      }
    }
  }
}

// A bottle open at its neck: its shoulders decide. Its inner floor can be seen through the neck, from behind.
TEST(AirSides, TheInsideOfABottleIsItsBack) {
  const Surface surface = JoinedSurface(Join(
      {Level(-8, -5, 8, 5, 0), Level(-30, -20, -8, 20, 0), Level(8, -20, 30, 20, 0), Level(-8, -20, 8, -5, 0),
       Level(-8, 5, 8, 20, 0), Walls(30, 20, 0, 25), Level(-30, -20, -4, 20, 25), Level(4, -20, 30, 20, 25),
       Level(-4, -20, 4, -4, 25), Level(-4, 4, 4, 20, 25)}));
  const auto air = AirOf(surface, 0);
  ASSERT_TRUE(air);
  EXPECT_LT(air->z(), 0.0);
}

// Two steps: each wall between a lower and a higher level looks to the lower one.
TEST(AirSides, AWallBetweenTwoLevelsLooksToTheLowerOne) {
  const Surface surface =
      JoinedSurface(Join({Level(-20, -10, 0, 10, 0), Wall({0, -10}, {0, 10}, 0, 8), Level(0, -10, 20, 10, 8),
                          Wall({20, 10}, {20, -10}, 8, 15), Level(20, -10, 40, 10, 15)}));
  for (const std::size_t wall : {1, 3}) {
    const auto air = AirOf(surface, wall);
    ASSERT_TRUE(air);
    EXPECT_LT((*air - Vec3(-1, 0, 0)).norm(), 1e-9);
  }
  EXPECT_TRUE(surface.two_sided_walls.empty());
}

// T-junctions join as edges do.
TEST(AirSides, AWallOnTwoFloorsHasTheirSide) {
  const Surface surface =
      JoinedSurface(Join({Level(-20, 0, 5, 10, 0), Level(5, 0, 20, 10, 0), Wall({-20, 10}, {20, 10}, 0, 8)}));
  const auto air = AirOf(surface, 2);
  ASSERT_TRUE(air);
  EXPECT_LT((*air - Vec3(0, -1, 0)).norm(), 1e-9);
}

// The edges overlap in part: neither lies all along the other.
TEST(AirSides, AWallAlongPartOfAFloorHasItsSide) {
  for (const bool turned : {false, true}) {
    const Surface surface =
        JoinedSurface(Join({Level(-20, 0, 20, 10, 0), Wall({-25, 10}, {15, 10}, 0, 8, turned)}));
    const auto air = AirOf(surface, 1);
    ASSERT_TRUE(air);
    EXPECT_LT((*air - Vec3(0, -1, 0)).norm(), 1e-9);
    EXPECT_TRUE(surface.two_sided_walls.empty());
  }
}

// A gap of some join tolerances decides, a wider one does not.
TEST(AirSides, AWallBesideASmallGapHasTheSideOfTheFloor) {
  const double tolerance = JoinedSurface(Level(-20, 0, 20, 10, 0)).network.join_tolerance;
  for (const double gap : {3.0, 30.0}) {
    const double y = 10.0 + gap * tolerance;
    const Surface surface = JoinedSurface(Join({Level(-20, 0, 20, 10, 0), Wall({-20, y}, {20, y}, 0, 8)}));
    EXPECT_EQ(AirOf(surface, 1).has_value(), gap < 10.0) << gap;
  }
}

TEST(AirSides, AWallAloneHasTwo) {
  const Surface surface = JoinedSurface(Wall({0, 0}, {20, 0}, 0, 10));
  EXPECT_FALSE(AirOf(surface, 0));
  EXPECT_EQ(surface.two_sided_walls, std::vector<PatchId>{PatchId(0)});
}

// Three patches share the fin's lower edge; the fin is joined to neither floor.
TEST(AirSides, AFinBetweenTwoFloorsHasTwo) {
  const Surface surface = JoinedSurface(
      Join({Level(-20, -10, 0, 10, 0), Level(0, -10, 20, 10, 0), Wall({0, -10}, {0, 10}, 0, 8)}));
  EXPECT_FALSE(AirOf(surface, 2));
  EXPECT_EQ(surface.two_sided_walls, std::vector<PatchId>{PatchId(2)});
}

// The upper plate is open to the sky from above, the longer lower one from its other side.
TEST(AirSides, AWallBetweenPlatesOfBothSidesHasTwo) {
  const Surface surface =
      JoinedSurface(Join({Level(0, 0, 10, 10, 8), Wall({10, 0}, {10, 10}, 0, 8), Level(-10, 0, 10, 10, 0)}));
  EXPECT_FALSE(AirOf(surface, 1));
}

TEST(AirSides, ABossOnAPlateLooksOut) {
  const Surface surface = JoinedSurface(Block(8.0, 16.0, 25.0));
  int walls = 0;
  for (std::size_t patch = 0; patch < surface.first_piece.size(); ++patch) {
    const SurfaceJet jet = Evaluate(surface.piece(surface.first_piece[patch]), 0.5, 0.5);
    const auto facing = FacingAt(jet);
    ASSERT_TRUE(facing);
    if (facing->e.z() > kUprightFace) continue;
    ++walls;
    EXPECT_FALSE(facing->both);
    EXPECT_GT(facing->e.dot(jet.p - Vec3(0, 0, jet.p.z())), 0.0);
  }
  EXPECT_EQ(walls, 4);
}

// Nothing is upright but lines: nothing is decided, and nothing has to be.
TEST(AirSides, SilhouettesAreNoWalls) {
  for (const PatchModel& model :
       {Sphere({0, 0, 0}, 10), Torus({0, 0, 0}, 20, 5), Cylinder({0, 0, 0}, 5, 20)}) {
    const Surface surface = JoinedSurface(model);
    EXPECT_TRUE(surface.two_sided_walls.empty());
    for (const Piece& piece : surface.pieces) EXPECT_EQ(piece.sides.air_side, 0);
  }
}

}  // namespace
}  // namespace patchmill
