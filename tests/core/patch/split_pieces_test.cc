#include "core/patch/split_pieces.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

std::size_t PointsOf(const std::vector<Piece>& pieces) {
  std::size_t points = 0;
  for (const Piece& piece : pieces) points += piece.net.points.size();
  return points;
}

// Of `spans` equal spans each way, clamped.
BsplinePatch Sheet(int degree, int spans) {
  BsplinePatch sheet{degree, degree, {}, {}, {}, {}};
  for (int k = -degree; k <= spans + degree; ++k) sheet.knots_u.push_back(std::clamp(k, 0, spans));
  sheet.knots_v = sheet.knots_u;
  const int points = spans + degree;
  for (int i = 0; i < points * points; ++i) sheet.points.emplace_back(i / points, i % points, 0.1 * (i % 7));
  return sheet;
}

TEST(SplinePiecePoints, AreThoseOfThePiecesThatAreMade) {
  for (const int p : {1, 2, 3, 7, 15}) {
    for (const int q : {1, 3, 15}) {
      const BsplinePatch patch = testing::RandomKnots(p, p, q, false);
      const PatchShape shape = patch;
      EXPECT_EQ(CountSplinePiecePoints({p, patch.knots_u}, {q, patch.knots_v}),
                PointsOf(SplitIntoPieces(PatchId(0), shape)));
    }
  }
  EXPECT_EQ(CountSplinePiecePoints({15, Sheet(15, 235).knots_u}, {15, Sheet(15, 235).knots_v}),
            235u * 235u * 256u);
}

TEST(SplinePiecePoints, AreNoneWhereThereIsNoBspline) {
  const std::vector<double> knots = {0, 0, 1, 1}, few = {0, 0, 1}, empty, level = {0, 0, 0, 0};
  EXPECT_EQ(CountSplinePiecePoints({1, knots}, {1, knots}), 4u);
  for (const auto& wrong : {few, empty, level}) EXPECT_EQ(CountSplinePiecePoints({1, knots}, {1, wrong}), 0u);
  for (const int degree : {-3, 0, 2, 16, 2'000'000'000}) {
    EXPECT_EQ(CountSplinePiecePoints({1, knots}, {degree, knots}), 0u) << degree;
  }
}

TEST(SplitIntoPieces, IsTheSameWithARunThatIsNotCancelled) {
  const PatchShape shape = testing::RandomKnots(5, 3, 4, true);
  const std::vector<Piece> pieces = SplitIntoPieces(PatchId(0), shape);
  const std::vector<Piece> polled = SplitIntoPieces(PatchId(0), shape, RunContext());
  ASSERT_EQ(pieces.size(), polled.size());
  for (std::size_t k = 0; k < pieces.size(); ++k) EXPECT_EQ(pieces[k].net.points, polled[k].net.points);
}

// The largest of degree 15 that a service takes: a second of work and more on one thread.
TEST(SplitIntoPieces, ObeysACancelWithinAFifthOfASecond) {
  const PatchShape shape = Sheet(15, 98);
  RunContext run;
  std::vector<Piece> pieces;
  std::thread worker([&] { pieces = SplitIntoPieces(PatchId(0), shape, run); });
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const auto cancelled = std::chrono::steady_clock::now();
  run.Cancel();
  worker.join();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - cancelled;
  EXPECT_LT(took.count(), testing::kSanitized ? 2.0 : 0.2);
  EXPECT_LT(pieces.size(), 98u * 98u);
  EXPECT_FALSE(run.Check().ok());
}

TEST(SplitIntoPieces, OfBrownPatchesPollsToo) {
  const PatchShape shape = testing::RandomBrown(1, 3, 3);
  RunContext run;
  run.Cancel();
  EXPECT_TRUE(SplitIntoPieces(PatchId(0), shape, run).empty());
}

}  // namespace
}  // namespace patchmill
