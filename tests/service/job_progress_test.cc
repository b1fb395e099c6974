#include "server/job_progress.h"

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

using namespace std::chrono_literals;

TEST(JobProgress, BeforeTheFirstStepNothingIsDone) {
  JobProgress progress;
  EXPECT_EQ(progress.Now().overall_fraction(), 0.0);
  EXPECT_EQ(progress.Now().job_stage(), v1::JOB_STAGE_UNSPECIFIED);
  EXPECT_FALSE(progress.Now().has_remaining_s());
}

TEST(JobProgress, TellsThePlaceInTheQueue) {
  JobProgress progress;
  progress.Queue(3);
  EXPECT_EQ(progress.Now().queue_place(), 3);
  EXPECT_EQ(progress.Now().job_stage(), v1::JOB_STAGE_QUEUED);
  progress.Queue(0);
  progress.Step("joins", 0.5);
  EXPECT_EQ(progress.Now().queue_place(), 0);
  EXPECT_EQ(progress.Now().job_stage(), v1::JOB_STAGE_MODEL);
}

// Steps of later stages may ask for those of earlier ones again ("bounds: tree" while the program is judged).
TEST(JobProgress, NeitherStageNorFractionRunsBack) {
  JobProgress progress;
  double before = 0.0;
  int stage = 0;
  for (const char* step :
       {"joins", "bounds: tree", "regions: heights", "zigzag: ends", "location", "coverage", "link", "verify",
        "bounds: tree", "regions: heights", "verify: cells", "triangles"}) {
    for (const double fraction : {0.0, 0.5, 1.0, 0.2}) {
      progress.Step(step, fraction);
      const v1::Progress now = progress.Now();
      EXPECT_GE(now.overall_fraction(), before) << step;
      EXPECT_GE(static_cast<int>(now.job_stage()), stage) << step;
      EXPECT_LE(now.overall_fraction(), 1.0);
      EXPECT_EQ(now.stage(), step);
      before = now.overall_fraction();
      stage = now.job_stage();
    }
  }
  EXPECT_EQ(stage, v1::JOB_STAGE_DRAWING);
  EXPECT_GT(before, 0.95);
}

TEST(JobProgress, EstimatesTheRestFromWhatIsDone) {
  JobProgress progress;
  progress.Step("verify", 0.0);
  const v1::Progress now = progress.Now(JobProgress::Clock::now() + 65s);
  ASSERT_TRUE(now.has_remaining_s());
  EXPECT_NEAR(now.remaining_s(), 65.0 * (1.0 - now.overall_fraction()) / now.overall_fraction(), 0.5);
}

// Every step that the sources report belongs to a stage, or is one of the two that several stages have.
TEST(JobProgress, KnowsEveryStepOfThePlanner) {
  const std::regex reports("(?:Progress|ParallelFor|ShareProgress)[^\"\\n;]*\"([a-z][a-z: .]*)\"");
  std::set<std::string> unknown;
  int found = 0;
  for (const char* folder : {"/core", "/cam"}) {
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(PATCHMILL_SOURCE_DIR + std::string(folder))) {
      if (entry.path().extension() != ".cc" && entry.path().extension() != ".h") continue;
      std::ifstream file(entry.path());
      std::stringstream text;
      text << file.rdbuf();
      const std::string source = text.str();
      for (std::sregex_iterator at(source.begin(), source.end(), reports), end; at != end; ++at) {
        const std::string step = (*at)[1];
        ++found;
        if (!StageOfStep(step)) unknown.insert(step);
      }
    }
  }
  EXPECT_GT(found, 30);
  EXPECT_EQ(unknown, (std::set<std::string>{"bounds: boxes", "bounds: tree", "location"}));
}

}  // namespace
}  // namespace patchmill
