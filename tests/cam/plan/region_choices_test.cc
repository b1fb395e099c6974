// Regions that are switched off or cut differently, through the whole chain. The cut areas are compared with
// plain geometry, and the verifier's result with its result for the same program without the choice.
#include "cam/plan/region_choices.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cam/plan/resolve.h"
#include "cam/region/map/regions_digest.h"
#include "core/surface/closest.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's
using ::testing::HasSubstr;

constexpr double kRadius = 3.0, kBend = 0.02, kHalf = 20.0;  // z = -kBend (x^2 + y^2)
// Slope 30 degrees on this circle: the dome's cap is gentle, what is left of the square steep.
const double kCap = std::tan(Radians(30.0)) / (2.0 * kBend);
const double kCell = 2.0 * kHalf / 256.0;  // of the map, in x and y
constexpr double kStep = 0.7;              // mm: more than any step at scallop 0.02

PatchModel Dome() { return Paraboloid(-kBend, kHalf); }

Job DomeJob() {
  Job job = BallJob(kRadius);
  job.operation.scallop = 0.02;
  job.operation.steep_angle = Radians(30.0);
  return job;
}

RegionOverride Change(int region) {
  RegionOverride change;
  change.region = RegionId(region);
  return change;
}

RegionOverride Skip(int region) {
  RegionOverride change = Change(region);
  change.skip = true;
  return change;
}

// visit(contact, pass) of every cutting move.
template <class Visit>
void ForContacts(const JobResult& result, Visit&& visit) {
  for (const Move& move : result.motion.toolpath.moves) {
    if (move.kind != MoveKind::kCut || !move.contact) continue;
    visit(move.contact->p, result.motion.passes[static_cast<std::size_t>(move.pass)]);
  }
}

double Leftover(const Vec3& p, const JobResult& result) {
  const auto& moves = result.motion.toolpath.moves;
  double least = kInfinity;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    if (moves[i].kind == MoveKind::kRapid) continue;
    const Vec3 a = moves[i - 1].to, d = moves[i].to - a;
    const double l2 = d.squaredNorm(), t = l2 > 0 ? std::clamp((p - a).dot(d) / l2, 0.0, 1.0) : 0.0;
    least = std::min(least, (p - a - t * d).norm());
  }
  return least - kRadius;
}

Vec3 OnDome(double r, double angle) { return {r * std::cos(angle), r * std::sin(angle), -kBend * r * r}; }

class ChoosingRegions : public ::testing::Test {
 protected:
  // The gentle cap is the larger one, region 0; the steep ring is region 1.
  void SetUp() override {
    const auto regions = PlanRegions(surface_, DomeJob(), RunContext());
    ASSERT_TRUE(regions.ok()) << regions.status();
    map_ = regions->map;
    ASSERT_EQ(map_.regions.size(), 2u);
    for (const Region& r : map_.regions) (r.slope == SlopeClass::kSteep ? steep_ : gentle_) = r.id.value;
  }
  absl::Status StatusOf(const RegionOverride& change, const std::string& digest = "") {
    Job job = DomeJob();
    job.operation.regions_sha256 = digest;
    job.operation.overrides = {change};
    return PlanRegions(surface_, job, RunContext()).status();
  }
  const Surface surface_ = PlacedSurface(Dome());
  RegionMap map_;
  int gentle_ = -1, steep_ = -1;
};

TEST_F(ChoosingRegions, ASkippedRegionIsNeitherCutNorDemanded) {
  Job job = DomeJob();
  job.operation.overrides = {Skip(steep_)};
  const JobResult result = Mill(surface_, job);
  ASSERT_EQ(result.report.outcome, Outcome::kComplete) << Describe(result);
  double farthest = 0.0;
  ForContacts(result, [&](const Vec3& p, const CutterPath&) { farthest = std::max(farthest, Xy(p).norm()); });
  EXPECT_GT(farthest, kCap - kCell);
  EXPECT_LT(farthest, kCap + kStep + 2.0 * kCell);
  // The cap's area in closed form; its border runs in cells of the map.
  const double slope = 2.0 * kBend * kCap;
  const double cap = kPi / (6.0 * kBend * kBend) * (std::pow(1.0 + slope * slope, 1.5) - 1.0);
  EXPECT_NEAR(result.report.verify.total_area, cap, 0.003 * cap);
  for (int k = 0; k < 40; ++k) {
    EXPECT_LE(Leftover(OnDome((kCap - kCell) * k / 40.0, 1.7 * k), result), 0.02 + job.operation.tolerance);
  }
  // [verification P1] holds everywhere, and the choice is what lets P2 pass.
  EXPECT_TRUE(result.report.verify.gouge_ok);
  const auto resolved = Resolve(surface_, job, RunContext());
  ASSERT_TRUE(resolved.ok());
  const auto judged = VerifyProgramText(surface_, job.operation.tool, result.program,
                                        MakeVerifyParams(job, *resolved), RunContext());
  ASSERT_TRUE(judged.ok()) << judged.status();
  EXPECT_FALSE(judged->finish_ok);
  EXPECT_TRUE(judged->gouge_ok);
}

TEST_F(ChoosingRegions, AGougeInASkippedRegionIsFound) {
  Job job = DomeJob();
  job.operation.overrides = {Skip(gentle_)};
  const auto resolved = Resolve(surface_, job, RunContext());
  const auto choices = ChooseRegions(surface_, map_, job.operation, Vec3::Zero());
  ASSERT_TRUE(resolved.ok() && choices.ok());
  const auto parts = PartsOf(map_, choices->choices);
  ASSERT_EQ(parts.size(), 1u);
  const std::string program =
      "G21 G90 G17 G64 P0.001\nG0 Z20\nM3 S1000\nG0 X0 Y0\nG1 Z-0.5 F100\nG0 Z20\nM5\nM2\n";
  const auto judged = VerifyProgramText(surface_, job.operation.tool, program,
                                        MakeVerifyParams(job, *resolved, parts), RunContext());
  ASSERT_TRUE(judged.ok()) << judged.status();
  EXPECT_FALSE(judged->gouge_ok);
  EXPECT_NEAR(judged->max_gouge, 0.5, 0.01);
}

TEST_F(ChoosingRegions, ARegionHasItsOwnScallop) {
  Job job = DomeJob();
  RegionOverride change = Change(gentle_);
  change.scallop = 0.08;
  job.operation.overrides = {change};
  const JobResult result = Mill(surface_, job);
  ASSERT_EQ(result.report.outcome, Outcome::kComplete) << Describe(result);
  const JobResult plain = Mill(surface_, DomeJob());
  const auto inside = [](const JobResult& of) {
    double length = 0.0;
    const auto& moves = of.motion.toolpath.moves;
    for (std::size_t i = 1; i < moves.size(); ++i) {
      if (moves[i].kind != MoveKind::kCut || Xy(moves[i].to).norm() > kCap - 2.0) continue;
      length += (moves[i].to - moves[i - 1].to).norm();
    }
    return length;
  };
  EXPECT_NEAR(inside(result), 0.5 * inside(plain), 0.05 * inside(plain));  // steps twice as wide
  const double tolerance = job.operation.tolerance;
  double most = 0.0;
  for (int k = 0; k < 400; ++k) {
    const double r = 0.9 * kCap * std::sqrt(k / 400.0);
    most = std::max(most, Leftover(OnDome(r, 2.4 * k), result));
    EXPECT_LE(Leftover(OnDome(kCap + 2 * kCell + 5.0 * k / 400.0, 2.4 * k), result), 0.02 + tolerance);
  }
  EXPECT_LE(most, 0.08 + tolerance);
  EXPECT_GT(most, 0.05) << "the wider scallop is not used";
  EXPECT_NEAR(result.report.figures[static_cast<std::size_t>(gentle_)].step_max /
                  plain.report.figures[static_cast<std::size_t>(gentle_)].step_max,
              2.0, 0.02);  // steps grow with the root of the scallop
}

TEST_F(ChoosingRegions, ARegionHasItsOwnAngleAndStrategy) {
  Job job = DomeJob();
  RegionOverride turned = Change(gentle_), lines = Change(steep_);
  turned.zigzag_angle = Radians(60.0);
  lines.strategy = Strategy::kZigzag;
  job.operation.overrides = {turned, lines};
  const JobResult result = Mill(surface_, job);
  ASSERT_NE(result.report.outcome, Outcome::kVerificationFailed) << Describe(result);
  ASSERT_FALSE(result.program.empty());
  int inside = 0, outside = 0;
  const auto& moves = result.motion.toolpath.moves;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    if (moves[i].kind != MoveKind::kCut || !moves[i].contact) continue;
    const double r = Xy(moves[i].contact->p).norm();
    const CutterPath& pass = result.motion.passes[static_cast<std::size_t>(moves[i].pass)];
    // Contours still belong to what is steep in the cap's part: its border's cells.
    EXPECT_TRUE(pass.kind != PassKind::kContour || std::abs(r - kCap) < kStep + 2 * kCell) << r;
    if (pass.kind != PassKind::kZigzag) continue;
    const Vec2 d = Xy(moves[i].to - moves[i - 1].to).normalized();
    if (r < kCap - 2.0) {
      ++inside;
      EXPECT_NEAR(std::abs(Cross(d, Vec2(0.5, std::sqrt(0.75)))), 0.0, 1e-3);
    } else if (r > kCap + 2.0) {
      ++outside;
      EXPECT_NEAR(std::abs(d.y()), 0.0, 1e-3);
    }
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(outside, 100);
}

TEST_F(ChoosingRegions, APointNamesItsRegion) {
  for (const double r : {3.0, kCap + 2.0}) {
    RegionOverride change = Skip(-1);
    change.at = OnDome(r, 0.3) + Vec3(0, 0, 0.4);
    Operation op = DomeJob().operation;
    op.overrides = {change};
    const auto choices = ChooseRegions(surface_, map_, op, Vec3::Zero());
    ASSERT_TRUE(choices.ok()) << choices.status();
    EXPECT_EQ(choices->choices[static_cast<std::size_t>(gentle_)].skip, r < kCap);
    EXPECT_EQ(choices->choices[static_cast<std::size_t>(steep_)].skip, r > kCap);
    // Points are in the program's frame.
    op.overrides[0].at = *change.at - Vec3(100, 0, 0);
    const auto shifted = ChooseRegions(surface_, map_, op, Vec3(100, 0, 0));
    ASSERT_TRUE(shifted.ok()) << shifted.status();
    EXPECT_EQ(shifted->choices, choices->choices);
  }
}

TEST_F(ChoosingRegions, WhatIsNotThereIsRefused) {
  EXPECT_THAT(std::string(StatusOf(Skip(7)).message()),
              HasSubstr("region_overrides[0].region_id = 7; must be in [0, 1]"));
  RegionOverride off = Skip(-1);
  off.at = OnDome(0, 0) + Vec3(0, 0, 1.5);
  EXPECT_THAT(std::string(StatusOf(off).message()),
              HasSubstr("region_overrides[0].at = 0.0000 0.0000 1.5000; must lie within 1 mm"));
  Job twice = DomeJob();
  RegionOverride by_point = Change(-1);
  by_point.at = OnDome(1, 0);
  by_point.scallop = 0.03;
  twice.operation.overrides = {Skip(gentle_), by_point};
  EXPECT_THAT(std::string(PlanRegions(surface_, twice, RunContext()).status().message()),
              HasSubstr("region_overrides[1] names region"));
  const std::string digest = RegionsDigest(map_);
  EXPECT_TRUE(StatusOf(Skip(0), digest).ok());
  std::string stale = digest;
  stale[0] = static_cast<char>(stale[0] ^ 1);
  EXPECT_EQ(StatusOf(Skip(0), stale).code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(StatusOf(Skip(0), stale).message()), HasSubstr("regions_sha256 = " + Hex(stale)));
}

// The map an override is made for depends on nothing that the overrides say.
TEST_F(ChoosingRegions, OverridesLeaveTheMapAsItIs) {
  Job job = DomeJob();
  job.operation.overrides = {Skip(steep_)};
  job.operation.scallop = 0.05;
  const auto regions = PlanRegions(surface_, job, RunContext());
  ASSERT_TRUE(regions.ok());
  EXPECT_EQ(RegionsDigest(regions->map), RegionsDigest(map_));
}

TEST_F(ChoosingRegions, AllSkippedIsNothingToCut) {
  Job job = DomeJob();
  job.operation.overrides = {Skip(0), Skip(1)};
  const JobResult result = Mill(surface_, job);
  EXPECT_EQ(result.report.outcome, Outcome::kNothingToCut);
  EXPECT_TRUE(result.program.empty());
  EXPECT_NE(result.report.diagnostics.back().message.find("switched off"), std::string::npos);
}

TEST_F(ChoosingRegions, SameBytesForAnyThreadCount) {
  Job job = DomeJob();
  RegionOverride change = Change(steep_);
  change.scallop = 0.04;
  job.operation.overrides = {change};
  const JobResult one = Mill(surface_, job, 1), four = Mill(surface_, job, 4);
  ASSERT_FALSE(one.program.empty()) << Describe(one);
  EXPECT_EQ(one.program, four.program);
}

// A pit too narrow for the ball in the middle of a skipped plain: no pass runs around it.
TEST(RegionParts, UnreachableSurfaceGoesWithWhatSurroundsIt) {
  RegionMap map;
  map.cells = 8;
  map.regions.resize(3);
  for (int id = 0; id < 3; ++id) map.regions[static_cast<std::size_t>(id)].id = RegionId(id);
  map.regions[2].kind = RegionKind::kUnreachable;
  // Columns i < 4 are region 0, the others region 1; a pit (2) in each half.
  std::vector<RegionId> labels(64);
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      const bool pit = (i == 1 || i == 6) && j >= 3 && j <= 4;
      labels[static_cast<std::size_t>(8 * i + j)] = RegionId(pit ? 2 : i < 4 ? 0 : 1);
    }
  }
  map.labels = {labels};
  std::vector<RegionChoice> choices(3);
  choices[0].skip = true;
  const auto parts = PartsOf(map, choices);
  ASSERT_EQ(parts.size(), 1u);
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) EXPECT_EQ(parts[0].where->HasCell(PieceId(0), i, j), i >= 4) << i << " " << j;
  }
  EXPECT_FALSE(parts[0].where->HasAny(PieceId(0), 0.0, 0.5, 0.0, 1.0));
  EXPECT_TRUE(parts[0].where->HasAny(PieceId(0), 0.0, 0.51, 0.0, 1.0));
  EXPECT_FALSE(parts[0].where->Has(PieceId(0), 0.499, 1.0));
  EXPECT_TRUE(parts[0].where->Has(PieceId(0), 0.5, 1.0));
}

// Switching off a region without any cell would have no effect. The error says so.
TEST(RegionParts, ARegionWithoutACellIsRefused) {
  const Surface surface = SurfaceOf(Plane(5));
  RegionMap map;
  map.cells = 2;
  map.regions.resize(2);
  for (int id = 0; id < 2; ++id) map.regions[static_cast<std::size_t>(id)].id = RegionId(id);
  map.labels.assign(surface.pieces.size(), std::vector<RegionId>(4, RegionId(0)));
  Operation op;
  RegionOverride change;
  change.region = RegionId(1);
  change.skip = true;
  op.overrides = {change};
  const auto choices = ChooseRegions(surface, map, op, Vec3::Zero());
  ASSERT_EQ(choices.status().code(), absl::StatusCode::kInvalidArgument) << choices.status();
  EXPECT_NE(choices.status().message().find("region_overrides[0] names region 1"), std::string::npos)
      << choices.status();
  op.overrides[0].region = RegionId(0);
  EXPECT_TRUE(ChooseRegions(surface, map, op, Vec3::Zero()).ok());
}

}  // namespace
}  // namespace patchmill
