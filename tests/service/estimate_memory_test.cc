// What a job's stock adds to the estimate of its memory.
#include "server/estimate_memory.h"

#include <memory>

#include <gtest/gtest.h>

#include "cam/plan/plan.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

TEST(EstimateMemory, CountsTheStock) {
  const PatchModel part = Plane(10);
  Job job = BallJob(3.0);
  const double none = static_cast<double>(EstimateMemory(part, job));
  job.setup.stock_body = BlockStock{5.0};
  EXPECT_EQ(static_cast<double>(EstimateMemory(part, job)), none);
  // The area that a roughed part covers is known on a grid: a distance for each of 1500 x 1500 squares.
  job.setup.allowance_stated = true;
  EXPECT_GE(static_cast<double>(EstimateMemory(part, job)), none + 1500.0 * 1500.0 * sizeof(float));
  // Columns over 800 x 800 squares have at least two heights each. A narrow stock has fewer of them.
  job.setup.allowance_stated = false;
  const auto of_model = [&](const PatchModel& stock) {
    job.setup.stock_body =
        ModelStock{std::make_shared<const Surface>(*BuildPlacedSurface(stock, {}, RunContext())), "stock"};
    return static_cast<double>(EstimateMemory(part, job)) - none;
  };
  const double square = of_model(Plane(15));
  EXPECT_GE(square, 800.0 * 800.0 * 2.0 * sizeof(float));
  EXPECT_LT(of_model(Single(Bilinear({-15, -1, 0}, {15, -1, 0}, {-15, 1, 0}, {15, 1, 0}))), 0.2 * square);
  const double more = of_model(Join({Plane(15), Plane(15, 5.0), Plane(15, 6.0)}));
  EXPECT_GE(more, square + 2.0 * 4.0 * sizeof(Vec3));  // two patches of four control points
}

}  // namespace
}  // namespace patchmill
