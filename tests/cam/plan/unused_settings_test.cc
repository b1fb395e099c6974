// Settings without effect are reported, and have none.
#include "cam/plan/unused_settings.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

std::vector<std::string> Fields(const Operation& op) {
  std::vector<std::string> fields;
  for (const Diagnostic& d : UnusedSettings(op)) {
    EXPECT_EQ(d.code, "SETTING_WITHOUT_EFFECT");
    fields.push_back(d.where.field);
  }
  return fields;
}

using List = std::vector<std::string>;

TEST(UnusedSettings, OfLinesWhereContoursCutEverything) {
  Operation op;
  op.zigzag_angle = 0.5;
  op.one_way = true;
  EXPECT_EQ(Fields(op), List{});
  op.strategy = Strategy::kContour;
  EXPECT_EQ(Fields(op), (List{"zigzag_angle_deg", "one_way_lines"}));
  op.zigzag_angle = 0.0;
  op.angle_auto = true;
  EXPECT_EQ(Fields(op), (List{"zigzag_angle_auto", "one_way_lines"}));
  op.one_way = op.angle_auto = op.round_lines = op.border_passes = false;
  op.zigzag_bend = 0.0;
  EXPECT_EQ(Fields(op), (List{"zigzag_bend_deg", "round_lines", "border_passes"}));
  op.overrides.emplace_back().strategy = Strategy::kZigzag;  // one region has lines
  EXPECT_EQ(Fields(op), List{});
}

TEST(UnusedSettings, OfFlutesWithoutAWiderShank) {
  Operation op;
  op.tool.flute_length = 10.0;
  EXPECT_EQ(Fields(op), List{"tool.flute_length_mm"});
  op.tool.shank_diameter = 2.0 * BallRadius(op.tool) + 2.0;
  EXPECT_EQ(Fields(op), List{});
}

TEST(UnusedSettings, OfContoursWhereLinesCutEverything) {
  Operation op;
  op.spirals = true;
  op.contour_direction = CutDirection::kEither;
  EXPECT_EQ(Fields(op), List{});
  op.strategy = Strategy::kZigzag;
  EXPECT_EQ(Fields(op), (List{"contour_spirals", "contour_direction"}));
  op.overrides.emplace_back().skip = true;
  EXPECT_EQ(Fields(op).size(), 2u);
  op.overrides.emplace_back().strategy = Strategy::kAuto;
  EXPECT_EQ(Fields(op), List{});
}

TEST(UnusedSettings, OfSingleRegions) {
  Operation op;
  RegionOverride& first = op.overrides.emplace_back();
  first.strategy = Strategy::kContour;
  first.zigzag_angle = 0.5;
  RegionOverride& second = op.overrides.emplace_back();
  second.one_way = true;
  second.zigzag_angle = 0.5;
  EXPECT_EQ(Fields(op), List{"region_overrides[0].zigzag_angle_deg"});
  op.strategy = Strategy::kContour;
  EXPECT_EQ(Fields(op), (List{"region_overrides[0].zigzag_angle_deg", "region_overrides[1].zigzag_angle_deg",
                              "region_overrides[1].one_way_lines"}));
  second.strategy = Strategy::kZigzag;
  EXPECT_EQ(Fields(op), List{"region_overrides[0].zigzag_angle_deg"});
}

TEST(UnusedSettings, ChangeNothing) {
  const Surface surface = PlacedSurface(Saddle(0.05, 0.03, 8));
  const auto milled = [&](auto change) {
    Job job = BallJob(3.0);
    job.operation.scallop = 0.03;
    change(job.operation);
    const JobResult result = Mill(surface, job);
    EXPECT_EQ(UnusedSettings(job.operation).empty(),
              std::none_of(result.report.diagnostics.begin(), result.report.diagnostics.end(),
                           [](const Diagnostic& d) { return d.code == "SETTING_WITHOUT_EFFECT"; }));
    EXPECT_FALSE(result.program.empty()) << Describe(result);
    return result.program;
  };
  const std::string contours = milled([](Operation& op) { op.strategy = Strategy::kContour; });
  EXPECT_EQ(milled([](Operation& op) {
              op.strategy = Strategy::kContour;
              op.zigzag_angle = 0.7;
              op.one_way = true;
            }),
            contours);
  EXPECT_EQ(milled([](Operation& op) {
              op.strategy = Strategy::kContour;
              op.angle_auto = true;
            }),
            contours);
  EXPECT_EQ(milled([](Operation& op) {
              op.strategy = Strategy::kContour;
              op.round_lines = op.border_passes = false;
              op.zigzag_bend = 0.0;
            }),
            contours);
  const std::string lines = milled([](Operation& op) { op.strategy = Strategy::kZigzag; });
  EXPECT_EQ(milled([](Operation& op) {
              op.strategy = Strategy::kZigzag;
              op.spirals = true;
              op.contour_direction = CutDirection::kConventional;
            }),
            lines);
}

}  // namespace
}  // namespace patchmill
