#include "core/network/patch_model.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/network/control_points.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

Patch Flat(double x0 = 0.0) {
  return {"", BezierPatch{1, 1, {{x0, 0, 0}, {x0, 1, 0}, {x0 + 1, 0, 0}, {x0 + 1, 1, 0}}, {}}};
}
PatchModel One(PatchShape shape) { return {{{"", std::move(shape)}}, {}, {}}; }

BsplinePatch Biquadratic(std::vector<double> knots) {
  const std::size_t n = knots.size() - 3;
  BsplinePatch b{2, 2, knots, knots, {}, {}};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) b.points.emplace_back(i, j, 0.0);
  }
  return b;
}

// The only fault of the model, as "CODE message".
std::string OnlyFault(const PatchModel& model) {
  const Diagnostics faults = ValidateModel(model);
  if (faults.size() != 1) return std::to_string(faults.size()) + " faults";
  EXPECT_EQ(faults[0].severity, Severity::kError);
  EXPECT_THAT(faults[0].message, HasSubstr(faults[0].where.field));
  return faults[0].code + " " + faults[0].message;
}

TEST(Place, TurnsTheUpAxisOntoZ) {
  const std::pair<UpAxis, Vec3> ups[] = {{UpAxis::kZ, Vec3::UnitZ()},     {UpAxis::kY, Vec3::UnitY()},
                                         {UpAxis::kX, Vec3::UnitX()},     {UpAxis::kNegZ, -Vec3::UnitZ()},
                                         {UpAxis::kNegY, -Vec3::UnitY()}, {UpAxis::kNegX, -Vec3::UnitX()}};
  for (const auto& [axis, up] : ups) {
    Placement placement;
    placement.up = axis;
    EXPECT_EQ(Place(placement, up), Vec3::UnitZ());
    Eigen::Matrix3d turn;
    for (int k = 0; k < 3; ++k) turn.col(k) = Place(placement, Vec3::Unit(k));
    EXPECT_EQ(turn * turn.transpose(), Eigen::Matrix3d::Identity());
    EXPECT_EQ(turn.determinant(), 1.0);  // a rotation, never a mirror image
  }
}

TEST(Place, FollowsTheTableOfTheDesign) {
  const Vec3 p(1, 2, 3);
  const auto placed = [&](UpAxis up) { return Place({1.0, up, Vec3::Zero()}, p); };
  EXPECT_EQ(placed(UpAxis::kZ), Vec3(1, 2, 3));
  EXPECT_EQ(placed(UpAxis::kY), Vec3(1, -3, 2));
  EXPECT_EQ(placed(UpAxis::kX), Vec3(-3, 2, 1));
  EXPECT_EQ(placed(UpAxis::kNegZ), Vec3(1, -2, -3));
  EXPECT_EQ(placed(UpAxis::kNegY), Vec3(1, 3, -2));
  EXPECT_EQ(placed(UpAxis::kNegX), Vec3(3, 2, -1));
}

TEST(Place, TurnsByARotationInPlaceOfAnAxis) {
  Placement placement{2.0, UpAxis::kY, Vec3(10, 20, 30)};
  placement.turn = Eigen::AngleAxisd(kPi / 2.0, Vec3::UnitZ()).matrix();
  EXPECT_LE((Place(placement, Vec3(1, 2, 3)) - Vec3(6, 22, 36)).norm(), 1e-14);
  placement.turn = Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).matrix();
  Box3 box;
  box.Add(Vec3(-1, 0, 2));
  box.Add(Vec3(3, 1, 4));
  const Box3 placed = Place(placement, box);
  for (const Vec3& p : {Vec3(-1, 0, 2), Vec3(3, 1, 4), Vec3(3, 0, 2), Vec3(-1, 1, 4), Vec3(0, 0.5, 3)}) {
    const Vec3 q = Place(placement, p);
    EXPECT_TRUE((q.array() >= placed.min.array()).all() && (q.array() <= placed.max.array()).all());
  }
}

TEST(Place, ScalesBeforeItTurnsAndMoves) {
  const Placement placement{2.0, UpAxis::kY, Vec3(10, 20, 30)};
  EXPECT_EQ(Place(placement, Vec3(1, 2, 3)), Vec3(12, 14, 34));
  PatchModel model{{Flat()}, 1e-3, {}};
  const PatchModel placed = Place(placement, model);
  EXPECT_EQ(placed.join_tolerance, 2e-3);
  EXPECT_EQ(ControlPoints(placed.patches[0].shape)[3], Vec3(12, 20, 32));
}

TEST(ControlBox, HoldsEveryControlPoint) {
  const Box3 box = ControlBox({{Flat(), Flat(5)}, {}, {}});
  EXPECT_EQ(box.min, Vec3(0, 0, 0));
  EXPECT_EQ(box.max, Vec3(6, 1, 0));
  EXPECT_TRUE(ControlBox({}).Empty());
}

TEST(ValidateModel, AcceptsEveryKind) {
  GregoryPatch gregory;
  for (std::size_t i = 0; i < 20; ++i) gregory.points[i] = Vec3(static_cast<double>(i), 0, 1);
  BezierTriangle triangle{1, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {1, 2, 3}};
  PatchModel model{
      {Flat(), {"b", Biquadratic({0, 0, 0, 1, 1, 2, 2, 2})}, {"g", gregory}, {"t", triangle}}, {}, {}};
  EXPECT_THAT(ValidateModel(model), IsEmpty());
}

TEST(ValidateModel, AcceptsUnclampedKnots) {
  EXPECT_THAT(ValidateModel(One(Biquadratic({0, 1, 2, 3, 4, 5, 6}))), IsEmpty());
  EXPECT_THAT(ValidateModel(One(Biquadratic({-2, -1, 0, 0, 7, 7, 7}))), IsEmpty());
}

TEST(ValidateModel, WantsOneToAHundredThousandPatches) {
  EXPECT_THAT(OnlyFault({}), HasSubstr("PATCH_COUNT patches has 0 patches; must have 1 to 100000"));
  PatchModel many;
  many.patches.resize(kMaxPatches + 1);
  EXPECT_THAT(OnlyFault(many), HasSubstr("PATCH_COUNT patches has 100001 patches"));
}

TEST(ValidateModel, LimitsControlPointsOfAllPatchesTogether) {
  PatchModel model{{Flat(), Flat()}, {}, {}};
  std::get<BezierPatch>(model.patches[0].shape).points.resize(kMaxControlPoints, Vec3::Zero());
  EXPECT_THAT(OnlyFault(model), HasSubstr("POINT_COUNT patches have 10000004 control points together"));
}

// Knots are cheap: 500 x 500 points of degree 15 make 485 x 485 pieces of 256 points.
TEST(ValidateModel, CountsBsplinesWithThePiecesTheyAreCutInto) {
  BsplinePatch sheet{15, 15, {}, {}, std::vector<Vec3>(500 * 500), {}};
  for (int k = -15; k <= 485 + 15; ++k) sheet.knots_u.push_back(std::clamp(k, 0, 485));
  sheet.knots_v = sheet.knots_u;
  for (std::size_t i = 0; i < sheet.points.size(); ++i) {
    sheet.points[i] = Vec3(static_cast<double>(i / 500), static_cast<double>(i % 500), 0.0);
  }
  EXPECT_THAT(OnlyFault(One(sheet)),
              HasSubstr("POINT_COUNT patches have 60217600 control points together; at most 10000000"));
}

TEST(ValidateModel, RefusesDegreesOutsideOneToFifteen) {
  EXPECT_THAT(OnlyFault(One(BezierPatch{0, 1, {{0, 0, 0}, {1, 0, 0}}, {}})),
              HasSubstr("INVALID_DEGREE patches[0].bezier.degree_u = 0; must be in [1, 15]"));
  EXPECT_THAT(OnlyFault(One(BezierPatch{1, 16, std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}}, {}})),
              HasSubstr("INVALID_DEGREE patches[0].bezier.degree_v = 16"));
  EXPECT_THAT(OnlyFault(One(BezierTriangle{-3, {{0, 0, 0}, {1, 0, 0}}, {}})),
              HasSubstr("INVALID_DEGREE patches[0].triangle.degree = -3"));
}

TEST(ValidateModel, RefusesWrongCounts) {
  EXPECT_THAT(OnlyFault(One(BezierPatch{1, 2, {{0, 0, 0}, {1, 0, 0}}, {}})),
              HasSubstr("POINT_COUNT patches[0].bezier.points has 2 points; must have 6"));
  EXPECT_THAT(OnlyFault(One(BezierTriangle{1, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {1, 1}})),
              HasSubstr("WEIGHT_COUNT patches[0].triangle.weights has 2 numbers"));
  BsplinePatch b = Biquadratic({0, 0, 0, 1, 1, 1});
  b.points.pop_back();
  EXPECT_THAT(OnlyFault(One(b)),
              HasSubstr("POINT_COUNT patches[0].bspline.points has 8 points; must have 9"));
}

TEST(ValidateModel, RefusesNumbersThatAreNotFiniteOrTooLarge) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity}) {
    PatchModel model{{Flat(), Flat(1)}, {}, {}};
    ControlPoints(model.patches[1].shape)[2].y() = bad;
    EXPECT_THAT(OnlyFault(model), HasSubstr("NOT_FINITE patches[1].bezier.points"));
    EXPECT_EQ(ValidateModel(model)[0].where.patch_index, 1);
  }
  PatchModel model{{Flat()}, {}, {}};
  ControlPoints(model.patches[0].shape)[2].z() = -1.1e9;
  EXPECT_THAT(OnlyFault(model), HasSubstr("TOO_LARGE patches[0].bezier.points"));
}

TEST(ValidateModel, RefusesWeightsThatAreNotPositive) {
  for (const double bad : {0.0, -1.0, 1e-300, 1e300, kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
    PatchModel model{{Flat()}, {}, {}};
    std::get<BezierPatch>(model.patches[0].shape).weights = {1, 1, bad, 1};
    EXPECT_THAT(OnlyFault(model), HasSubstr("INVALID_WEIGHT patches[0].bezier.weights")) << bad;
  }
}

TEST(ValidateModel, RefusesKnotsThatMakeNoBasis) {
  const auto fault = [](std::vector<double> knots) {
    BsplinePatch b = Biquadratic({0, 0, 0, 1, 1, 2, 2, 2});
    b.knots_v = std::move(knots);
    return OnlyFault(One(b));
  };
  EXPECT_THAT(fault({0, 0, 1, 1}), HasSubstr("INVALID_KNOTS patches[0].bspline.knots_v has 4 knots"));
  EXPECT_THAT(fault({0, 0, 0, 1, 0.5, 2, 2, 2}), HasSubstr("decreases from 1 to 0.5 at index 4"));
  EXPECT_THAT(fault({0, 0, 0, 1, 1, 1, 2, 2, 2}),
              HasSubstr("repeats 1 3 times; at most 2 for an inner knot"));
  EXPECT_THAT(fault({0, 0, 0, 0, 1, 2, 2, 2}), HasSubstr("repeats 0 4 times; at most 3 for an outer knot"));
  EXPECT_THAT(fault({0, 1, 2, 2, 2, 3}), HasSubstr("empty domain"));
  EXPECT_THAT(fault({0, 0, 0, 1, kInfinity, 2, 2, 2}), HasSubstr("has inf at index 4"));
  EXPECT_THAT(fault({0, 0, 0, 1, 1 + 1e-12, 2, 2, 2}), HasSubstr("distinct knots must be"));
}

TEST(ValidateModel, RefusesAModelWithoutExtent) {
  EXPECT_THAT(OnlyFault(One(BezierPatch{1, 1, std::vector<Vec3>(4, Vec3(1, 2, 3)), {}})),
              HasSubstr("ZERO_EXTENT patches[0].bezier.points"));
  PatchModel far{{Flat()}, {}, {}};
  for (Vec3& p : ControlPoints(far.patches[0].shape)) p = p * 1e-3 + Vec3::Constant(9e8);
  EXPECT_THAT(OnlyFault(far), HasSubstr("ZERO_EXTENT"));
  PatchModel speck{{Flat()}, {}, {}};
  for (Vec3& p : ControlPoints(speck.patches[0].shape)) p *= 1e-10;
  EXPECT_THAT(OnlyFault(speck), HasSubstr("ZERO_EXTENT patches extend over 1.41421e-10 only"));
}

TEST(ValidateModel, RefusesIdsUsedTwiceButNotEmptyOnes) {
  PatchModel model{{Flat(), Flat(1), Flat(2), Flat(3)}, {}, {}};
  EXPECT_THAT(ValidateModel(model), IsEmpty());
  model.patches[1].id = model.patches[3].id = "lid";
  EXPECT_THAT(OnlyFault(model),
              HasSubstr("DUPLICATE_ID patches[3].id = \"lid\" is also the id of patches[1]"));
}

TEST(ValidateModel, WantsAJoinToleranceThatFitsTheModel) {
  for (const double bad : {0.0, -1.0, 1e-10, 1.0, kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(OnlyFault({{Flat()}, bad, {}}), HasSubstr("INVALID_JOIN_TOLERANCE join_tolerance"));
  }
  EXPECT_THAT(ValidateModel({{Flat()}, 1e-3, {}}), IsEmpty());
}

TEST(ValidateModel, ReportsEveryPatchOnceAndNeverMoreThanAThousandFaults) {
  PatchModel model;
  for (int i = 0; i < 1500; ++i) {
    model.patches.push_back(Flat());
    for (Vec3& p : ControlPoints(model.patches.back().shape)) p.x() = kInfinity;
  }
  EXPECT_EQ(ValidateModel(model).size(), 1000u);
  model.patches.resize(3);
  EXPECT_EQ(ValidateModel(model).size(), 3u);
}

}  // namespace
}  // namespace patchmill
