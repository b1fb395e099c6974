// Every characteristic line against the curve it is known to be.
#include "core/lines/line_fields.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/diffgeo/forms.h"
#include "core/lines/flow_lines.h"
#include "core/lines/zero_curves.h"
#include "core/lines/zero_root.h"
#include "tests/support/json.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

std::vector<ZeroCurve> Trace(const PatchModel& model, const ZeroField& field) {
  const Surface surface = SurfaceOf(model);
  auto curves = TraceZeroCurves(surface, field, ZeroMeshParams(), 1e-4, RunContext());
  EXPECT_TRUE(curves.ok()) << curves.status();
  return *std::move(curves);
}

// The curves are just `count` closed ones, and distance(p) vanishes on all their points.
template <class Distance>
void ExpectLoops(const std::vector<ZeroCurve>& curves, std::size_t count, const Distance& distance) {
  ASSERT_EQ(curves.size(), count);
  for (const ZeroCurve& curve : curves) {
    EXPECT_TRUE(curve.closed);
    EXPECT_GE(curve.points.size(), 8u);
    for (const SurfacePoint& p : curve.points) EXPECT_NEAR(distance(p.p), 0.0, 2e-8) << p.p.transpose();
  }
}

const Vec3 kAxes[] = {Vec3::UnitZ(), Vec3(0.6, 0.0, 0.8), Vec3(0.48, -0.6, 0.64)};
constexpr double kRadius = 10.0;
PatchModel Ball() { return Sphere(Vec3::Zero(), kRadius); }

TEST(LineFields, ContoursOfASphereAreCirclesAcrossTheAxis) {
  for (const Vec3& axis : kAxes) {
    ExpectLoops(Trace(Ball(), ContourField(3.5, axis)), 1, [&](const Vec3& p) { return axis.dot(p) - 3.5; });
    EXPECT_TRUE(Trace(Ball(), ContourField(10.01, axis)).empty());
  }
}

TEST(LineFields, EquiSlopeLinesOfASphereAreTwoCircles) {
  for (const Vec3& axis : kAxes) {
    ExpectLoops(Trace(Ball(), SlopeField(Radians(40), axis)), 2,
                [&](const Vec3& p) { return std::abs(axis.dot(p)) - kRadius * std::cos(Radians(40)); });
  }
}

TEST(LineFields, IsoBrightnessOfASphereIsOneCircleOnTheSideOfTheLight) {
  for (const Vec3& light : kAxes) {
    for (const double brightness : {0.7, 0.0, -0.4}) {
      ExpectLoops(Trace(Ball(), BrightnessField(brightness, light)), 1,
                  [&](const Vec3& p) { return light.dot(p) - kRadius * brightness; });
    }
  }
}

TEST(LineFields, SilhouettesOfASphereAreGreatAndSmallCircles) {
  for (const Vec3& axis : kAxes) {
    ExpectLoops(Trace(Ball(), SilhouetteField(axis)), 1, [&](const Vec3& p) { return axis.dot(p); });
    // From the distance d the circle seen lies r^2 / d before the centre.
    const double d = 25.0;
    ExpectLoops(Trace(Ball(), EyeSilhouetteField(d * axis)), 1,
                [&](const Vec3& p) { return axis.dot(p) - kRadius * kRadius / d; });
  }
}

TEST(LineFields, HighlightsOfASphereAreTheGreatCircleAcrossTheSectionsTangent) {
  const Vec3 plane = Vec3::UnitX(), across(0.0, 0.6, 0.8);
  const Vec3 along = plane.cross(across);
  ExpectLoops(Trace(Ball(), HighlightField(plane, across)), 1, [&](const Vec3& p) { return along.dot(p); });
}

TEST(LineFields, LinesOfATorus) {
  const double major = 20, minor = 6;
  const PatchModel torus = Torus(Vec3::Zero(), major, minor);
  const auto rho = [](const Vec3& p) { return std::hypot(p.x(), p.y()); };
  // Inflections of the level circles: they lie where the tube is horizontal, and nowhere else does kappa_c
  // change its sign: it is -cos(t) / rho over the tube angle t from the outer equator.
  ExpectLoops(Trace(torus, ContourCurvatureField()), 2, [&](const Vec3& p) { return rho(p) - major; });
  ExpectLoops(Trace(torus, SilhouetteField()), 2, [&](const Vec3& p) { return p.z(); });
  ExpectLoops(Trace(torus, ContourField(4.0)), 2,
              [&](const Vec3& p) { return std::abs(rho(p) - major) - std::sqrt(minor * minor - 16.0); });
  // Every contour is a principal direction.
  EXPECT_TRUE(Trace(torus, SlopeExtremumField()).empty());
}

TEST(LineFields, SlopeExtremumLinesOfAParaboloidAreItsAxes) {
  // z = a x^2 + b y^2: grad phi and grad psi are parallel where (a - b) a b x y = 0; four arms from the pit.
  for (const double b : {0.02, -0.03}) {
    const auto curves = Trace(Quadratic(0.05, b, 8), SlopeExtremumField());
    ASSERT_EQ(curves.size(), 4u);
    for (const ZeroCurve& curve : curves) {
      EXPECT_LT(std::min(curve.points.front().p.norm(), curve.points.back().p.norm()), 1e-9);
      EXPECT_GT(std::max(Xy(curve.points.front().p).norm(), Xy(curve.points.back().p).norm()), 8 - 1e-9);
      for (const SurfacePoint& p : curve.points)
        EXPECT_NEAR(std::min(std::abs(p.p.x()), std::abs(p.p.y())), 0.0, 1e-9);
    }
  }
}

TEST(LineFields, AContourAtTheHeightOfASaddleCrossesItself) {
  // a x^2 = b y^2.
  const double a = 0.05, b = 0.03;
  const auto curves = Trace(Saddle(a, b, 8), ContourField(0.0));
  ASSERT_EQ(curves.size(), 4u);
  for (const ZeroCurve& curve : curves) {
    EXPECT_LT(std::min(curve.points.front().p.norm(), curve.points.back().p.norm()), 1e-9);
    for (const SurfacePoint& p : curve.points)
      EXPECT_NEAR(std::sqrt(a) * std::abs(p.p.x()), std::sqrt(b) * std::abs(p.p.y()), 1e-8);
  }
}

TEST(LineFields, PlanesAndCylindersHaveNoLinesInside) {
  EXPECT_TRUE(Trace(Plane(10, 0, 0.3, 0.2), ContourCurvatureField()).empty());
  EXPECT_TRUE(Trace(Plane(10, 0, 0.3, 0.2), SlopeExtremumField()).empty());
  EXPECT_TRUE(Trace(Plane(10, 2.0), ContourField(2.0)).empty());
  // Straight rulings are the contours of a lying cylinder.
  EXPECT_TRUE(Trace(Cylinder(Vec3::Zero(), 5, 8, Half::kUpper), ContourCurvatureField()).empty());
}

// S = (2u + 0.1uv, 1.5v - 0.2u^2, 0.8u^2 v - 0.6v^2 + 0.5u - 0.3u^3), the example of [lines].
Piece Example() {
  // Monomials to Bernstein form, degree 3 x 2: u^i v^j has the coefficient C(k,i)/C(3,i) C(l,j)/C(2,j).
  const auto mono = [](int n, int power, int k) {
    double c = 1.0;
    for (int i = 0; i < power; ++i) c *= static_cast<double>(k - i) / (n - i);
    return c;
  };
  BezierPatch patch;
  patch.degree_u = 3;
  patch.degree_v = 2;
  for (int k = 0; k <= 3; ++k) {
    for (int l = 0; l <= 2; ++l) {
      const double u = mono(3, 1, k), uu = mono(3, 2, k), uuu = mono(3, 3, k), v = mono(2, 1, l),
                   vv = mono(2, 2, l);
      patch.points.push_back(
          Vec3(2 * u + 0.1 * u * v, 1.5 * v - 0.2 * uu, 0.8 * uu * v - 0.6 * vv + 0.5 * u - 0.3 * uuu));
    }
  }
  const PatchShape shape = patch;
  return SplitIntoPieces(PatchId(0), shape)[0];
}

class SlopeLinesVector : public ::testing::Test {
 protected:
  const Json data_ = LoadJson(PATCHMILL_SOURCE_DIR "/tests/vectors/slope_lines.json");
  const Piece piece_ = Example();
  const Vec3 axis_ = data_["nf"].Vector();
};

// Directions are parallel to those given, in space.
void ExpectAlong(const SurfaceJet& jet, const Vec3& made, const Json& uv) {
  const Vec3 expected = uv[0].Number() * jet.du + uv[1].Number() * jet.dv;
  EXPECT_LE(made.normalized().cross(expected.normalized()).norm(), 1e-12);
}

TEST_F(SlopeLinesVector, FormsAndFields) {
  ASSERT_EQ(data_["points"].Items().size(), 3u);
  for (const Json& at : data_["points"].Items()) {
    const SurfaceJet jet = Evaluate(piece_, at["u"].Number(), at["v"].Number());
    const Vec3 n = UnitNormal(jet).value();
    EXPECT_LE((n - at["n"].Vector()).norm(), 1e-12);
    const FundamentalForms f = Forms(jet, n);
    const double made[] = {f.E, f.F, f.G, f.L, f.M, f.N};
    const char* const names[] = {"E", "F", "G", "L", "M", "N"};
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(made[k], at[names[k]].Number(), 1e-12) << names[k];
    // [lines (5)], and its use in the gradient of sin sigma.
    const double w2 = f.E * f.G - f.F * f.F;
    const double alpha = (f.M * f.F - f.G * f.L) / w2, beta = (f.L * f.F - f.M * f.E) / w2;
    const double alpha2 = (f.N * f.F - f.M * f.G) / w2, beta2 = (f.M * f.F - f.N * f.E) / w2;
    EXPECT_NEAR(alpha, at["alpha"].Number(), 1e-12);
    EXPECT_NEAR(beta, at["beta"].Number(), 1e-12);
    EXPECT_NEAR(alpha2, at["alpha2"].Number(), 1e-12);
    EXPECT_NEAR(beta2, at["beta2"].Number(), 1e-12);
    const double fu = axis_.dot(jet.du), fv = axis_.dot(jet.dv);
    EXPECT_NEAR(fu, at["phi_u"].Number(), 1e-12);
    EXPECT_NEAR(fv, at["phi_v"].Number(), 1e-12);
    EXPECT_NEAR(alpha * fu + beta * fv, at["psi_u"].Number(), 1e-12);
    EXPECT_NEAR(alpha2 * fu + beta2 * fv, at["psi_v"].Number(), 1e-12);

    EXPECT_NEAR(BrightnessField(0.0, axis_).value(jet), at["sin_sigma"].Number(), 1e-12);
    EXPECT_NEAR(SlopeField(Radians(60), axis_).value(jet), std::abs(at["sin_sigma"].Number()) - 0.5, 1e-12);
    // [lines (8)] is chi_u phi_v - chi_v phi_u = (n_s x n_f) . N.
    const double w = std::sqrt(w2);
    EXPECT_NEAR(-w * HighlightField(axis_, data_["ns"].Vector()).value(jet), at["highlight"].Number(), 1e-12);
    // [lines (10)] is the torsion times W^(1/2) (E phi_v^2 - 2 F phi_u phi_v + G phi_u^2).
    const double rise = f.E * fv * fv - 2 * f.F * fu * fv + f.G * fu * fu;
    EXPECT_NEAR(w * rise * SlopeExtremumField(axis_).value(jet), at["slope_ext"].Number(), 1e-11);

    const Vec3 flow = FlowGradient(jet, {.kind = FlowKind::kAlongHeight, .axis = axis_});
    const Vec3 slope_flow = FlowGradient(jet, {.kind = FlowKind::kAlongSlope, .axis = axis_});
    ExpectAlong(jet, flow, at["flow"]);
    ExpectAlong(jet, n.cross(flow), at["contour"]);
    ExpectAlong(jet, slope_flow, at["equislope_orth"]);
    ExpectAlong(jet, n.cross(slope_flow), at["equislope"]);
  }
}

// Roots on lines v = const; some lie beside the piece, where its polynomial goes on.
TEST_F(SlopeLinesVector, PointsOfLines) {
  const auto root = [&](const ZeroField& field, double u, double v) {
    const Vec2 a(u - 0.01, v), b(u + 0.01, v);
    return a.x() + (b.x() - a.x()) * ZeroBetween(field, piece_,
                                                 {a, b, Value(field, piece_, a), Value(field, piece_, b)},
                                                 1e-15);
  };
  for (const Json& at : data_["slope_extremum_points"].Items())
    EXPECT_NEAR(root(SlopeExtremumField(axis_), at[0].Number(), at[1].Number()), at[0].Number(), 1e-12);
  const ZeroField slope = SlopeField(std::acos(data_["equislope_level"].Number()), axis_);
  for (const Json& at : data_["equislope_points"].Items())
    EXPECT_NEAR(root(slope, at[0].Number(), at[1].Number()), at[0].Number(), 1e-12);
}

TEST_F(SlopeLinesVector, Umbilic) {
  const Json& given = data_["umbilic"];
  const Vec3 axes(given["a"].Number(), given["b"].Number(), given["c"].Number()),
      at = given["point"].Vector();
  // z over (x, y) near it: z^2 = c^2 (1 - x^2/a^2 - y^2/b^2).
  const double px = -axes.z() * axes.z() * at.x() / (axes.x() * axes.x() * at.z());
  SurfaceJet jet;
  jet.p = at;
  jet.du = {1, 0, px};
  jet.dv = {0, 1, 0};
  jet.duu = {0, 0, -(std::pow(axes.z() / axes.x(), 2) + px * px) / at.z()};
  jet.dvv = {0, 0, -std::pow(axes.z() / axes.y(), 2) / at.z()};
  const PrincipalCurvatures k = Principal(Forms(jet, UnitNormal(jet).value()));
  EXPECT_NEAR(-k.k_min, given["kappa"].Number(), 1e-7);  // the root of a difference of rounding
  EXPECT_NEAR(-0.5 * (k.k_min + k.k_max), given["kappa"].Number(), 1e-12);
  for (const Vec3& axis : kAxes) EXPECT_NEAR(SlopeExtremumField(axis).value(jet), 0.0, 1e-12);
}

}  // namespace
}  // namespace patchmill
