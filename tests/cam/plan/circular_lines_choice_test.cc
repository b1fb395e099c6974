// Which lines become circles; whole jobs with circular lines keep all promises.
#include "cam/plan/circular_lines_choice.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "core/diffgeo/forms.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/profiles.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

const Vec3 kAxis(4, -3, 1);

// The map with its choices; every region of it.
ChosenRegions Regions(const PatchModel& model, const Job& job) {
  auto regions = PlanRegions(PlacedSurface(model), job, RunContext());
  EXPECT_TRUE(regions.ok()) << regions.status();
  return *std::move(regions);
}

std::vector<CircularLines> RoundOnes(const PatchModel& model, const Job& job) {
  std::vector<CircularLines> found;
  const RegionChoices chosen = Regions(model, job).chosen;
  for (const OpenChoice& open : chosen.open) EXPECT_FALSE(open.circles);
  for (const RegionChoice& choice : chosen.choices) {
    for (const CircularComponent& round : choice.around) found.push_back(round.lines);
  }
  return found;
}

// Outside its crest a mountain, inside a basin: two regions, one axis.
TEST(CircularLines, AWideRimHasThemAroundItsAxis) {
  const auto found = RoundOnes(Torus(kAxis, 20, 8, Half::kUpper), BallJob(3.0));
  ASSERT_EQ(found.size(), 2u);
  double inner = kInfinity, outer = 0.0;
  for (const CircularLines& around : found) {
    EXPECT_NEAR((around.center - Xy(kAxis)).norm(), 0.0, 1e-6);
    inner = std::min(inner, around.inner);
    outer = std::max(outer, around.outer);
  }
  const double reach = 8.0 * std::sqrt(0.5);
  EXPECT_EQ(inner, 3.0 * std::floor((20 - reach) / 3.0));  // whole ball radii
  EXPECT_EQ(outer, 3.0 * std::ceil((20 + reach) / 3.0));
}

// One part, one family of circles, over cells of both regions.
TEST(CircularLines, RegionsAroundOneAxisShareThem) {
  const ChosenRegions regions = Regions(Torus(kAxis, 20, 8, Half::kUpper), BallJob(3.0));
  const std::vector<PlanPart> parts = PartsOf(regions.map, regions.chosen.choices);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].where, nullptr);
  EXPECT_TRUE(parts[0].choice.around.empty());
  ASSERT_EQ(parts[0].round.size(), 1u);
  ASSERT_NE(parts[0].straight, nullptr);
  const SurfaceMask &round = *parts[0].round[0].where, &straight = *parts[0].straight;
  for (std::size_t piece = 0; piece < regions.map.labels.size(); ++piece) {
    for (int i = 0; i < regions.map.cells; ++i) {
      for (int j = 0; j < regions.map.cells; ++j) {
        const PieceId id(static_cast<int>(piece));
        const RegionId region =
            regions.map.labels[piece][static_cast<std::size_t>(i * regions.map.cells + j)];
        ASSERT_NE(round.HasCell(id, i, j), straight.HasCell(id, i, j));
        if (region != kNoRegion && !regions.chosen.choices[region.index()].around.empty()) {
          ASSERT_TRUE(round.HasCell(id, i, j));
        }
      }
    }
  }
}

TEST(CircularLines, ANarrowRimOfASteepRegionHasThemToo) {
  const PatchModel bead = Torus(kAxis, 15, 0.8, Half::kUpper);
  const ChosenRegions regions = Regions(bead, BallJob(3.0));
  int round = 0;
  for (std::size_t id = 0; id < regions.chosen.choices.size(); ++id) {
    if (regions.chosen.choices[id].around.empty()) continue;
    ++round;
    EXPECT_NEAR((regions.chosen.choices[id].around.front().lines.center - Xy(kAxis)).norm(), 0.0, 1e-6);
  }
  EXPECT_GT(round, 0);
}

TEST(CircularLines, NotWhereTheyDoNotPay) {
  const Job job = BallJob(3.0);
  EXPECT_TRUE(RoundOnes(Plane(15), job).empty());
  EXPECT_TRUE(RoundOnes(Saddle(0.02, 0.02, 12), job).empty());
  EXPECT_TRUE(RoundOnes(Paraboloid(-0.02, 15), job).empty());  // holds its axis
  EXPECT_TRUE(RoundOnes(Cylinder(Vec3::Zero(), 10, 20, Half::kUpper), job).empty());
  EXPECT_TRUE(RoundOnes(TwoHills(), job).empty());
}

TEST(CircularLines, NotAgainstWhatIsAsked) {
  const PatchModel rim = Torus(kAxis, 20, 8, Half::kUpper);
  const auto count = [&](auto change) {
    Job job = BallJob(3.0);
    change(job.operation);
    return RoundOnes(rim, job).size();
  };
  const auto none = [&](auto change) { return count(change) == 0; };
  EXPECT_FALSE(none([](Operation&) {}));
  EXPECT_TRUE(none([](Operation& op) { op.round_lines = false; }));
  EXPECT_TRUE(none([](Operation& op) { op.one_way = true; }));
  EXPECT_TRUE(none([](Operation& op) { op.strategy = Strategy::kZigzag; }));
  EXPECT_TRUE(none([](Operation& op) { op.strategy = Strategy::kContour; }));
  RegionOverride change;  // of one region of the two
  change.at = kAxis + Vec3(21, 0, std::sqrt(63.0));
  const auto with = [&](const RegionOverride& c) {
    return count([&](Operation& op) { op.overrides = {c}; });
  };
  change.scallop = 0.02;
  EXPECT_EQ(with(change), 2u);
  change.zigzag_angle = 0.0;
  EXPECT_EQ(with(change), 1u);
  change.zigzag_angle.reset();
  change.one_way = true;
  EXPECT_EQ(with(change), 1u);
}

struct Rim {
  const char* name;
  double major, minor;
};

class RoundJobs : public ::testing::TestWithParam<Rim> {};

TEST_P(RoundJobs, AreShorterAndKeepWhatEveryJobKeeps) {
  const Surface surface = PlacedSurface(Torus(kAxis, GetParam().major, GetParam().minor, Half::kUpper));
  Job job = BallJob(3.0);
  job.operation.scallop = 0.02;
  const JobResult round = Mill(surface, job);
  Random random(3);
  CheckProgram(surface, job, round, random, 4000);
  int closed = 0;
  for (const CutterPath& pass : round.motion.passes)
    closed += pass.kind == PassKind::kZigzag && pass.closed ? 1 : 0;
  EXPECT_GT(closed, 2);
  job.operation.round_lines = false;
  const JobResult straight = Mill(surface, job);
  const auto lines = [](const JobResult& result) {
    double length = result.report.motion.link_length;
    for (const CutterPath& pass : result.motion.passes)
      length += pass.kind == PassKind::kContour ? 0.0 : Length(pass);
    return length;
  };
  EXPECT_LT(lines(round), 0.9 * lines(straight));
  EXPECT_LT(round.report.motion.retract_count, straight.report.motion.retract_count + 1);
}

INSTANTIATE_TEST_SUITE_P(Rims, RoundJobs, ::testing::Values(Rim{"Wide", 20, 8}, Rim{"Narrow", 15, 0.8}),
                         [](const auto& rim) { return rim.param.name; });

TEST(CircularLines, OfTwoRimsEachItsOwn) {
  const PatchModel model =
      Join({Torus({-20, 0, 0}, 14, 5, Half::kUpper), Torus({21, 3, 0}, 12, 4, Half::kUpper)});
  const auto found = RoundOnes(model, BallJob(3.0));
  int first = 0, second = 0;
  for (const CircularLines& around : found) {
    first += (around.center - Vec2(-20, 0)).norm() < 1e-6 ? 1 : 0;
    second += (around.center - Vec2(21, 3)).norm() < 1e-6 ? 1 : 0;
  }
  EXPECT_EQ(first, 2);
  EXPECT_EQ(second, 2);
  EXPECT_EQ(found.size(), 4u);
}

// There are more rims than regions allowed. Equal rims are one region, and each still has its own circular
// lines. A plate in the same region keeps straight lines.
TEST(CircularLines, OfManyRimsInOneRegionEachItsOwn) {
  PatchModel rims;
  std::vector<Vec2> places;
  for (int k = 0; k < 24; ++k) {
    places.push_back({60.0 * (k % 6), 60.0 * (k / 6)});
    rims = Join({rims, Torus(Lift(places.back(), 0.0), 14, 5, Half::kUpper)});
  }
  const PatchModel with_plate =
      Join({rims, Transformed(Plane(20), Eigen::Affine3d(Eigen::Translation3d(0, -80, 5)))});
  for (const PatchModel* model : std::initializer_list<const PatchModel*>{&rims, &with_plate}) {
    const ChosenRegions regions = Regions(*model, BallJob(3.0));
    std::vector<int> found(places.size(), 0);
    bool plate = false;
    for (std::size_t id = 0; id < regions.chosen.choices.size(); ++id) {
      const RegionChoice& choice = regions.chosen.choices[id];
      for (const auto& [component, around] : choice.around) {
        EXPECT_EQ(regions.map.component_region[component.index()], RegionId(id));
        for (std::size_t k = 0; k < places.size(); ++k)
          found[k] += (around.center - places[k]).norm() < 1e-6 && around.outer < 24.0;
      }
      if (regions.map.regions[id].slope != SlopeClass::kGentle) continue;
      EXPECT_FALSE(choice.around.empty() && choice.all_circular);
      plate = plate || !choice.all_circular;
      for (std::size_t k = 1; k < choice.around.size(); ++k)
        EXPECT_LT(choice.around[k - 1].component, choice.around[k].component);
    }
    EXPECT_EQ(found, std::vector<int>(places.size(), 1));
    EXPECT_EQ(plate, model == &with_plate);
    std::size_t families = 0;
    for (const PlanPart& part : PartsOf(regions.map, regions.chosen.choices)) families += part.round.size();
    EXPECT_EQ(families, places.size());
  }
  Job job = BallJob(3.0);
  job.operation.scallop = 0.05;
  const Surface surface = PlacedSurface(rims);
  const JobResult round = Mill(surface, job);
  job.operation.round_lines = false;
  const JobResult straight = Mill(surface, job);
  EXPECT_LE(round.report.verify.cut_length, 1.25 * round.report.least_cut_length);
  EXPECT_LE(round.report.verify.cut_length, 0.9 * straight.report.verify.cut_length);
  // Each rim is cut by itself (OrderParts), its circles and its contours.
  EXPECT_LE(round.report.motion.retract_count, 2 * static_cast<int>(places.size()));
}

// Whatever is taken from straight lines lies where circles are looked for, up to the ball radius that these
// are looked for beyond.
TEST(CircularLines, TheirCellsLieWhereTheyAreLookedFor) {
  // Of the last one cells are wide: four of them are a ball radius.
  for (const PatchModel& model : {Torus(kAxis, 20, 8, Half::kUpper), Torus(kAxis, 15, 0.8, Half::kUpper),
                                  Torus(kAxis, 120, 40, Half::kUpper)}) {
    const Surface surface = PlacedSurface(model);
    const auto regions = PlanRegions(surface, BallJob(3.0), RunContext());
    ASSERT_TRUE(regions.ok()) << regions.status();
    int families = 0;
    for (const PlanPart& part : PartsOf(regions->map, regions->chosen.choices)) {
      for (const PlanPart::Round& round : part.round) {
        ++families;
        const int n = regions->map.cells;
        for (std::size_t piece = 0; piece < surface.pieces.size(); ++piece) {
          for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
              if (!round.where->HasCell(PieceId(piece), i, j)) continue;
              const SurfaceJet jet = Evaluate(surface.pieces[piece], (i + 0.5) / n, (j + 0.5) / n);
              const auto normal = UpwardNormal(jet);
              if (!normal || normal->z() < std::sqrt(0.5)) continue;
              const double r = (Xy(jet.p) - round.around.center).norm();
              ASSERT_GE(r, round.around.inner - 1e-9);
              ASSERT_LE(r, round.around.outer + 1e-9);
            }
          }
        }
      }
    }
    EXPECT_EQ(families, 1);
  }
}

TEST(CircularLines, OnlyWhatIsWantedCounts) {
  // Half of a rim goes around nothing.
  Job job = BallJob(3.0);
  const PatchModel rim = Torus(kAxis, 20, 8, Half::kUpper);
  ASSERT_FALSE(RoundOnes(rim, job).empty());
  job.operation.selection.patches = {"#0", "#1"};
  EXPECT_TRUE(RoundOnes(rim, job).empty());
}

// With open angles too, and then nothing is left to turn.
TEST(CircularLines, NeedNoAngle) {
  Job job = BallJob(3.0);
  job.operation.scallop = 0.05;
  job.operation.angle_auto = true;
  const Surface surface = PlacedSurface(Torus(kAxis, 20, 8, Half::kUpper));
  const JobResult chosen = Mill(surface, job);
  job.operation.angle_auto = false;
  EXPECT_EQ(chosen.program, Mill(surface, job).program);
}

// A rim beside a gentle area of another kind. That area has straight lines, the rim has circles, and no
// material is left between them.
TEST(CircularLines, BesideStraightOnes) {
  const Surface surface = PlacedSurface(
      Join({Torus({-20, 0, 0}, 14, 5, Half::kUpper),
            Transformed(Paraboloid(-0.02, 12), Eigen::Affine3d(Eigen::Translation3d(14, 0, 2)))}));
  Job job = BallJob(3.0);
  job.operation.scallop = 0.02;
  const JobResult result = Mill(surface, job);
  Random random(5);
  CheckProgram(surface, job, result, random, 4000);
  int round = 0, straight = 0;
  for (const CutterPath& pass : result.motion.passes) {
    if (pass.kind != PassKind::kZigzag) continue;
    ++(pass.closed ? round : straight);
  }
  EXPECT_GT(round, 5);
  EXPECT_GT(straight, 20);
}

// Profiles (r, z) around a rectangle of half sides hx, hy: turned at its corners, drawn along its sides.
PatchModel AroundRectangle(const std::vector<Profile>& profiles, double hx, double hy) {
  PatchModel model = Turned(profiles);
  for (std::size_t i = 0; i < model.patches.size(); ++i) {
    const std::size_t quarter = i % 4;
    const Vec3 corner(quarter == 1 || quarter == 2 ? -hx : hx, quarter >= 2 ? -hy : hy, 0.0);
    for (Vec3& p : std::get<BezierPatch>(model.patches[i].shape).points) p += corner;
  }
  for (int side = 0; side < 4; ++side) {
    const double out = side % 2 == 0 ? hx : hy, along = side % 2 == 0 ? hy : hx;
    Eigen::Affine3d place(Eigen::AngleAxisd(0.5 * kPi * side, Vec3::UnitZ()));
    place.translate(Vec3(out, -along, 0.0));
    for (Patch& patch : Transformed(Drawn(profiles, 2.0 * along), place).patches)
      model.patches.push_back(std::move(patch));
  }
  return model;
}

// The frame around an oblong boss with rounded corners and a fillet at its foot: circles would cross its
// borders at up to 45 degrees.
TEST(CircularLines, OblongFramesHaveStraightLines) {
  const std::vector<Profile> profiles = {Line({0, 10}, {2, 10}), Round({2, 10}, {3, 10}, {3, 9}),
                                         Line({3, 9}, {3, 4}), Round({3, 4}, {3, 0}, {7, 0}),
                                         Line({7, 0}, {13, 0})};
  const ChosenRegions regions =
      Regions(Join({AroundRectangle(profiles, 12, 7),
                    Single(Bilinear({-12, -7, 10}, {12, -7, 10}, {-12, 7, 10}, {12, 7, 10}))}),
              BallJob(3.0));
  for (const RegionChoice& choice : regions.chosen.choices) EXPECT_TRUE(choice.around.empty());
}

}  // namespace
}  // namespace patchmill
