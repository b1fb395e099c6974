#include "tests/support/jobs/jobs.h"

#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cam/limits/reach_tolerance.h"
#include "cam/path/reach/forced_steps.h"
#include "cam/plan/job_preview.h"
#include "cam/post/program_reader.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"
#include "core/surface/closest.h"
#include "core/surface/extent.h"
#include "tests/support/clock.h"
#include "tests/support/leftover.h"
#include "tests/support/sanitized.h"

namespace patchmill::testing {
namespace {

constexpr double kSearch = 1e-5;  // mm, error of the closest-point searches
// Share of the flat step-over. Forced passes must finish areas that need longer steps (0.25 and the margin
// of the report).
constexpr double kLeast = 0.275;

struct Centers {
  Vec3 from, to;
};

class ProgramJudge {
 public:
  ProgramJudge(const Surface& surface, const Job& job, const std::string& program)
      : surface_(surface),
        job_(job),
        radius_(BallRadius(job.operation.tool)),
        kept_(radius_ + job.operation.leave),
        top_(HighestPoint(surface).p.z()),
        stock_top_(job.setup.stock_top_z.value_or(top_ + job.setup.allowance.walls)),
        floor_(job.operation.floor_z.value_or(LowestPoint(surface).p.z())),
        rounding_(std::max(1e-4, TickOf(job.dialect, job.unit))),
        stated_feed_(kMillimetersPer[job.unit] * 1e-4) {
    auto motion = ReadProgram(program, {.dialect = job.dialect, .control_deviation = job.control_deviation});
    EXPECT_TRUE(motion.ok()) << motion.status();
    if (motion.ok()) motion_ = *std::move(motion);
  }

  void CheckFrame() const {
    EXPECT_TRUE(motion_.first_motion_is_up);
    EXPECT_TRUE(motion_.last_motion_is_up);
    EXPECT_TRUE(motion_.ends_with_spindle_off);
    EXPECT_TRUE(motion_.ends_with_coolant_off);
    if (job_.dialect.length_offset) {
      EXPECT_EQ(motion_.tool_number, job_.operation.tool.number);
    }
    EXPECT_LE(motion_.controller_tolerance, 0.3 * job_.operation.tolerance + 1e-9);
  }

  // Rapids at the clearance plane, or clear of all material; the tip never below the floor.
  void CheckRapidsAndFloor() const {
    constexpr double kStep = 0.5;  // mm
    const double clearance = std::max(top_, stock_top_) + kDefaultClearanceAbove;
    for (const ProgramMove& m : motion_.moves) {
      if (!m.to_above) {
        EXPECT_GE(m.to.z(), floor_ - rounding_) << "line " << m.line;
      }
      if (m.kind != ProgramMove::Kind::kRapid || (m.from_above && m.to_above)) continue;
      const Centers c = CentersOf(m);
      if (std::min(c.from.z(), c.to.z()) - radius_ >= clearance - rounding_) continue;
      const int steps = 1 + static_cast<int>((c.to - c.from).norm() / kStep);
      for (int i = 0; i <= steps; ++i) {
        const Vec3 x = c.from + (c.to - c.from) * (static_cast<double>(i) / steps);
        if (x.z() - radius_ >= stock_top_ - rounding_) continue;
        EXPECT_FALSE(
            AnythingNearUpwardRay(surface_, x, radius_ + job_.setup.allowance.walls - rounding_, kSearch))
            << "rapid into the stock in line " << m.line;
      }
    }
  }

  // True if the ball meets no stock along the move.
  bool ThroughAir(const ProgramMove& m) const {
    constexpr double kStep = 0.2;  // mm
    const Centers c = CentersOf(m);
    const int steps = 1 + static_cast<int>((c.to - c.from).norm() / kStep);
    for (int i = 0; i <= steps; ++i) {
      const Vec3 x = c.from + (c.to - c.from) * (static_cast<double>(i) / steps);
      if (AnythingNearUpwardRay(surface_, x, radius_ + job_.setup.allowance.walls - 20.0 * rounding_,
                                kSearch))
        return false;
    }
    return true;
  }

  void CheckFeeds() const {
    const double slack = Radians(0.2);
    for (const ProgramMove& m : motion_.moves) {
      if (m.kind != ProgramMove::Kind::kFeed) continue;
      EXPECT_FALSE(m.from_above || m.to_above) << "line " << m.line;
      const Vec3 d = m.to - m.from;
      if (d.norm() < 20.0 * rounding_) continue;  // its angle is rounding
      const double descent = std::atan2(-d.z(), Xy(d).norm());
      // Both ends are rounded: of short moves the angle is known no better.
      if (descent > Radians(30.0) + slack + 1.5 * rounding_ / d.norm() && !ThroughAir(m)) {
        EXPECT_LE(m.feed, kTestPlungeFeed + stated_feed_)
            << "line " << m.line << " descends at " << Degrees(descent);
      }
      EXPECT_LE(m.feed, kTestFeed + stated_feed_);
    }
  }

  void CheckGouge(Random& random, int samples) const {
    for (int i = 0; i < samples; ++i) {
      const ProgramMove& m = motion_.moves[static_cast<std::size_t>(random.Int(Count()))];
      if (m.from_above && m.to_above) continue;
      const Centers c = CentersOf(m);
      const Vec3 x = c.from + (c.to - c.from) * random.Unit();
      EXPECT_FALSE(AnythingNearUpwardRay(surface_, x, kept_ - job_.operation.tolerance - kSearch, kSearch))
          << "gouge in line " << m.line << " at " << x.transpose();
    }
  }

  void CheckLeftover(Random& random, int samples) const {
    std::vector<CutterPath> cuts;
    for (const ProgramMove& m : motion_.moves) {
      if (m.kind != ProgramMove::Kind::kFeed) continue;
      const Centers c = CentersOf(m);
      CutterPath cut;
      cut.points.resize(2);
      cut.points[0].center = c.from;
      cut.points[1].center = c.to;
      cuts.push_back(std::move(cut));
    }
    const DistanceToPaths distance(cuts);
    const Operation& op = job_.operation;
    const double limit = kept_ + op.scallop + op.tolerance + rounding_;
    if (op.strategy == Strategy::kZigzag && op.angle_auto) return;  // every region has a direction of its own
    ForcedSteps forced{ForcedPasses::kNone, op.zigzag_angle};
    if (op.strategy == Strategy::kContour) forced.passes = ForcedPasses::kContours;
    if (op.strategy == Strategy::kZigzag) forced.passes = ForcedPasses::kLines;
    for (int i = 0; i < samples; ++i) {
      const auto piece = static_cast<std::size_t>(random.Int(static_cast<int>(surface_.pieces.size())));
      const double u = random.Unit(), v = random.Unit();
      const SurfaceJet jet = Evaluate(surface_.pieces[piece], u, v);
      const auto e = UpwardNormal(jet);
      if (!e || !Reachable(jet.p, *e) || NeededStep(forced, jet, *e, {kept_, op.scallop}) < kLeast) continue;
      EXPECT_LT(distance.At(jet.p, limit + 0.5), limit)
          << "left standing at " << jet.p.transpose() << ", piece " << piece << ", u " << u << ", v " << v;
    }
  }

 private:
  int Count() const { return static_cast<int>(motion_.moves.size()); }

  // Ball centres of a move; an end above everything is put high over the other one.
  Centers CentersOf(const ProgramMove& m) const {
    constexpr double kAbove = 50.0;
    Centers c{m.from, m.to};
    if (m.from_above) c.from = Lift(Xy(m.to), std::max(m.to.z(), top_ + kAbove));
    if (m.to_above) c.to = Lift(Xy(m.from), std::max(m.from.z(), top_ + kAbove));
    c.from.z() += radius_;
    c.to.z() += radius_;
    return c;
  }

  // True only if nothing is so near to the ball that the tolerance of the searches could hide it.
  bool Reachable(const Vec3& p, const Vec3& e) const {
    const Vec3 c = p + kept_ * e;
    const double tip = c.z() - radius_, reach_tolerance = ReachTolerance(job_.operation.tolerance);
    return tip >= floor_ - reach_tolerance + kSearch && tip <= job_.operation.top_z.value_or(kInfinity) &&
           !AnythingNearUpwardRay(surface_, c, kept_ - reach_tolerance + kSearch, kSearch);
  }

  const Surface& surface_;
  const Job& job_;
  double radius_, kept_;  // of the ball; the same and the stock to leave
  double top_, stock_top_, floor_;
  double rounding_;     // mm, of a place in the text
  double stated_feed_;  // mm/min, the last digit of a feed
  ProgramMotion motion_;
};

}  // namespace

Surface PlacedSurface(const PatchModel& model, const Setup& setup) {
  auto surface = BuildPlacedSurface(model, setup, RunContext());
  PM_CHECK(surface.ok());
  return *std::move(surface);
}

JobResult Mill(const Surface& surface, const Job& job, int threads) {
  auto result = RunJob(surface, job, RunContext(threads));
  EXPECT_TRUE(result.ok()) << result.status();
  return result.ok() ? *std::move(result) : JobResult();
}

double AreaFor(const JobResult& result, UnreachableReason reason) {
  double area = 0.0;
  for (const Region& region : result.report.regions) area += region.reason == reason ? region.area : 0.0;
  return area;
}

std::string Describe(const JobResult& result) {
  const VerifyReport& v = result.report.verify;
  std::string text = fmt::format(
      "{}: gouge {:.5f}, leftover {:.5f} at ({:.4f}, {:.4f}, {:.4f}) line {}, {:.4f} mm2 above the limit of "
      "{:.2f} reachable; ok {} {} {};",
      Name(result.report.outcome), v.max_gouge, v.max_leftover, v.max_leftover_at.point.x(),
      v.max_leftover_at.point.y(), v.max_leftover_at.point.z(), v.max_leftover_at.line,
      v.leftover_above_limit_area, v.reachable_area, v.gouge_ok, v.finish_ok, v.motion_ok);
  constexpr std::size_t kShown = 3;
  for (std::size_t i = 0; i < std::min(kShown, v.findings.size()); ++i) {
    text += fmt::format(" [{}: {}]", v.findings[i].code, v.findings[i].message);
  }
  return text;
}

void CheckProgram(const Surface& surface, const Job& job, const JobResult& result, Random& random,
                  int samples) {
  const Outcome outcome = result.report.outcome;
  ASSERT_TRUE(outcome == Outcome::kComplete || outcome == Outcome::kCompleteWhereReachable)
      << Describe(result);
  EXPECT_TRUE(result.report.verify.ok());
  EXPECT_EQ(result.report.certificate_defects, 0u);
  ASSERT_FALSE(result.program.empty());
  const ProgramJudge judge(surface, job, result.program);
  judge.CheckFrame();
  judge.CheckRapidsAndFloor();
  judge.CheckFeeds();
  judge.CheckGouge(random, samples);
  judge.CheckLeftover(random, samples);
}

JobResult MillChecked(const Surface& surface, const Job& job) {
  const double start = ClockSeconds(CLOCK_PROCESS_CPUTIME_ID);
  JobResult result = Mill(surface, job);
  const double time = ClockSeconds(CLOCK_PROCESS_CPUTIME_ID) - start;
  EXPECT_TRUE(result.report.verify.ok()) << Describe(result);
  EXPECT_EQ(result.report.certificate_defects, 0u);
  EXPECT_LT(time, kSanitized ? 1800.0 : 60.0);
  Random random(11);
  CheckProgram(surface, job, result, random, 1000);
  return result;
}

}  // namespace patchmill::testing
