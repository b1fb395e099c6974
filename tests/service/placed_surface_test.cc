// Surfaces that stay in the store from call to call.
#include "server/placed_surface.h"

#include <gtest/gtest.h>

#include "server/convert/model.h"
#include "server/digest.h"
#include "tests/service/requests.h"

namespace patchmill {
namespace {

class PlacedSurfaceTest : public ::testing::Test {
 protected:
  std::shared_ptr<const Surface> Built(const patchmill::Setup& setup, const std::string& caller = "") {
    v1::ModelSource source;
    *source.mutable_model() = testing::Bump();
    const ModelAccess access{nullptr, &store_, caller};
    const auto loaded = LoadModel(source, "source", RunContext(), access);
    EXPECT_TRUE(loaded.ok()) << loaded.status();
    digest_ = loaded->digest;
    const auto built = PlacedSurface(loaded->model, loaded->digest, setup, RunContext(), access);
    EXPECT_TRUE(built.ok()) << built.status();
    return *built;
  }
  Store store_{std::size_t{64} << 20};
  std::string digest_;
};

TEST_F(PlacedSurfaceTest, IsBuiltOnceForEachPlacementAndCaller) {
  const auto first = Built(patchmill::Setup());
  EXPECT_EQ(Built(patchmill::Setup()), first);
  patchmill::Setup setup;
  setup.placement.scale = 2.0;
  const auto scaled = Built(setup);
  EXPECT_NE(scaled, first);
  EXPECT_EQ(Built(setup), scaled);
  setup = patchmill::Setup();
  setup.placement.turn = Mat3(Eigen::AngleAxisd(0.5, Vec3::UnitX()));
  EXPECT_NE(Built(setup), first);
  EXPECT_NE(Built(patchmill::Setup(), "somebody else"), first);
  EXPECT_EQ(Built(patchmill::Setup()), first);
  // What the placement does not depend on makes no other surface.
  setup = patchmill::Setup();
  setup.allowance = 0.7;
  EXPECT_EQ(Built(setup), first);
}

TEST_F(PlacedSurfaceTest, IsForgottenWithItsModel) {
  const auto first = Built(patchmill::Setup());
  store_.ForgetModel("", digest_);
  EXPECT_NE(Built(patchmill::Setup()), first);
}

TEST_F(PlacedSurfaceTest, CountsAtLeastWhatItsPointsTake) {
  const std::size_t before = store_.figures().bytes;
  Built(patchmill::Setup());
  EXPECT_GT(store_.figures().bytes - before, 16 * sizeof(Vec3));
}

TEST(PlacementDigestTest, SeesWallSidesAndRotations) {
  patchmill::Setup setup;
  const std::string plain = PlacementDigest(setup, "model");
  EXPECT_NE(PlacementDigest(setup, "other"), plain);
  setup.wall_sides.push_back({"wall", Vec3(1.0, 2.0, 3.0)});
  EXPECT_NE(PlacementDigest(setup, "model"), plain);
  Job job;
  const std::string upright = JobDigest(job, "model", "");
  job.setup.placement.turn = Mat3(Eigen::AngleAxisd(0.5, Vec3::UnitX()));
  EXPECT_NE(JobDigest(job, "model", ""), upright);
}

}  // namespace
}  // namespace patchmill
