// Drawings keep the limit of triangles, whatever else a caller wants.
#include "cam/plan/drawing.h"

#include <gtest/gtest.h>

#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

std::size_t TrianglesOf(const SurfaceDrawing& drawing) {
  std::size_t count = 0;
  for (const PieceTriangles& piece : drawing.mesh) count += piece.triangles.size();
  return count;
}

// A fine chord divides a trough across, a program along: both together would be too many triangles. The chord
// is kept, because the caller stated it.
TEST(DrawSurface, AChordThatIsAllowedAloneIsAllowedWithAProgram) {
  const Surface surface = PlacedSurface(Cylinder(Vec3::Zero(), 40.0, 400.0, Half::kUpper));
  ProgramMotion motion;
  ProgramMove cut;
  cut.kind = ProgramMove::Kind::kFeed;
  cut.from = Vec3(-50, 0, 40);
  cut.to = Vec3(50, 0, 40);
  cut.feed = 1000.0;
  motion.moves = {cut};
  DrawingParams params;
  params.chord = 2e-7;
  params.ways = {{BallMotion{&motion, Vec3::Zero(), 3.0, 0.0}}};
  ASSERT_TRUE(CheckChord(surface, *params.chord, RunContext(2)).ok());
  const auto drawing = DrawSurface(surface, params, RunContext(2));
  ASSERT_TRUE(drawing.ok()) << drawing.status();
  EXPECT_EQ(drawing->chord, *params.chord);
  EXPECT_LE(TrianglesOf(*drawing), 1'000'000u);
  ASSERT_TRUE(drawing->motion);
}

TEST(DrawSurface, AStatedChordThatNeedsTooManyTrianglesIsRefusedAndTheDefaultIsNot) {
  const Surface surface = PlacedSurface(Sphere(Vec3::Zero(), 40.0));
  DrawingParams params;
  params.chord = 1e-9;
  const auto refused = DrawSurface(surface, params, RunContext(2));
  EXPECT_EQ(refused.status().code(), absl::StatusCode::kResourceExhausted) << refused.status();
  params.chord.reset();
  const auto drawing = DrawSurface(surface, params, RunContext(2));
  ASSERT_TRUE(drawing.ok()) << drawing.status();
  EXPECT_FALSE(drawing->motion);
}

}  // namespace
}  // namespace patchmill
