// Trimmed faces against closed forms: areas, borders, and both sides of a border.
#include "core/trim/trim_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/status.h"
#include "core/network/patch_network.h"
#include "tests/support/brep_parts.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

TrimmedModel Trimmed(const BrepModel& part, const TrimParams& params = {}) {
  auto trimmed = TrimFaces(part, params, RunContext());
  PM_CHECK(trimmed.ok());
  for (const Diagnostic& d : trimmed->findings) ADD_FAILURE() << d.code << " " << d.message;
  return *std::move(trimmed);
}

double Area(const TrimmedModel& model) {
  return std::accumulate(model.faces.begin(), model.faces.end(), 0.0,
                         [](double sum, const TrimmedFace& face) { return sum + face.area; });
}

BrepLoop Rectangle(PartMaker& maker, const std::vector<Vec3>& p) {
  BrepLoop loop;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const Vec3 &a = p[k], &b = p[(k + 1) % p.size()];
    loop.push_back(StraightUse(maker.Edge(StraightCurve(a, b)), true, Xy(a), Xy(b)));
  }
  return loop;
}

BrepLoop Circle(PartMaker& maker, const Vec3& center, double radius, bool counter_clockwise) {
  const double side = counter_clockwise ? 1.0 : -1.0;
  const int edge = maker.Edge(ArcCurve(center, {radius, 0, 0}, {0, side * radius, 0}, 4));
  return {UseOf(edge, true, 0, 4, [=](double t) {
    return Vec2(center.x() + radius * std::cos(t * kPi / 2),
                center.y() + side * radius * std::sin(t * kPi / 2));
  })};
}

TEST(TrimPlane, ARectangleIsOnePatch) {
  PartMaker maker;
  maker.Face(BrepPlane{}, {Rectangle(maker, {{0, 0, 0}, {40, 0, 0}, {40, 30, 0}, {0, 30, 0}})});
  const TrimmedModel model = Trimmed(maker.part());
  EXPECT_EQ(model.model.patches.size(), 1U);
  EXPECT_NEAR(Area(model), 1200.0, 1e-9);
  EXPECT_EQ(model.border_error, 0.0);
  EXPECT_NEAR(model.model.join_tolerance.value_or(0.0), 1e-6 * 50.0, 1e-12);
  ASSERT_EQ(model.model.faces.size(), 1U);
  EXPECT_EQ(model.model.faces[0].id, "f1");
  EXPECT_EQ(model.model.faces[0].kind, SurfaceKind::kPlane);
  EXPECT_EQ(model.model.patches[0].face, FaceId(std::size_t{0}));
}

// What a cylinder surrounds: air where its outer side is turned in, or where its frame is mirrored.
TEST(TrimFaces, RoundFacesAreHollowOrNot) {
  for (const bool reversed : {false, true}) {
    for (const bool mirrored : {false, true}) {
      PartMaker maker;
      BrepCylinder cylinder;
      cylinder.radius = 4.0;
      if (mirrored) cylinder.frame.z = -cylinder.frame.z;
      maker.Face(cylinder, {});
      BrepModel part = maker.part();
      part.faces[0].reversed = reversed;
      part.faces[0].name = "bore";
      const BrepModel with_plane = [&] {
        PartMaker plane;
        plane.Face(BrepPlane{}, {Rectangle(plane, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}})});
        BrepModel both = plane.part();
        both.faces.push_back(part.faces[0]);
        return both;
      }();
      const auto trimmed = TrimFaces(with_plane, TrimParams(), RunContext());
      ASSERT_TRUE(trimmed.ok());
      const ModelFace& face = trimmed->model.faces[1];
      EXPECT_EQ(face.hollow, reversed != mirrored);
      EXPECT_EQ(face.radius, 4.0);
      EXPECT_EQ(Title(face), "f2 (bore)");
    }
  }
}

TEST(TrimPlane, PlatesWithRoundHolesAreExact) {
  for (const int holes : {1, 2, 7}) {
    PartMaker maker;
    std::vector<BrepLoop> loops = {Rectangle(maker, {{0, 0, 0}, {100, 0, 0}, {100, 30, 0}, {0, 30, 0}})};
    for (int k = 0; k < holes; ++k)
      loops.push_back(Circle(maker, {10.0 + 12.5 * k, 13.0 + k % 3, 0}, 5, false));
    maker.Face(BrepPlane{}, loops);
    const TrimmedModel model = Trimmed(maker.part());
    // Coordinates are rounded to 2^-33 mm here, along some 400 mm of border.
    EXPECT_NEAR(Area(model), 3000.0 - holes * kPi * 25, 2e-8) << holes;
    // Every corner of a patch lies outside the holes, and every circle is met exactly.
    double nearest = 1e9;
    for (const Patch& patch : model.model.patches) {
      for (const double u : {0.0, 0.3, 1.0}) {
        for (const double v : {0.0, 0.5, 1.0}) {
          const Vec3 p = Position(patch.shape, u, v);
          EXPECT_EQ(p.z(), 0.0);
          for (int k = 0; k < holes; ++k) {
            nearest = std::min(nearest, (Xy(p) - Vec2(10.0 + 12.5 * k, 13.0 + k % 3)).norm() - 5.0);
          }
        }
      }
    }
    EXPECT_NEAR(nearest, 0.0, 1e-9);
  }
}

// Bites of three quarters of a circle along a side. The weights at their ends are not 1, so the x of such
// an end is a quotient, and may differ in its last bit from that of its neighbour.
TEST(TrimPlane, RoundBitesAlongASide) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int round = 0; round < 60; ++round) {
    const double r = 1.0 + unit(random), length = 50.0 + unit(random), height = 8.0 + unit(random),
                 shift = 30.0 * unit(random);
    const auto at = [&](double x, double y) { return Vec3(x + shift, y - shift, 0); };
    PartMaker maker;
    BrepLoop loop;
    const auto line = [&](const Vec3& a, const Vec3& b) {
      loop.push_back(StraightUse(maker.Edge(StraightCurve(a, b)), true, Xy(a), Xy(b)));
    };
    line(at(0, 0), at(length, 0));
    line(at(length, 0), at(length, height));
    Vec3 last = at(length, height);
    const double half = r * std::sqrt(0.5);
    for (int k = 4; k >= 0; --k) {
      const double middle = 6.0 + 9.0 * k + unit(random);
      const Vec3 center = at(middle, height - half);
      line(last, at(middle + half, height));
      // From 45 degrees over -90 degrees to 135 degrees, clockwise.
      BrepCurve arc = ArcCurve(center, {half, half, 0}, {half, -half, 0}, 3);
      const double scale = 0.5 + unit(random);
      for (double& w : arc.weights) w *= scale;
      const int bite = maker.Edge(std::move(arc));
      loop.push_back(UseOf(bite, true, 0, 3, [=](double t) {
        const double angle = kPi / 4 - t * kPi / 2;
        return Vec2(center.x() + r * std::cos(angle), center.y() + r * std::sin(angle));
      }));
      last = at(middle - half, height);
    }
    line(last, at(0, height));
    line(at(0, height), at(0, 0));
    maker.Face(BrepPlane{}, {loop});
    EXPECT_NEAR(Area(Trimmed(maker.part())), length * height - 5 * r * r * (0.75 * kPi + 0.5), 1e-8) << round;
  }
}

TEST(TrimPlane, ADiscAndARing) {
  PartMaker maker;
  maker.Face(BrepPlane{}, {Circle(maker, {3, 4, 0}, 7, true)});
  maker.Face(BrepPlane{}, {Circle(maker, {3, 4, 0}, 9, true), Circle(maker, {4, 4, 0}, 7, false)});
  const TrimmedModel model = Trimmed(maker.part());
  EXPECT_NEAR(model.faces[0].area, kPi * 49, 2e-9);
  EXPECT_NEAR(model.faces[1].area, kPi * (81 - 49), 1e-8);
}

// A whole sphere, cut along its seam: eight carriers.
TEST(TrimSphere, WholeAndWithoutItsCap) {
  for (const double top : {kPi / 2, kPi / 4}) {
    PartMaker maker;
    const double r = 10;
    const Vec3 c(1, 2, 3);
    const double z = r * std::sin(top), rho = r * std::cos(top);
    const int seam = maker.Edge([&] {
      BrepCurve whole = ArcCurve(c, {0, 0, -r}, {r, 0, 0}, 2);
      if (top == kPi / 2) return whole;
      // From the south pole to the cap's rim: one quarter and 45 degrees.
      BrepCurve arc = ArcCurve(c, {0, 0, -r}, {r, 0, 0}, 1);
      const double w = std::cos(kPi / 8);
      const Vec3 b = c + Vec3(rho, 0, z);
      arc.knots = {0, 0, 0, 1, 1, 1.5, 1.5, 1.5};
      arc.points.push_back(c + r * Vec3(1, 0, std::tan(kPi / 8)));
      arc.points.push_back(b);
      arc.weights.push_back(w);
      arc.weights.push_back(1);
      return arc;
    }());
    const double last = top == kPi / 2 ? 2.0 : 1.5;
    const int south = maker.Pole();
    const auto latitude = [](double t) { return -kPi / 2 + t * kPi / 2; };
    BrepLoop loop = {StraightUse(south, true, {0, -kPi / 2}, {2 * kPi, -kPi / 2}),
                     UseOf(seam, true, 0, last, [&](double t) { return Vec2(2 * kPi, latitude(t)); })};
    if (top == kPi / 2) {
      loop.push_back(StraightUse(maker.Pole(), false, {0, kPi / 2}, {2 * kPi, kPi / 2}));
    } else {
      const int rim = maker.Edge(ArcCurve(c + Vec3(0, 0, z), {rho, 0, 0}, {0, rho, 0}, 4));
      loop.push_back(UseOf(rim, false, 0, 4, [&](double t) { return Vec2(t * kPi / 2, top); }));
    }
    loop.push_back(UseOf(seam, false, 0, last, [&](double t) { return Vec2(0, latitude(t)); }));
    BrepFrame frame;
    frame.origin = c;
    maker.Face(BrepSphere{frame, r}, {loop});
    const TrimmedModel model = Trimmed(maker.part());
    EXPECT_EQ(model.model.patches.size(), 8U) << top;
    EXPECT_NEAR(Area(model), 2 * kPi * r * r * (1 + std::sin(top)), 1e-6) << top;
    auto network = BuildNetwork(model.model);
    ASSERT_TRUE(network.ok());
    for (const Patch& patch : model.model.patches) {
      const SurfaceJet jet = Evaluate(patch.shape, 0.4, 0.6);
      EXPECT_NEAR((jet.p - c).norm(), r, 1e-9);
      EXPECT_GT(jet.du.cross(jet.dv).dot(jet.p - c), 0.0);
    }
  }
}

// A cylinder between a level circle and a plane at 45 degrees.
TEST(TrimCylinder, CutAskew) {
  PartMaker maker;
  const double r = 8, h = 20;
  const int bottom = maker.Edge(ArcCurve({0, 0, 0}, {r, 0, 0}, {0, r, 0}, 4));
  const int top = maker.Edge(ArcCurve({0, 0, h}, {r, 0, r}, {0, r, 0}, 4));
  const int seam = maker.Edge(StraightCurve({r, 0, 0}, {r, 0, h + r}));
  const auto turn = [](double t) { return t * kPi / 2; };
  maker.Face(BrepCylinder{{}, r},
             {{UseOf(bottom, true, 0, 4, [&](double t) { return Vec2(turn(t), 0); }),
               UseOf(seam, true, 0, 1, [&](double t) { return Vec2(2 * kPi, t * (h + r)); }),
               UseOf(top, false, 0, 4, [&](double t) { return Vec2(turn(t), h + r * std::cos(turn(t))); }),
               UseOf(seam, false, 0, 1, [&](double t) { return Vec2(0, t * (h + r)); })}});
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const TrimmedModel model = Trimmed(maker.part(), {tolerance});
    EXPECT_NEAR(Area(model), 2 * kPi * r * h, 2 * kPi * r * tolerance) << tolerance;
    EXPECT_LE(model.border_error, tolerance);
  }
}

std::vector<std::string> CodesOf(const BrepModel& part) {
  const auto trimmed = TrimFaces(part, {}, RunContext());
  PM_CHECK(trimmed.ok());
  std::vector<std::string> codes;
  for (const Diagnostic& finding : trimmed->findings) codes.push_back(finding.code);
  return codes;
}

// A box of 40 x 30 x 20 with its area and volume as a reader would state them.
PartMaker Box() {
  PartMaker maker;
  const Vec3 size(40, 30, 20);
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool high : {false, true}) {
      BrepFrame frame;
      frame.origin = high ? Vec3(size[axis] * Vec3::Unit(axis)) : Vec3::Zero();
      const int x = (axis + 1) % 3, y = (axis + 2) % 3;
      frame.x = Vec3::Unit(x);
      frame.y = Vec3::Unit(y);
      frame.z = Vec3::Unit(axis);
      const Vec2 corner[5] = {{0, 0}, {size[x], 0}, {size[x], size[y]}, {0, size[y]}, {0, 0}};
      BrepLoop loop;
      for (int k = 0; k < 4; ++k) {
        const auto at = [&](const Vec2& p) { return Vec3(frame.origin + p.x() * frame.x + p.y() * frame.y); };
        loop.push_back(StraightUse(maker.Edge(StraightCurve(at(corner[k]), at(corner[k + 1]))), true,
                                   corner[k], corner[k + 1]));
      }
      BrepFace& face = maker.Face(BrepPlane{frame}, {loop});
      face.reversed = !high;
      face.area = size[x] * size[y];
    }
  }
  maker.part().bodies.push_back({"box", true, size.prod()});
  return maker;
}

TEST(TrimJudges, ASoundBoxHasNoFinding) { EXPECT_EQ(CodesOf(Box().part()), std::vector<std::string>{}); }

TEST(TrimJudges, PlantedFaultsAreFound) {
  PartMaker area = Box();
  area.part().faces[2].area = 1200.0 * 1.001;
  EXPECT_EQ(CodesOf(area.part()), std::vector<std::string>{"FACE_AREA_DIFFERS"});
  PartMaker turned = Box();
  turned.part().faces[3].reversed = !turned.part().faces[3].reversed;
  EXPECT_EQ(CodesOf(turned.part()), std::vector<std::string>{"VOLUME_DIFFERS"});
  PartMaker lost = Box();
  lost.part().faces[1].loops.clear();
  EXPECT_EQ(CodesOf(lost.part()), std::vector<std::string>{"FACE_LOST"});
  for (const double off : {2e-5, 1e-3, 0.2}) {
    PartMaker gap = Box();
    // One edge of the face x = 0 leaves its plane.
    BrepCurve& curve = gap.part().edges[0].curve;
    curve = {
        2,
        {0, 0, 0, 1, 1, 1},
        {curve.points[0], 0.5 * (curve.points[0] + curve.points[1]) + Vec3(2 * off, 0, 0), curve.points[1]},
        {}};
    const auto trimmed = TrimFaces(gap.part(), {}, RunContext());
    ASSERT_TRUE(trimmed.ok());
    EXPECT_NEAR(trimmed->largest_gap, 2 * off, 1e-9);  // the control point bounds it
    if (off < 1e-4) {                                  // below the border tolerance
      EXPECT_TRUE(trimmed->findings.empty());
      continue;
    }
    ASSERT_EQ(trimmed->findings.size(), 1U);
    EXPECT_EQ(trimmed->findings[0].code, "GAP");
    EXPECT_EQ(trimmed->findings[0].severity, off < 0.1 ? Severity::kWarning : Severity::kError);
  }
}

// The strip [0, 30] x [0, width] of a sheet, whose short sides have no edge where they are shorter than the
// file's accuracy.
TEST(TrimSpline, StripsWhoseShortSidesHaveNoEdge) {
  for (const double width : {2e-4, 9e-6, 4e-6}) {
    BsplinePatch sheet{1, 1, {0, 0, 1, 1}, {0, 0, 1, 1}, {}, {}};
    sheet.points = {{0, 0, 0}, {0, width, 0}, {30, 0, 0}, {30, width, 0}};
    PartMaker maker;
    const int low = maker.Edge(StraightCurve({0, 0, 0}, {30, 0, 0}));
    const int high = maker.Edge(StraightCurve({0, width, 0}, {30, width, 0}));
    const bool has_sides = width > 1e-5;
    BrepLoop loop = {StraightUse(low, true, {0, 0}, {1, 0})};
    if (has_sides)
      loop.push_back(
          StraightUse(maker.Edge(StraightCurve({30, 0, 0}, {30, width, 0})), true, {1, 0}, {1, 1}));
    loop.push_back(StraightUse(high, false, {0, 1}, {1, 1}));
    if (has_sides)
      loop.push_back(StraightUse(maker.Edge(StraightCurve({0, width, 0}, {0, 0, 0})), true, {0, 1}, {0, 0}));
    maker.Face(BrepSpline{sheet}, {loop}).area = 30 * width;
    const TrimmedModel model = Trimmed(maker.part());
    ASSERT_EQ(model.model.patches.size(), 1U) << width;
    EXPECT_NEAR(model.faces[0].area, 30 * width, 1e-9) << width;
    EXPECT_LE(model.border_error, 1e-9) << width;
  }
}

// The file's curve of an edge on the surface bows out by 0.03 mm, so its area is 0.8 mm2 larger than that
// within its edges. So much is no fault; twice as much is.
TEST(TrimJudges, AreasWithinCurvesThatLeaveTheirEdges) {
  BsplinePatch sheet{1, 1, {0, 0, 1, 1}, {0, 0, 1, 1}, {}, {}};
  sheet.points = {{-10, -10, 0}, {-10, 50, 0}, {50, -10, 0}, {50, 50, 0}};
  for (const double stated : {1200.0, 1200.8, 1201.6}) {
    PartMaker maker;
    BrepFace& face =
        maker.Face(BrepSpline{sheet}, {Rectangle(maker, {{0, 0, 0}, {40, 0, 0}, {40, 30, 0}, {0, 30, 0}})});
    for (BrepEdgeUse& use : face.loops[0]) {
      for (Vec2& hint : use.hint) hint = (hint + Vec2(10, 10)) / 60.0;
    }
    BrepEdgeUse& first = face.loops[0][0];
    for (std::size_t k = 0; k < first.hint.size(); ++k)
      first.hint[k].y() -= 0.03 * 4 * first.hint_at[k] * (1 - first.hint_at[k]) / 60.0;
    face.area = stated;
    EXPECT_EQ(CodesOf(maker.part()),
              stated > 1201 ? std::vector<std::string>{"FACE_AREA_DIFFERS"} : std::vector<std::string>{})
        << stated;
  }
}

// A face that cannot be trimmed is left out, and said to be, where it is narrower than borders may be off;
// a wider one is lost.
TEST(TrimJudges, NeedlesWithoutPatchesAreNoLoss) {
  for (const double width : {8e-5, 3e-4}) {
    PartMaker maker = Box();
    BsplinePatch sheet{1, 1, {0, 0, 1, 1}, {0, 0, 1, 1}, {}, {}};
    sheet.points = {{0, 0, 0}, {0, width, 0}, {40, 0, 0}, {40, width, 0}};
    BrepFace& needle = maker.Face(BrepSpline{sheet},
                                  {Rectangle(maker, {{0, 0, 0}, {40, 0, 0}, {40, width, 0}, {0, width, 0}})});
    needle.area = 40 * width;
    needle.loops[0][1].hint.clear();  // the file has no way of this edge on the surface
    const bool narrow = width < 1e-4;
    EXPECT_EQ(CodesOf(maker.part()), std::vector<std::string>{narrow ? "FACE_TOO_NARROW" : "FACE_LOST"})
        << width;
  }
}

// Systems leave edges without length behind at corners. The file's place of such an edge may be anywhere.
TEST(TrimSpline, AnEdgeWithoutLengthAtACornerIsNoPole) {
  BsplinePatch sheet{1, 1, {0, 0, 1, 1}, {0, 0, 1, 1}, {}, {}};
  sheet.points = {{0, 0, 0}, {0, 30, 0}, {40, 0, 0}, {40, 30, 0}};
  for (const Vec2& stated : {Vec2(0.75, 0.5), Vec2(0.7, 0.5), Vec2(0.1, 0.9)}) {
    PartMaker maker;
    const int first = maker.Edge(StraightCurve({0, 0, 0}, {30, 15, 0}));
    const int second = maker.Edge(StraightCurve({30, 15, 0}, {0, 30, 0}));
    const int third = maker.Edge(StraightCurve({0, 30, 0}, {0, 0, 0}));
    maker.Face(BrepSpline{sheet},
               {{StraightUse(first, true, {0, 0}, {0.75, 0.5}),
                 UseOf(maker.Pole(), true, 0, 1, [&](double) { return stated; }),
                 StraightUse(second, true, {0.75, 0.5}, {0, 1}), StraightUse(third, true, {0, 1}, {0, 0})}});
    EXPECT_NEAR(Trimmed(maker.part()).faces[0].area, 450.0, 1e-6) << stated.transpose();
  }
}

// Two borders of a face that cross by less than they may be off.
TEST(TrimSpline, BordersThatCrossByLittleAreTaken) {
  BsplinePatch sheet{1, 1, {0, 0, 1, 1}, {0, 0, 1, 1}, {}, {}};
  sheet.points = {{0, 0, 0}, {0, 40, 0}, {40, 0, 0}, {40, 40, 0}};
  const auto arch = [](double sag) {
    return [sag](double t) { return Vec3(10 + 20 * t, 10 + 3 * t + sag * 4 * t * (1 - t), 0); };
  };
  for (const double off : {1e-7, 1e-6, 1e-5}) {
    PartMaker maker;
    // The way there is the way back, but for a bend that crosses it: a lens without width, beside a
    // rectangle.
    const auto there = arch(off);
    const auto back = [&](double t) {
      return Vec3(there(1 - t) + Vec3(0, off * std::sin(12 * t) - 4 * off * t * (1 - t), 0));
    };
    const int way = maker.Edge(PolynomialCurve(2, there)),
              home = maker.Edge(PolynomialCurve(
                  9, [&](double t) { return Vec3(back(t) - Vec3(0, off * t * std::sin(12.0), 0)); }));
    const auto on = [](const Vec3& p) { return Vec2(p.x() / 40, p.y() / 40); };
    maker.Face(BrepSpline{sheet}, {Rectangle(maker, {{0, 0, 0}, {40, 0, 0}, {40, 40, 0}, {0, 40, 0}}),
                                   {UseOf(way, true, 0, 1, [&](double t) { return on(there(t)); }),
                                    UseOf(home, true, 0, 1, [&](double t) { return on(back(t)); })}});
    // The rectangle's hints are places in mm: those of the sheet are fortieths.
    for (BrepEdgeUse& use : maker.part().faces[0].loops[0]) {
      for (Vec2& hint : use.hint) hint /= 40.0;
    }
    const TrimmedModel model = Trimmed(maker.part());
    EXPECT_NEAR(model.faces[0].area, 1600.0, 40 * off) << off;
    EXPECT_LE(model.border_error, 1e-4) << off;
  }
}

// A strip of a surface of degrees 8 and 8 would have the degree 16: such a surface is approximated, and
// named.
TEST(TrimSpline, DegreesTooHighForASlantedBorderAreLowered) {
  for (const int degree : {7, 8, 15}) {
    BsplinePatch sheet;
    sheet.degree_u = sheet.degree_v = degree;
    for (int k = 0; k < 2 * (degree + 1); ++k) {
      sheet.knots_u.push_back(k <= degree ? 0.0 : 1.0);
      sheet.knots_v.push_back(k <= degree ? 0.0 : 1.0);
    }
    // z = x^2 / 80 in its own degree: the coefficients of t^2 are k (k - 1) / (n (n - 1)).
    for (int i = 0; i <= degree; ++i) {
      const double z = 20.0 * i * (i - 1) / (degree * (degree - 1.0));
      for (int j = 0; j <= degree; ++j) sheet.points.push_back({40.0 * i / degree, 40.0 * j / degree, z});
    }
    const auto arch = [](double t) { return Vec3(40 * t, 0, 20 * t * t); };
    PartMaker maker;
    // The triangle under the diagonal of the sheet.
    const int side = maker.Edge(PolynomialCurve(2, arch));
    const int end = maker.Edge(StraightCurve({40, 0, 20}, {40, 40, 20}));
    const int diagonal =
        maker.Edge(PolynomialCurve(2, [](double t) { return Vec3(40 * t, 40 * t, 20 * t * t); }));
    maker.Face(BrepSpline{sheet},
               {{StraightUse(side, true, {0, 0}, {1, 0}), StraightUse(end, true, {1, 0}, {1, 1}),
                 StraightUse(diagonal, false, {0, 0}, {1, 1})}});
    const auto trimmed = TrimFaces(maker.part(), {}, RunContext());
    ASSERT_TRUE(trimmed.ok()) << trimmed.status();
    // Integral over x of x sqrt(1 + x^2 / 1600) from 0 to 40: 1600 / 3 (2 sqrt(2) - 1).
    EXPECT_NEAR(trimmed->faces[0].area, 1600.0 / 3.0 * (std::sqrt(8.0) - 1.0), 1e-4) << degree;
    EXPECT_LE(trimmed->surface_error, 1e-5);
    EXPECT_EQ(trimmed->surface_error, trimmed->faces[0].surface_error);
    std::vector<std::string> codes;
    for (const Diagnostic& finding : trimmed->findings) codes.push_back(finding.code);
    EXPECT_EQ(codes,
              degree == 7 ? std::vector<std::string>{} : std::vector<std::string>{"SURFACES_APPROXIMATED"});
  }
}

// Ends of borders that follow one another closely must not be drawn together one by one: a wall that leans by
// 0.04 mm over 50 mm in steps of less than the width of a wall.
TEST(TrimCylinder, AFineChainOfCornersKeepsItsLean) {
  PartMaker maker;
  const double r = 20, h = 50, turn = 0.5 * kPi, lean = 0.04 / r;
  const int steps = 5000;
  const auto place = [&](double u, double z) { return Vec3(r * std::cos(u), r * std::sin(u), z); };
  const auto arc = [&](double z, double to) {
    const double w = std::cos(to / 2);
    return BrepCurve{2,
                     {0, 0, 0, 1, 1, 1},
                     {place(0, z), place(to / 2, z).cwiseProduct(Vec3(1 / w, 1 / w, 1)), place(to, z)},
                     {1, w, 1}};
  };
  BrepCurve side;
  side.degree = 1;
  side.knots = {0};
  for (int k = 0; k <= steps; ++k) {
    const double t = static_cast<double>(k) / steps;
    side.points.push_back(place(turn + t * lean, t * h));
    side.knots.push_back(t);
  }
  side.knots.push_back(1);
  maker.Face(BrepCylinder{{}, r},
             {{UseOf(maker.Edge(arc(0, turn)), true, 0, 1, [&](double t) { return Vec2(t * turn, 0); }),
               UseOf(maker.Edge(side), true, 0, 1, [&](double t) { return Vec2(turn + t * lean, t * h); }),
               UseOf(maker.Edge(arc(h, turn + lean)), false, 0, 1,
                     [&](double t) { return Vec2(t * (turn + lean), h); }),
               UseOf(maker.Edge(StraightCurve(place(0, 0), place(0, h))), false, 0, 1,
                     [&](double t) { return Vec2(0, t * h); })}});
  const TrimmedModel model = Trimmed(maker.part());
  EXPECT_NEAR(Area(model), r * h * (turn + 0.5 * lean), 1e-2);
}

// A bicubic sheet, cut by a closed curve in its parameters: both sides together are the sheet.
TEST(TrimSpline, BothSidesOfRandomLoops) {
  std::mt19937 random(20261129);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int round = 0; round < 12; ++round) {
    BsplinePatch sheet;
    sheet.degree_u = sheet.degree_v = 3;
    sheet.knots_u = {0, 0, 0, 0, 0.3 + 0.2 * unit(random), 1, 1, 1, 1};
    sheet.knots_v = {0, 0, 0, 0, 1, 1, 1, 1};
    for (int i = 0; i < 5; ++i) {
      for (int j = 0; j < 4; ++j) sheet.points.push_back({15.0 * i, 18.0 * j, 12.0 * unit(random)});
    }
    const PatchShape shape = sheet;
    PartMaker maker;
    std::vector<BrepLoop> loops(1);
    const Vec2 corner[5] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
    for (int k = 0; k < 4; ++k) {
      const Vec2 a = corner[k], b = corner[k + 1];
      BsplinePatch border = sheet;
      // The border curve of a clamped spline is the spline of its border points.
      BrepCurve curve;
      curve.degree = 3;
      curve.knots = k % 2 == 0 ? sheet.knots_u : sheet.knots_v;
      for (int i = 0; i < (k % 2 == 0 ? 5 : 4); ++i) {
        const int index = k == 0 ? 4 * i : (k == 2 ? 4 * i + 3 : (k == 1 ? 16 + i : i));
        curve.points.push_back(sheet.points[At(index)]);
      }
      const Vec2 low = k < 2 ? a : b, high = k < 2 ? b : a;
      loops[0].push_back(StraightUse(maker.Edge(curve), k < 2, low, high));
    }
    // A loop of quadratic arcs around a random place; their images have degree 12 within a span of the knots.
    const int corners = 3 + round % 5;
    const Vec2 middle(0.3 + 0.4 * unit(random), 0.3 + 0.4 * unit(random));
    std::vector<Vec2> q;
    for (int k = 0; k < 2 * corners; ++k) {
      const double angle = 2 * kPi * (k + 0.4 * unit(random)) / (2 * corners);
      const double rho = 0.08 + 0.18 * unit(random);
      q.push_back(middle + rho * Vec2(std::cos(angle), std::sin(angle)));
    }
    BrepLoop inner, outer;
    const double knot = sheet.knots_u[4];
    for (int k = 0; k < corners; ++k) {
      const Vec2 a = q[At(2 * k)], b = q[At(2 * k + 1)], c = q[At((2 * k + 2) % (2 * corners))];
      const auto at = [=](double t) { return Vec2((1 - t) * (1 - t) * a + 2 * t * (1 - t) * b + t * t * c); };
      // Cut where the arc crosses the knot.
      std::vector<double> cuts = {0.0};
      for (int i = 1; i <= 1000; ++i) {
        double lo = (i - 1) / 1000.0, hi = i / 1000.0;
        if ((at(lo).x() - knot) * (at(hi).x() - knot) >= 0.0) continue;
        for (int n = 0; n < 60; ++n) {
          const double m = 0.5 * (lo + hi);
          ((at(m).x() - knot) * (at(hi).x() - knot) > 0.0 ? hi : lo) = m;
        }
        cuts.push_back(0.5 * (lo + hi));
      }
      cuts.push_back(1.0);
      for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const double t0 = cuts[i], t1 = cuts[i + 1];
        const auto part = [=](double t) { return at(t0 + t * (t1 - t0)); };
        const int edge = maker.Edge(PolynomialCurve(12, [&](double t) {
          const Vec2 p = part(t);
          return Position(shape, p.x(), p.y());
        }));
        inner.push_back(UseOf(edge, true, 0, 1, part));
        outer.insert(outer.begin(), UseOf(edge, false, 0, 1, part));
      }
    }
    loops.push_back(outer);
    maker.Face(BrepSpline{sheet}, {loops[0]});
    maker.Face(BrepSpline{sheet}, loops);
    maker.Face(BrepSpline{sheet}, {inner});
    SCOPED_TRACE(round);
    const TrimmedModel model = Trimmed(maker.part());
    EXPECT_EQ(model.faces[0].patch_count, 2);
    // The loop is at most 200 mm long, and both of its sides follow it with the same graphs.
    EXPECT_NEAR(model.faces[1].area + model.faces[2].area, model.faces[0].area, 1e-6);
    EXPECT_GT(model.faces[2].area, 1.0);
    // All places of the patches lie on the sheet.
    for (const Patch& patch : model.model.patches) {
      const Vec3 p = Position(patch.shape, unit(random), unit(random));
      double nearest = 1e9;
      Vec2 best(0.5, 0.5);
      for (int i = 0; i <= 40; ++i) {
        for (int j = 0; j <= 40; ++j) {
          const double d = (Position(shape, i / 40.0, j / 40.0) - p).norm();
          if (d < nearest) {
            nearest = d;
            best = {i / 40.0, j / 40.0};
          }
        }
      }
      for (int n = 0; n < 20; ++n) {
        const SurfaceJet jet = Evaluate(shape, best.x(), best.y());
        Eigen::Matrix2d m;
        m << jet.du.dot(jet.du), jet.du.dot(jet.dv), jet.du.dot(jet.dv), jet.dv.dot(jet.dv);
        best += m.inverse() * Vec2((p - jet.p).dot(jet.du), (p - jet.p).dot(jet.dv));
        best = best.cwiseMax(0.0).cwiseMin(1.0);
      }
      EXPECT_LT((Position(shape, best.x(), best.y()) - p).norm(), 1e-8);
    }
  }
}

}  // namespace
}  // namespace patchmill
