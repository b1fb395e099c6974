// h of free-form patches of every kind against brute force: agreement to 1e-6, never below a sampled point.
#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "core/io/bpt.h"
#include "tests/support/height_oracle.h"
#include "tests/support/random.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using testing::HeightOracle;
using testing::Random;
using testing::SurfaceOf;

struct Counts {
  int compared = 0;
  int oracle_missed = 0;  // certified h is higher: the oracle's starts missed the hill
};

// Queries over the model's plan and a little beyond it.
void Compare(const PatchModel& model, double radius, int samples, int queries, std::uint64_t seed,
             Counts& counts) {
  const Surface surface = SurfaceOf(model);
  const Locator locator(surface, radius);
  const HeightOracle oracle(model, radius, samples);
  Random random(seed);
  const int count = testing::kSanitized ? (queries + 9) / 10 : queries;
  for (int i = 0; i < count; ++i) {
    const double margin = 0.8 * radius;
    const Vec2 q(random.Uniform(surface.box.min.x() - margin, surface.box.max.x() + margin),
                 random.Uniform(surface.box.min.y() - margin, surface.box.max.y() + margin));
    const auto h = locator.Height(q);
    const auto certified = locator.CertifiedHeight(q, 1e-6);
    const HeightOracle::Answer truth = oracle.Height(q);
    ASSERT_EQ(h.has_value(), certified.has_value());
    if (!h) {
      EXPECT_EQ(truth.sampled, -kInfinity);
      continue;
    }
    EXPECT_LE(certified->gap, 1e-6 + 1e-9) << "seed " << seed << " q " << q.transpose();
    EXPECT_NEAR(h->z, certified->z, 1e-9) << "seed " << seed << " q " << q.transpose();
    ASSERT_GE(h->z, truth.sampled - 1e-9) << "seed " << seed << " q " << q.transpose();
    ASSERT_GE(h->z, truth.polished - 1e-6) << "seed " << seed << " q " << q.transpose();
    ++counts.compared;
    if (h->z > truth.polished + 1e-6) ++counts.oracle_missed;
    // The contact is on the surface and touches the ball.
    const SurfacePoint& c = h->contact;
    EXPECT_LE((Position(surface.piece(c.piece), c.u, c.v) - c.p).norm(), 1e-9);
    EXPECT_NEAR(c.p.z() + std::sqrt(std::max(0.0, radius * radius - (Xy(c.p) - q).squaredNorm())), h->z,
                1e-9);
  }
}

// The oracle may miss a hill now and then (we are then higher, and certified), but not often.
void ExpectOracleMostlyAgrees(const Counts& c) {
  EXPECT_GT(c.compared, 0);
  EXPECT_LE(c.oracle_missed, c.compared / 50 + (testing::kSanitized ? 1 : 0)) << "of " << c.compared;
}

TEST(Oracle, RandomSplines) {
  Counts counts;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Compare(testing::RandomBspline(seed), 3.0, 100, 60, seed, counts);
  }
  ExpectOracleMostlyAgrees(counts);
}

TEST(Oracle, RandomFoldedAndRationalSplines) {
  Counts counts;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    testing::RandomBsplineParams params;
    params.folds = true;
    params.rational = seed % 2 == 1;
    Compare(testing::RandomBspline(seed, params), 2.5, 160, 100, seed, counts);
  }
  ExpectOracleMostlyAgrees(counts);
}

TEST(Oracle, GregoryQuadsOfBothBlends) {
  Counts counts;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    for (const auto blend : {GregoryPatch::Blend::kCorner, GregoryPatch::Blend::kEdge}) {
      Compare(testing::Single(testing::RandomGregory(seed, blend)), 2.0, 100, 100, seed, counts);
    }
  }
  ExpectOracleMostlyAgrees(counts);
}

TEST(Oracle, TrianglesOfManyDegrees) {
  Counts counts;
  for (int degree = 1; degree <= 7; ++degree) {
    for (const bool rational : {false, true}) {
      const auto seed = static_cast<std::uint64_t>(degree);
      Compare(testing::Single(testing::RandomTriangle(seed, degree, rational)), 2.0, 100, 80, seed, counts);
    }
  }
  ExpectOracleMostlyAgrees(counts);
}

// The kinds blended from data along their borders.
TEST(Oracle, BrownPatches) {
  Counts counts;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Compare(testing::Single(testing::RandomBrown(seed, 3, 3)), 2.0, 100, 80, seed, counts);
    Compare(testing::Single(testing::RandomBrown(seed, 4, 3, 20.0, {0.3}, {0.25, 0.7})), 2.0, 100, 80, seed,
            counts);
  }
  ExpectOracleMostlyAgrees(counts);
}

TEST(Oracle, GregoryTrianglesOfBothBlends) {
  Counts counts;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    for (const auto blend : {GregoryPatch::Blend::kCorner, GregoryPatch::Blend::kEdge}) {
      Compare(testing::Single(testing::RandomGregoryTriangle(seed, blend)), 2.0, 100, 80, seed, counts);
    }
  }
  ExpectOracleMostlyAgrees(counts);
}

TEST(Oracle, LoftTriangles) {
  Counts counts;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    Compare(testing::Single(testing::RandomLoftTriangle(seed, 3, false)), 2.0, 100, 80, seed, counts);
    Compare(testing::Single(testing::RandomLoftTriangle(seed, 3, true)), 2.0, 100, 80, seed, counts);
    Compare(testing::Single(testing::RandomLoftTriangle(seed, 4, true)), 2.0, 100, 80, seed, counts);
  }
  ExpectOracleMostlyAgrees(counts);
}

TEST(Oracle, G2GregoryPatches) {
  Counts counts;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    for (const int degree : {5, 6, 7}) {
      Compare(testing::Single(testing::RandomG2Gregory(seed, degree)), 2.0, 100, 80, seed, counts);
    }
  }
  ExpectOracleMostlyAgrees(counts);
}

TEST(Oracle, HosakaPatches) {
  Counts counts;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    for (const bool breaks : {false, true}) {
      for (const bool inner : {false, true}) {
        Compare(testing::Single(testing::RandomHosaka(seed, 3, breaks, inner)), 2.0, 100, 80, seed, counts);
      }
    }
  }
  ExpectOracleMostlyAgrees(counts);
}

// Nets that are singular at corners, under a small ball and a wide one.
TEST(Oracle, SingularCorners) {
  Counts counts;
  std::uint64_t seed = 50;
  for (const PatchShape& shape : testing::SingularKinds()) {
    Compare(testing::Single(shape), 0.7, 100, 60, seed++, counts);
    Compare(testing::Single(shape), 6.0, 100, 60, seed++, counts);
  }
  ExpectOracleMostlyAgrees(counts);
}

// The shipped teapot: closed loops 0.03 mm wide at the lid's apex, handle and spout inside the body, open
// rim.
PatchModel Teapot(double scale) {
  std::ifstream file(std::string(PATCHMILL_SOURCE_DIR) + "/examples/teapot.bpt");
  std::stringstream text;
  text << file.rdbuf();
  absl::StatusOr<PatchModel> model = ReadBpt(text.str());
  if (!model.ok()) return {};
  Placement placement;
  placement.scale = scale;
  placement.up = UpAxis::kY;
  return Place(placement, *model);
}

TEST(Oracle, TheTeapot) {
  const PatchModel model = Teapot(30.0);
  ASSERT_EQ(model.patches.size(), 28u);
  Counts counts;
  Compare(model, 3.0, 40, 150, 1, counts);
  Compare(model, 1.0, 40, 150, 2, counts);
  ExpectOracleMostlyAgrees(counts);
}

TEST(Oracle, SphereWithPolesAndTorus) {
  Counts counts;
  Compare(testing::Sphere(Vec3(0, 0, 0), 8.0), 3.0, 80, 150, 1, counts);
  Compare(testing::Torus(Vec3(0, 0, 0), 12.0, 4.0), 3.0, 40, 150, 2, counts);
  ExpectOracleMostlyAgrees(counts);
}

}  // namespace
}  // namespace patchmill
