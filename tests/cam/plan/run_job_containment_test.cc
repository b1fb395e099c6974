// Parts of a model, boundaries, obstacles and avoided patches through the whole chain: areas in closed form,
// moves judged by plain geometry.
#include <cmath>

#include <gtest/gtest.h>

#include "core/diffgeo/forms.h"
#include "tests/support/jobs/limited_job.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

// Distance from the outside to the box, 0 inside.
double FromBox(const Vec2& q, const Vec2& min, const Vec2& max) {
  return (min - q).cwiseMax(q - max).cwiseMax(0.0).norm();
}

bool IsFeed(const Move& move) { return move.kind != MoveKind::kRapid; }

// visit(centre) every 0.05 mm along the moves that `which` picks.
template <class Which, class Visit>
void AlongMoves(const JobResult& result, Which&& which, Visit&& visit) {
  const auto& moves = result.motion.toolpath.moves;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    if (!which(moves[i])) continue;
    const Vec3 a = moves[i - 1].to, b = moves[i].to;
    const int n = 1 + static_cast<int>((b - a).norm() / 0.05);
    for (int k = 0; k <= n; ++k) visit(Vec3(a + (b - a) * (static_cast<double>(k) / n)));
  }
}

double Distance(const Vec3& p, const JobResult& result) {
  const auto& moves = result.motion.toolpath.moves;
  double least = kInfinity;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    if (!IsFeed(moves[i])) continue;
    const Vec3 a = moves[i - 1].to, d = moves[i].to - a;
    const double l2 = d.squaredNorm(), t = l2 > 0 ? std::clamp((p - a).dot(d) / l2, 0.0, 1.0) : 0.0;
    least = std::min(least, (p - a - t * d).norm());
  }
  return least;
}

TEST(Containment, CenterBoundaryIsCutToTheLineAndNotBeyond) {
  const Surface surface = PlacedSurface(Plane(15));
  Job job = LimitedJob();
  // An L with a slanting side: 16 x 16 without the corner x > 0, y > -x.
  job.operation.selection.boundary = {{{-8, -8}, {8, -8}, {0, 0}, {0, 8}, {-8, 8}}};
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  AlongMoves(result, IsFeed, [](const Vec3& c) {
    EXPECT_LE(FromBox(Xy(c), Vec2(-8, -8), Vec2(8, 8)), 0.01);
    EXPECT_LE(std::min(c.x(), (c.x() + c.y()) * std::sqrt(0.5)), 0.01);
  });
  const double area = 16.0 * 8.0 + 0.5 * 8.0 * 8.0;
  EXPECT_NEAR(result.report.verify.reachable_area, area, 0.01 * area);
  EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kAvoided], 900.0 - area, 0.01 * area);
  double map = 0.0;
  for (const Region& r : result.report.regions) {
    if (r.reason == UnreachableReason::kAvoided) map += r.area;
  }
  EXPECT_NEAR(map, 900.0 - area, 0.01 * area);
}

TEST(Containment, InsideAndOutsideAreTheBallFromAbove) {
  const Surface surface = PlacedSurface(Plane(15));
  for (const double offset : {0.0, -0.7, 0.5}) {
    Job job = LimitedJob();
    job.operation.selection.boundary = {RingOfBox(-7, -5, 7, 5)};
    job.operation.selection.boundary_offset = offset;
    const double w = 14 + 2 * offset, h = 10 + 2 * offset;
    job.operation.selection.boundary_mode = BoundaryMode::kInside;
    const JobResult inside = Mill(surface, job);
    // Widening is by a distance: rounded corners where something is left of it after the ball's radius.
    const double in = (w - 2 * kLimitedRadius) * (h - 2 * kLimitedRadius);
    EXPECT_NEAR(inside.report.verify.reachable_area, in, 0.015 * in) << Describe(inside);
    AlongMoves(inside, IsFeed, [&](const Vec3& c) {
      EXPECT_LE(FromBox(Xy(c), Vec2(-0.5 * w + kLimitedRadius, -0.5 * h + kLimitedRadius),
                        Vec2(0.5 * w - kLimitedRadius, 0.5 * h - kLimitedRadius)),
                0.01);
    });
    job.operation.selection.boundary_mode = BoundaryMode::kOutside;
    const JobResult outside = Mill(surface, job);
    const double r = kLimitedRadius + offset;
    const double out = 14 * 10 + 2 * r * (14 + 10) + kPi * r * r;
    EXPECT_NEAR(outside.report.verify.reachable_area, out, 0.01 * out) << Describe(outside);
    AlongMoves(outside, IsFeed,
               [&](const Vec3& c) { EXPECT_LE(FromBox(Xy(c), Vec2(-7, -5), Vec2(7, 5)), r + 0.01); });
  }
}

TEST(Containment, ContactBoundaryIsWhatMustBeFinished) {
  const double slope = 0.5;
  const Surface surface = PlacedSurface(Plane(15, 0, slope));
  Job job = LimitedJob();
  job.operation.selection.boundary = {RingOfBox(-6, -4, 6, 4), RingOfBox(-2, -1, 2, 1)};
  job.operation.selection.boundary_mode = BoundaryMode::kContact;
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kComplete) << Describe(result);
  const double area = (12 * 8 - 4 * 2) * std::sqrt(1 + slope * slope);
  EXPECT_NEAR(result.report.verify.total_area, area, 0.01 * area);
  // Beyond the line no farther than a step runs on, beside the half step along the line.
  const double step = 2 * std::sqrt(0.02 * (2 * kLimitedRadius - 0.02));
  AlongMoves(
      result, [](const Move& m) { return m.kind == MoveKind::kCut; },
      [&](const Vec3& c) {
        const Vec3 p = c - kLimitedRadius * Vec3(-slope, 0, 1).normalized();
        EXPECT_LE(FromBox(Xy(p), Vec2(-6, -4), Vec2(6, 4)), 1.5 * step + 0.01);
      });
}

TEST(Containment, ContactBoundaryIsWidenedAndNarrowedByItsOffset) {
  const double slope = 0.5;
  const Surface surface = PlacedSurface(Plane(15, 0, slope));
  Job job = LimitedJob();
  job.operation.selection.boundary = {RingOfBox(-6, -4, 6, 4)};
  job.operation.selection.boundary_mode = BoundaryMode::kContact;
  for (const double offset : {2.0, -1.5}) {
    job.operation.selection.boundary_offset = offset;
    const JobResult result = Mill(surface, job);
    ASSERT_EQ(result.report.outcome, Outcome::kComplete) << Describe(result);
    // All places within the offset of the outline: its corners are round outside.
    const double corners = offset > 0 ? (kPi - 4) * offset * offset : 0.0;
    const double area = ((12 + 2 * offset) * (8 + 2 * offset) + corners) * std::sqrt(1 + slope * slope);
    EXPECT_NEAR(result.report.verify.total_area, area, 0.01 * area) << offset;
  }
}

TEST(Containment, OneOfTwoPatches) {
  const PatchModel model = TwoPlanes(Radians(-20), 12);
  const Surface surface = PlacedSurface(model);
  Job job = LimitedJob();
  job.operation.selection.patches = {"#1"};
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kComplete) << Describe(result);
  const double area = 12 * 24 / std::cos(Radians(20));
  EXPECT_NEAR(result.report.verify.total_area, area, 1e-6 * area);
  for (const Move& m : result.motion.toolpath.moves) {
    if (!m.contact) continue;
    EXPECT_TRUE(m.contact->patch.value == 1 || std::abs(m.contact->p.x()) < 1.1);
  }
  // Both together are the whole.
  job.operation.selection.patches = {"#0", "#1"};
  EXPECT_NEAR(Mill(surface, job).report.verify.total_area, 2 * area, 1e-6 * area);
}

TEST(Containment, AvoidedPatchKeepsItsMargin) {
  // Two level patches that meet at x = 0.
  const PatchModel model = Join({Single(Bilinear({-12, -8, 0}, {0, -8, 0}, {-12, 8, 0}, {0, 8, 0})),
                                 Single(Bilinear({0, -8, 0}, {12, -8, 0}, {0, 8, 0}, {12, 8, 0}))});
  const Surface surface = PlacedSurface(model);
  Job job = LimitedJob();
  job.operation.selection.avoid = {"#1"};
  const JobResult plain = Mill(surface, job);
  EXPECT_EQ(plain.report.outcome, Outcome::kComplete) << Describe(plain);
  EXPECT_NEAR(plain.report.verify.total_area, 12 * 16, 1e-6);
  const double margin = 0.5;
  job.operation.selection.avoid_margin = margin;
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  // The ball that touches at x = -d comes within the margin of x = 0 where d^2 + R^2 < (R + margin)^2.
  const double d = std::sqrt(margin * (2 * kLimitedRadius + margin));
  EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kAvoided], 16 * d, 0.01 * 16 * 12);
  EXPECT_NEAR(result.report.verify.reachable_area, 16 * (12 - d), 0.01 * 16 * 12);
  AlongMoves(
      result, [](const Move&) { return true; },
      [&](const Vec3& c) {
        const double x = std::max(0.0, -c.x());  // to the patch, when beside it in y
        if (std::abs(c.y()) < 8) {
          EXPECT_GE(std::hypot(x, c.z()), kLimitedRadius + margin - 0.01);
        }
      });
}

TEST(Containment, ObstacleIsGoneAroundAndOver) {
  const Surface surface = PlacedSurface(Plane(20));
  Job job = LimitedJob();
  const double margin = 1.0, top = 9.0;
  job.setup.obstacles.push_back({"clamp", RingOfBox(-4, -25, 4, 2), top, margin});
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  const double keep = kLimitedRadius + margin;
  AlongMoves(
      result, [](const Move&) { return true; },
      [&](const Vec3& c) {
        EXPECT_TRUE(c.z() - kLimitedRadius >= top + margin - 0.01 ||
                    FromBox(Xy(c), Vec2(-4, -25), Vec2(4, 2)) >= keep - 0.01);
      });
  const double area = (8 + 2 * keep) * 22 + 8 * keep + 0.5 * kPi * keep * keep;
  EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kAvoided], area, 0.01 * area);
  // What ends below the tip is in nobody's way.
  job.setup.obstacles[0].top_z = -margin - 0.1;
  EXPECT_EQ(Mill(surface, job).report.outcome, Outcome::kComplete);
  // Rapids must have room above it.
  job.setup.obstacles[0].top_z = 30;
  job.operation.clearance_z = 30.5;
  const auto low = RunJob(surface, job, RunContext());
  EXPECT_EQ(low.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_NE(low.status().message().find("31"), std::string::npos) << low.status();
}

// A clamp is kept off by the wider one of ball and shank.
TEST(Containment, ObstacleIsKeptOffByTheShank) {
  const Surface surface = PlacedSurface(Plane(25));
  Job job = LimitedJob();
  Tool& tool = job.operation.tool;
  tool.shank_diameter = 12.0;
  tool.flute_length = 10.0;
  const double margin = 1.0, top = 20.0, keep = 6.0 + margin;
  job.setup.obstacles.push_back({"clamp", RingOfBox(-4, -30, 4, 2), top, margin});
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  double least = kInfinity;
  AlongMoves(
      result, [&](const Move&) { return true; },
      [&](const Vec3& c) {
        if (c.z() - kLimitedRadius >= top + margin - 0.01) return;
        least = std::min(least, FromBox(Xy(c), Vec2(-4, -30), Vec2(4, 2)));
      });
  EXPECT_NEAR(least, keep, 0.02);
  const double area = (8 + 2 * keep) * 27 + 8 * keep + 0.5 * kPi * keep * keep;
  EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kAvoided], area, 0.01 * area);
}

// From line to line beside a round clamp the straight way would cut its corner: the link goes a little
// around.
TEST(Containment, LinksGoAroundARoundClamp) {
  Ring round;
  for (int k = 0; k < 48; ++k)
    round.push_back({1.0 + std::cos(2.0 * kPi * k / 48), std::sin(2.0 * kPi * k / 48)});
  Job job = LimitedJob();
  job.setup.obstacles.push_back({"clamp", round, 20.0, 0.5});
  const JobResult result = Mill(PlacedSurface(Plane(15)), job);
  ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
  EXPECT_LE(result.report.motion.retract_count, 1);
}

TEST(Containment, TopLimitsTheTip) {
  const double r = 10;
  const Surface surface = PlacedSurface(Sphere(Vec3(0, 0, 0), r, Half::kUpper));
  Job job = LimitedJob();
  const double top = 6.0;
  job.operation.top_z = top;
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  const double cosine = (top + kLimitedRadius) / (r + kLimitedRadius);
  const double cap = 2 * kPi * r * r * (1 - cosine);
  EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kAvoided], cap, 0.01 * cap);
  AlongMoves(
      result, [](const Move& m) { return m.kind == MoveKind::kCut; },
      [&](const Vec3& c) { EXPECT_LE(c.z() - kLimitedRadius, top + 0.01); });
}

// Everything at once on a wavy part: wanted points at allowed centres are finished, by plain distances.
TEST(Containment, WhatIsWantedAndAllowedIsFinished) {
  const Surface surface = PlacedSurface(RandomBspline(5));  // 40 x 40, heights within 4
  Job job = LimitedJob();
  job.operation.tolerance = 0.01;
  job.operation.selection.boundary = {{{3, 5}, {37, 2}, {30, 36}, {21, 18}, {6, 33}}};
  job.setup.obstacles.push_back({"pin", RingOfBox(18, 8, 21, 11), 8.0, 0.5});
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  const Outline boundary(job.operation.selection.boundary);
  const Locator locator(surface, kLimitedRadius);
  Random random(11);
  int judged = 0;
  for (int i = 0; i < (kSanitized ? 200 : 3000); ++i) {
    const PieceId piece(static_cast<std::int32_t>(random.Uniform(0, 1) * surface.pieces.size()));
    const SurfaceJet jet = Evaluate(surface, piece, random.Uniform(0, 1), random.Uniform(0, 1));
    const auto e = UpwardNormal(jet);
    if (!e) continue;
    const Vec3 c = jet.p + kLimitedRadius * *e;
    if (boundary.SignedDistance(Xy(c)) < 0.0) continue;
    const bool beside = FromBox(Xy(c), Vec2(18, 8), Vec2(21, 11)) >= kLimitedRadius + 0.5;
    if (!beside && c.z() - kLimitedRadius < 8.5) continue;
    if (!locator.Free(c)) continue;
    EXPECT_LE(Distance(jet.p, result), kLimitedRadius + 0.02 + 0.01 + 1e-6);
    ++judged;
  }
  EXPECT_GT(judged, kSanitized ? 20 : 400);
}

TEST(Containment, TheJudgeSeesWhatThePlannerWasNotTold) {
  const Surface surface = PlacedSurface(Plane(15));
  const Job job = LimitedJob();
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kComplete);
  VerifyParams params;
  params.finish.scallop = job.operation.scallop;
  params.floor_z = -1000.0;
  params.stock_top_z = 0.5;
  const auto codes = [&](const VerifyParams& p) {
    const auto report = VerifyProgramText(surface, job.operation.tool, result.program, p, RunContext());
    EXPECT_TRUE(report.ok()) << report.status();
    std::string found;
    for (const Diagnostic& d : report->findings) {
      if (found.find(d.code) == std::string::npos) found += d.code + " ";
      EXPECT_GT(d.where.line.value_or(0), 0) << d.message;
    }
    EXPECT_EQ(report->ok(), found.empty());
    return found;
  };
  EXPECT_EQ(codes(params), "");
  VerifyParams bounded = params;
  bounded.containment.boundary = {Outline({RingOfBox(-14.9, -20, 20, 20)}), BoundaryMode::kCenter, 0.0};
  EXPECT_EQ(codes(bounded), "OUTSIDE_BOUNDARY ");
  bounded.containment.boundary->offset = 0.2 + 0.5 * kLimitedRadius;  // leads begin beyond the border
  EXPECT_EQ(codes(bounded), "");
  VerifyParams clamped = params;
  clamped.containment.obstacles.push_back({"\"vice\"", Outline({RingOfBox(17, -5, 20, 5)}), 4.0, 0.0});
  EXPECT_EQ(codes(clamped), "OBSTACLE_HIT ");
  clamped.containment.obstacles[0].outline = Outline({RingOfBox(18.1 + 0.5 * kLimitedRadius, -5, 21, 5)});
  EXPECT_EQ(codes(clamped), "");
  VerifyParams low = params;
  low.containment.top_z = -0.5;
  EXPECT_EQ(codes(low), "ABOVE_TOP ");
  low.containment.top_z = 0.0;
  EXPECT_EQ(codes(low), "");
  VerifyParams avoiding = params;
  avoiding.containment.avoided = {true};
  avoiding.containment.avoid_margin = 0.1;
  EXPECT_EQ(codes(avoiding), "AVOID_MARGIN ");
}

TEST(Containment, NamesThatAreNotThere) {
  const Surface surface = PlacedSurface(Plane(15));
  for (const char* name : {"#1", "#-1", "#", "lid", ""}) {
    Job job = LimitedJob();
    job.operation.selection.patches = {"#0", name};
    const auto result = RunJob(surface, job, RunContext());
    EXPECT_EQ(result.status().code(), absl::StatusCode::kInvalidArgument) << name;
    EXPECT_NE(result.status().message().find("selection.patch_ids[1]"), std::string::npos) << result.status();
  }
  Job job = LimitedJob();
  job.operation.selection.avoid = {"#0"};
  const JobResult none = Mill(surface, job);
  EXPECT_EQ(none.report.outcome, Outcome::kNothingToCut);
  EXPECT_TRUE(none.program.empty());
  EXPECT_NE(none.report.diagnostics.back().message.find("check the selection"), std::string::npos);
}

// Room for the ball in a chink of some microns, far from all else: one pass there finishes what can be.
TEST(Containment, AnIslandBarelyWiderThanTheBallIsCut) {
  const Surface surface = PlacedSurface(Plane(20));
  for (const double room : {0.004, 0.02, 0.1}) {
    for (const double at : {5.113, 6.0}) {
      const double side = 2.0 * kLimitedRadius + room;
      Job job = LimitedJob();
      job.operation.selection.boundary = {RingOfBox(-18, -18, 0, 18),
                                          RingOfBox(at, -14.9, at + side, -14.9 + side)};
      job.operation.selection.boundary_mode = BoundaryMode::kInside;
      const JobResult result = Mill(surface, job);
      EXPECT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << room << " " << Describe(result);
      const double middle = at + 0.5 * side;
      EXPECT_LE(Distance(Vec3(middle, -14.9 + 0.5 * side, 0.0), result), kLimitedRadius + 0.03) << room;
    }
  }
}

// What there is to cut is what is selected, in the report of a job that cuts nothing too.
TEST(Containment, NothingToCutCountsWhatIsSelected) {
  const Surface surface = PlacedSurface(Plane(15));
  Job job = LimitedJob();
  job.operation.floor_z = 1.0;
  job.operation.selection.boundary = {RingOfBox(-6, -4, 6, 4)};
  job.operation.selection.boundary_mode = BoundaryMode::kContact;
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kNothingToCut);
  ASSERT_EQ(result.report.regions.size(), 1u);
  ASSERT_EQ(result.report.regions.size(), 1u);
  EXPECT_NEAR(result.report.figures[0].selected_share * result.report.regions[0].area, 12 * 8, 1.0);
}

}  // namespace
}  // namespace patchmill
