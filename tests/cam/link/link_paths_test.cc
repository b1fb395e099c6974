#include "cam/link/link_paths.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "cam/link/link_moves.h"
#include "cam/link/turn_passes.h"
#include "cam/location/limits/operation_limits.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Half;

constexpr double kRadius = 3.0;

Surface Build(const PatchModel& model) {
  PatchNetwork network;
  network.model = model;
  network.join_tolerance = 1e-4;
  auto surface = BuildSurface(std::move(network), SurfaceParams{}, RunContext{});
  EXPECT_TRUE(surface.ok()) << surface.status();
  return *std::move(surface);
}

// A line of centres above the segment a b, every 0.2 mm on h.
CutterPath Line(const Locator& locator, int line, const Vec2& a, const Vec2& b) {
  CutterPath path;
  path.kind = PassKind::kZigzag;
  path.order_key = line;
  const int n = static_cast<int>((b - a).norm() / 0.2);
  for (int i = 0; i <= n; ++i) {
    const Vec2 q = a + (b - a) * i / n;
    const auto h = locator.Height(q);
    if (h) path.points.push_back({Lift(q, h->z), h->contact, std::nullopt});
  }
  return path;
}

// The circle of centres of a ball that touches a sphere of radius r at centre height z, clockwise seen from
// above (climb).
CutterPath Circle(const Surface& surface, int line, double r, double z) {
  CutterPath path;
  path.kind = PassKind::kContour;
  path.order_key = line;
  path.closed = true;
  const double rho = std::sqrt((r + kRadius) * (r + kRadius) - z * z);
  for (int i = 0; i < 120; ++i) {
    const double t = -2 * kPi * i / 120;
    const Vec3 c(rho * std::cos(t), rho * std::sin(t), z);
    path.points.push_back(
        {c, SurfacePoint{PieceId(surface.pieces.size() - 1), 0, 0, c * (r / (r + kRadius))}, std::nullopt});
  }
  return path;
}

LinkParams Params() {
  LinkParams p;
  p.radius = kRadius;
  p.clearance_z = 16;
  p.stock_top_z = 9;
  p.feed = 1200;
  p.plunge_feed = 400;
  p.lead.radius = 0.5 * kRadius;
  p.pass.chord_tolerance = 0.005;
  return p;
}

// [verification P1, P3] on the motion itself: nothing gouged on any move, rapids clear of the stock or at the
// clearance plane, descents slow.
void CheckMotion(const Surface& surface, const LinkResult& result, const LinkParams& params) {
  const double tolerance = 0.01;
  const Locator ball(surface, kRadius - tolerance), stock(surface, kRadius + params.allowance.walls);
  const auto& moves = result.toolpath.moves;
  ASSERT_GT(moves.size(), 3u);
  EXPECT_EQ(moves.front().kind, MoveKind::kRapid);
  EXPECT_GE(moves.front().to.z(), params.clearance_z + kRadius - 1e-9);
  EXPECT_GE(moves.back().to.z(), params.clearance_z + kRadius - 1e-9);
  for (std::size_t i = 1; i < moves.size(); ++i) {
    const Vec3 a = moves[i - 1].to, d = moves[i].to - a;
    const int n = 1 + static_cast<int>(d.norm() / 0.3);
    for (int k = 0; k <= n; ++k) {
      const Vec3 c = a + d * k / n;
      ASSERT_TRUE(ball.Free(c, 1e-9)) << "move " << i << " gouges at " << c.transpose();
      if (moves[i].kind == MoveKind::kRapid) {
        EXPECT_TRUE(c.z() >= params.clearance_z + kRadius - 1e-9 || stock.Free(c))
            << "rapid in stock, move " << i;
      }
    }
    if (moves[i].kind != MoveKind::kRapid) {
      const double descent = std::atan2(-d.z(), Xy(d).norm());
      const bool in_air = moves[i].kind == MoveKind::kLink && stock.GougeWithin(a, moves[i].to, 1e-9, 1e-9);
      const bool slow = descent > params.plunge_angle && !(in_air && moves[i].feed == params.feed);
      EXPECT_EQ(moves[i].feed, slow ? params.plunge_feed : params.feed) << "move " << i;
    }
  }
}

TEST(LinkPaths, LinesOverAHillAreJoinedAndSafe) {
  const Surface surface =
      Build(testing::Join({testing::Plane(20), testing::Sphere(Vec3(0, 0, -4), 12, Half::kUpper)}));
  const Locator locator(surface, kRadius);
  std::vector<CutterPath> paths;
  for (int i = 0; i < 12; ++i) paths.push_back(Line(locator, i, {-18, -6.0 + i}, {18, -6.0 + i}));
  const auto result = LinkPaths(locator, {}, paths, Params(), RunContext{});
  ASSERT_TRUE(result.ok()) << result.status();
  CheckMotion(surface, *result, Params());
  EXPECT_EQ(result->passes.size(), 12u);
  EXPECT_LE(result->stats.retract_count, 1);  // neighbouring lines stay down; one retract at the end
}

// Between two places beside a clamp that bends straight on would cross it: a little around, on a slope too,
// whose normals point to the clamp from below it.
TEST(LinkPaths, LinksGoAroundLimitsThatBend) {
  const Surface surface = Build(testing::Plane(20, 0.0, 0.2, 0.1));
  const Locator locator(surface, kRadius), stock(surface, kRadius + 1.5);
  Ring round;
  for (int k = 0; k < 96; ++k) round.push_back({std::cos(2.0 * kPi * k / 96), std::sin(2.0 * kPi * k / 96)});
  Containment containment;
  containment.obstacles.push_back({"clamp", Outline({round}), 30.0, 0.0});
  const OperationLimitsParams limits{.ball_radius = kRadius, .tool_radius = kRadius};
  const OperationLimits operation_limits = *OperationLimits::Make(surface, containment, limits, RunContext());
  LinkParams params = Params();
  params.operation_limits = &operation_limits;
  const RunContext run;
  const LinkMaker maker(locator, stock, params, run);
  const double keep = 1.0 + kRadius;
  const auto at = [&](double degrees) {
    const Vec2 q = (keep + 0.01) * Vec2(std::cos(Radians(degrees)), std::sin(Radians(degrees)));
    const auto height = locator.Height(q);
    return CutterPoint{Lift(q, height->z), height->contact, std::nullopt};
  };
  for (double turn = 0.0; turn < 360.0; turn += 30.0) {
    for (const double apart : {10.0, 25.0, 40.0}) {
      const auto moves = maker.StayDown(at(turn), at(turn + apart));
      ASSERT_TRUE(moves.has_value()) << turn << " " << apart;
      EXPECT_GT(moves->size(), 1u);
      Vec3 from = at(turn).center;
      for (const Move& move : *moves) {
        // The polygon of 96 sides is 5e-4 within its circle.
        for (int k = 0; k <= 20; ++k)
          EXPECT_GE(Xy(Vec3(from + (move.to - from) * k / 20.0)).norm(),
                    keep - 0.5 * limits.tolerance - 1e-3);
        from = move.to;
      }
    }
  }
}

// A short pass beside the ends of two lines is cut between them, whichever way round; a long one, and one far
// off, come last.
TEST(LinkPaths, ShortPassesAreCutOnTheWay) {
  const Surface surface = Build(testing::Plane(20));
  const Locator locator(surface, kRadius);
  std::vector<CutterPath> paths;
  for (int i = 0; i < 8; ++i) paths.push_back(Line(locator, i, {-15, -4.0 + i}, {15, -4.0 + i}));
  const auto add = [&](const Vec2& a, const Vec2& b) {
    CutterPath rest = Line(locator, 0, a, b);
    rest.kind = PassKind::kRest;
    paths.push_back(std::move(rest));
  };
  add({15.5, -0.8}, {15.5, -0.2});  // beside the ends of two lines joined there or on the other side
  add({-15.5, 1.8}, {-15.5, 1.2});
  add({17, -19}, {17, 19});
  add({-19, 19}, {-18, 19});
  LinkParams params = Params();
  params.retract_time = 0.0;
  const auto result = LinkPaths(locator, {}, paths, params, RunContext{});
  ASSERT_TRUE(result.ok()) << result.status();
  CheckMotion(surface, *result, params);
  ASSERT_EQ(result->passes.size(), 12u);
  const auto at = [&](const Vec2& q) {
    for (std::size_t i = 0; i < result->passes.size(); ++i) {
      const CutterPath& pass = result->passes[i];
      if (pass.kind != PassKind::kRest) continue;
      for (const CutterPoint& p : pass.points)
        if ((Xy(p.center) - q).norm() < 0.3) return i;
    }
    return std::size_t{99};
  };
  EXPECT_LT(at({15.5, -0.5}), 8u);
  EXPECT_LT(at({-15.5, 1.5}), 8u);
  EXPECT_GE(at({17, 0}), 10u);
  EXPECT_GE(at({-18.5, 19}), 10u);
  EXPECT_LE(result->stats.retract_count, 3);
}

// A line's end that lies apart, as where the part between the two is cut by others: cut outwards the tool
// would run back over all of it.
TEST(LinkPaths, PassesAreTurnedRoundInsteadOfRunBackOver) {
  const Surface surface = Build(testing::Plane(20));
  const Locator locator(surface, kRadius);
  LinkParams params = Params();
  const Locator stock(surface, kRadius + params.allowance.walls + params.approach_gap);
  const RunContext run;
  const LinkMaker maker(locator, stock, params, run);
  const auto cost = [&](const std::vector<CutterPath>& passes) {
    double sum = 0.0;
    for (std::size_t i = 1; i < passes.size(); ++i) {
      const PassEnd end = PassEnd::End(passes[i - 1]);
      sum += CostOf(maker, end, LinkTo(maker, end, passes[i]));
    }
    return sum;
  };
  const std::vector<CutterPath> outwards = {Line(locator, 0, {-15, 0}, {5, 0}),
                                            Line(locator, 1, {4, 0.5}, {9, 0.5}),
                                            Line(locator, 1, {3.8, 0.5}, {-15, 0.5})};
  const auto turned = WithPassesTurned(maker, outwards, run);
  ASSERT_TRUE(turned.ok()) << turned.status();
  ASSERT_EQ(turned->size(), 3u);
  EXPECT_EQ((*turned)[1].points.front().center, outwards[1].points.back().center);
  EXPECT_EQ((*turned)[1].points.back().center, outwards[1].points.front().center);
  EXPECT_EQ((*turned)[0].points.front().center, outwards[0].points.front().center);
  EXPECT_EQ((*turned)[2].points.front().center, outwards[2].points.front().center);
  EXPECT_LT(cost(*turned), cost(outwards));

  const auto stays = [&](std::vector<CutterPath> passes) {
    const Vec3 start = passes[1].points.front().center;
    const auto result = WithPassesTurned(maker, std::move(passes), run);
    return result.ok() && (*result)[1].points.front().center == start;
  };
  EXPECT_TRUE(stays(*turned));
  std::vector<CutterPath> passes = outwards;
  passes[1].traversal = Traversal::kOneWay;
  EXPECT_TRUE(stays(passes));
  passes = outwards;
  passes[1].kind = PassKind::kContour;  // its direction decides between climb and conventional
  EXPECT_TRUE(stays(passes));
}

TEST(LinkPaths, ContoursAreEnteredFromBesideTheWall) {
  const Surface surface =
      Build(testing::Join({testing::Plane(30), testing::Sphere(Vec3::Zero(), 8, Half::kUpper)}));
  const Locator locator(surface, kRadius);
  std::vector<CutterPath> paths;
  for (int i = 0; i < 4; ++i) paths.push_back(Circle(surface, i, 8, 6.0 - i));
  const LinkParams params = Params();
  const auto result = LinkPaths(locator, {}, paths, params, RunContext{});
  ASSERT_TRUE(result.ok()) << result.status();
  CheckMotion(surface, *result, params);
  const auto& moves = result->toolpath.moves;
  std::size_t lead = 0;
  while (lead < moves.size() && moves[lead].kind != MoveKind::kLead) ++lead;
  ASSERT_LT(lead, moves.size());
  std::size_t cut = lead;
  while (moves[cut].kind == MoveKind::kLead) ++cut;
  const Vec3 start = moves[cut - 1].to, outer = moves[lead - 1].to;
  EXPECT_NEAR(outer.z(), start.z(), 1e-12) << "a level arc";
  EXPECT_GT(Xy(outer).norm() - Xy(start).norm(), 0.9 * params.lead.radius) << "from outside";
  // Its last chord goes on as the pass begins.
  const Vec3 last = (start - moves[cut - 2].to).normalized(), first = (moves[cut].to - start).normalized();
  EXPECT_GT(last.dot(first), std::cos(Radians(10.0)));
  EXPECT_EQ(result->stats.retract_count, 1);  // level to level without a retract
  for (std::size_t i = 1; i < result->passes.size(); ++i)
    EXPECT_LT(result->passes[i].points[0].center.z(), result->passes[i - 1].points[0].center.z());
}

// Where a limit cuts a contour off, even one that runs almost along the wall, the pass is entered from beside
// the wall too.
TEST(LinkPaths, ContoursThatALimitCutsOffAreEnteredFromBesideTheWall) {
  const Surface surface = Build(testing::Plane(40, 0.0, -2.0, 0.0));  // a wall of 63 degrees, +x is off it
  LinkParams params = Params();
  params.clearance_z = 100;
  params.stock_top_z = 90;
  const double depth = params.allowance.walls + params.approach_gap;
  const Locator locator(surface, kRadius), stock(surface, kRadius + depth);
  const auto height = locator.Height(Vec2::Zero());
  const CutterPoint end{Lift(Vec2::Zero(), height->z), height->contact, std::nullopt};
  const RunContext run;
  for (const double plunge_feed : {400.0, 1200.0}) {
    params.plunge_feed = plunge_feed;
    for (const double degrees : {20.0, 35.0, 50.0, 70.0}) {
      // The side of the vice, off the wall by so much and 1 um beyond the end of the pass.
      const Vec2 along(std::sin(Radians(degrees)), std::cos(Radians(degrees)));
      const Vec2 beyond(along.y(), -along.x());
      const Vec2 side = (kRadius + 1e-3) * beyond, back = side + 9.0 * beyond;
      Containment containment;
      containment.obstacles.push_back({"vice",
                                       Outline({Ring{side - 30.0 * along, back - 30.0 * along,
                                                     back + 30.0 * along, side + 30.0 * along}}),
                                       200.0, 0.0});
      const OperationLimitsParams limits{.ball_radius = kRadius, .tool_radius = kRadius};
      const OperationLimits operation_limits = *OperationLimits::Make(surface, containment, limits, run);
      params.operation_limits = &operation_limits;
      CutterPath pass;  // of one point, so no arc is tangent to it
      pass.points = {end};
      const std::vector<Move> moves =
          LinkMaker(locator, stock, params, run).Approach(PassEnd::Start(pass)).moves;
      ASSERT_GE(moves.size(), 2u);
      ASSERT_EQ(moves.back().kind, MoveKind::kLead) << degrees;
      const Vec3& beside = moves[moves.size() - 2].to;
      EXPECT_GE(beside.x(), 0.99 * depth) << degrees;
      EXPECT_LE(beyond.dot(Xy(beside)), 1e-3 + 0.5 * limits.tolerance) << degrees;
    }
  }
}

TEST(LinkPaths, FarPassesRetractAndConventionalTurnsContours) {
  const Surface surface =
      Build(testing::Join({testing::Plane(60), testing::Sphere(Vec3::Zero(), 8, Half::kUpper)}));
  const Locator locator(surface, kRadius);
  LinkParams params = Params();
  params.contour_direction = CutDirection::kConventional;
  const auto result = LinkPaths(
      locator, {},
      {Circle(surface, 0, 8, 5), Line(locator, 0, {40, -5}, {40, 5}), Line(locator, 9, {-40, -5}, {-40, 5})},
      params, RunContext{});
  ASSERT_TRUE(result.ok()) << result.status();
  CheckMotion(surface, *result, params);
  EXPECT_EQ(result->stats.retract_count, 3);
  const auto& loop = result->passes.front().points;
  double area = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i)
    area += Cross(Xy(loop[i].center), Xy(loop[(i + 1) % loop.size()].center));
  EXPECT_GT(area, 0.0) << "conventional runs counter-clockwise around a mountain";
}

// Feed moves from the pass to the first rapid after it, mm.
double WayOutLength(const LinkResult& result) {
  const auto& moves = result.toolpath.moves;
  std::size_t i = moves.size();
  while (i > 0 && moves[i - 1].kind != MoveKind::kCut) --i;
  double length = 0.0;
  for (; i < moves.size() && moves[i].kind != MoveKind::kRapid; ++i)
    length += (moves[i].to - moves[i - 1].to).norm();
  return length;
}

TEST(LinkPaths, LeavesAwayFromWhatStandsAbove) {
  // The line ends where the shank touches the ball overhead: straight up is 1.5 mm beside it all the way.
  const Surface surface =
      Build(testing::Join({testing::Plane(30), testing::Sphere(Vec3(0, 0, 12), 8, Half::kAll)}));
  const Locator locator(surface, kRadius);
  LinkParams params = Params();
  params.clearance_z = 30;
  params.stock_top_z = 20.5;
  const auto result =
      LinkPaths(locator, {}, {Line(locator, 0, {-25, 0}, {-8 - kRadius - 1e-6, 0})}, params, RunContext{});
  ASSERT_TRUE(result.ok()) << result.status();
  CheckMotion(surface, *result, params);
  const double depth = params.allowance.walls + params.approach_gap;
  EXPECT_LE(WayOutLength(*result), 2.0 * depth);
  EXPECT_EQ(result->stats.retract_count, 1);
}

TEST(LinkPaths, TakesTheQuickerWay) {
  // Two short lines on either side of a ridge. Up one flank and down the other at plunge feed, or over it.
  const Surface surface =
      Build(testing::Join({testing::Plane(30), testing::Cylinder(Vec3::Zero(), 6, 25, Half::kUpper)}));
  const Locator locator(surface, kRadius);
  const std::vector<CutterPath> paths = {Line(locator, 0, {-8.5, 0}, {-8.5, 1}),
                                         Line(locator, 1, {8.5, 1}, {8.5, 0})};
  LinkParams params = Params();
  params.max_link_length = 40;
  params.retract_time = 0.0;
  const auto over = LinkPaths(locator, {}, paths, params, RunContext{});
  ASSERT_TRUE(over.ok()) << over.status();
  CheckMotion(surface, *over, params);
  EXPECT_EQ(over->stats.retract_count, 2);
  params.clearance_z = 500;  // now the way up takes longer than the ridge
  const auto along = LinkPaths(locator, {}, paths, params, RunContext{});
  ASSERT_TRUE(along.ok()) << along.status();
  CheckMotion(surface, *along, params);
  EXPECT_EQ(along->stats.retract_count, 1);
  EXPECT_GT(along->stats.link_length, over->stats.link_length);
}

TEST(LinkPaths, LinesThatEndAtARoundWallAreJoinedAroundIt) {
  // An upright pin. The straight way from one line's end to the next one's leads through it, along the centre
  // surface up and over it.
  const Eigen::Affine3d upright(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()));
  const Surface surface = Build(testing::Join(
      {testing::Plane(30),
       testing::Transformed(testing::Cylinder(Vec3::Zero(), 8, 6, Half::kAll), Eigen::Affine3d(upright))}));
  const Locator locator(surface, kRadius);
  std::vector<CutterPath> paths;
  double steps = 0.0;
  std::optional<Vec2> last;
  for (int i = 0; i < 10; ++i) {
    const double y = -4.5 + i, r = 8.0 + kRadius + 1e-7;
    const Vec2 at_wall(std::sqrt(r * r - y * y), y);
    if (last && i % 2 == 0) steps += (at_wall - *last).norm();
    last = at_wall;
    paths.push_back(Line(locator, i, at_wall, {25, y}));
  }
  const LinkParams params = Params();
  const auto result = LinkPaths(locator, {}, paths, params, RunContext{});
  ASSERT_TRUE(result.ok()) << result.status();
  CheckMotion(surface, *result, params);
  EXPECT_EQ(result->passes.size(), 10u);
  EXPECT_EQ(result->stats.retract_count, 1);
  double links = 0.0;  // at the wall
  const auto& moves = result->toolpath.moves;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    if (moves[i].kind == MoveKind::kLink && moves[i].to.x() < 20.0)
      links += (moves[i].to - moves[i - 1].to).norm();
  }
  EXPECT_GT(links, 0.9 * steps);
  EXPECT_LT(links, 1.1 * steps);
}

// A retract marks the surface and stops the axes. Up to its cost the ball goes at feed above the stock.
TEST(LinkPaths, StaysCloseAboveTheStockWhereARetractCostsMore) {
  const Surface surface =
      Build(testing::Join({testing::Plane(60), testing::Cylinder(Vec3::Zero(), 6, 50, Half::kUpper)}));
  const Locator locator(surface, kRadius);
  const std::vector<CutterPath> paths = {Line(locator, 0, {-20, -5}, {-20, 5}),
                                         Line(locator, 9, {20, 5}, {20, -5})};
  LinkParams params = Params();
  params.low_rapids = true;
  const Locator stock(surface, kRadius + params.allowance.walls);
  const auto result = LinkPaths(locator, {}, paths, params, RunContext{});
  ASSERT_TRUE(result.ok()) << result.status();
  CheckMotion(surface, *result, params);
  EXPECT_EQ(result->stats.retract_count, 1);
  bool crosses = false;
  const auto& moves = result->toolpath.moves;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    if (moves[i].kind != MoveKind::kLink) continue;
    crosses = crosses || moves[i - 1].to.x() * moves[i].to.x() <= 0.0;
    EXPECT_TRUE(stock.GougeWithin(moves[i - 1].to, moves[i].to, 1e-6, 1e-7));
    EXPECT_EQ(moves[i].feed, params.feed) << "in air, however steep";
  }
  EXPECT_TRUE(crosses);
  // The way up and the way down begin and end without a step back.
  for (std::size_t i = 2; i < moves.size(); ++i) {
    if (moves[i].kind != MoveKind::kLink || moves[i - 1].kind == MoveKind::kRapid) continue;
    const Vec3 before = moves[i - 1].to - moves[i - 2].to, after = moves[i].to - moves[i - 1].to;
    EXPECT_GT(before.dot(after), -0.5 * before.norm() * after.norm()) << "move " << i;
  }
  // Where nobody has stated the stock, nothing goes low over it.
  params.low_rapids = false;
  const auto high = LinkPaths(locator, {}, paths, params, RunContext{});
  ASSERT_TRUE(high.ok()) << high.status();
  EXPECT_EQ(high->stats.retract_count, 2);
  EXPECT_GT(high->stats.saved_by_low_rapids, 0.0);
}

TEST(LinkPaths, NothingInNothingOut) {
  const Surface surface = Build(testing::Plane(10));
  const Locator locator(surface, kRadius);
  const auto result = LinkPaths(locator, {}, {}, Params(), RunContext{});
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(result->toolpath.moves.empty());
}

}  // namespace
}  // namespace patchmill
