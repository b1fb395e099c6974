// Vectors of [shapes, section 9] and of ball centres: curvatures and ball centres on a patch of bidegree
// (4,2).
#include <cmath>

#include <gtest/gtest.h>

#include "core/diffgeo/forms.h"
#include "core/math/bernstein.h"
#include "tests/support/eigen_matchers.h"
#include "tests/support/json.h"

namespace patchmill {
namespace {

using testing::IsNear;
using testing::Json;

constexpr double kTolerance = 1e-12;

// z = (0.35 a - 3 a^2 + 0.05)(1 - 4 b), a = (u-1/2)^2, b = (v-1/2)^2, x = u, y = v.
PatchShape InflectionSurface() {
  const std::vector<double> square = {0.25, -0.25, 0.25};  // (t-1/2)^2
  const auto fourth = BernsteinProduct(square, square);
  const auto second = BernsteinElevate(BernsteinElevate(square));
  BezierPatch patch;
  patch.degree_u = 4;
  patch.degree_v = 2;
  for (int i = 0; i <= 4; ++i) {
    for (int j = 0; j <= 2; ++j) {
      patch.points.emplace_back(i / 4.0, j / 2.0,
                                (0.35 * second[i] - 3 * fourth[i] + 0.05) * (1 - 4 * square[j]));
    }
  }
  return patch;
}

TEST(ContourInflection, PointsOfTheFile) {
  const Json data = testing::LoadJson(PATCHMILL_SOURCE_DIR "/tests/vectors/contour_inflection.json");
  const PatchShape surface = InflectionSurface();
  ASSERT_GE(data["points"].Items().size(), 4u);
  for (const Json& at : data["points"].Items()) {
    const SurfaceJet s = Evaluate(surface, at["u"].Number(), at["v"].Number());
    EXPECT_THAT(s.p, IsNear(at["S"].Vector(), kTolerance)) << "S";
    EXPECT_THAT(s.du, IsNear(at["Su"].Vector(), kTolerance)) << "Su";
    EXPECT_THAT(s.dv, IsNear(at["Sv"].Vector(), kTolerance)) << "Sv";
    EXPECT_THAT(s.duu, IsNear(at["Suu"].Vector(), kTolerance)) << "Suu";
    EXPECT_THAT(s.duv, IsNear(at["Suv"].Vector(), kTolerance)) << "Suv";
    EXPECT_THAT(s.dvv, IsNear(at["Svv"].Vector(), kTolerance)) << "Svv";
    const Vec3 normal = UpwardNormal(s).value();
    EXPECT_THAT(normal, IsNear(at["e"].Vector(), kTolerance)) << "e";
    const FundamentalForms f = Forms(s, normal);
    EXPECT_NEAR(f.E, at["E"].Number(), kTolerance);
    EXPECT_NEAR(f.F, at["F"].Number(), kTolerance);
    EXPECT_NEAR(f.G, at["G"].Number(), kTolerance);
    EXPECT_NEAR(f.L, at["L"].Number(), kTolerance);
    EXPECT_NEAR(f.M, at["M"].Number(), kTolerance);
    EXPECT_NEAR(f.N, at["N"].Number(), kTolerance);
    const PrincipalCurvatures k = Principal(f);
    EXPECT_NEAR(k.k_min, at["kmin"].Number(), kTolerance);
    EXPECT_NEAR(k.k_max, at["kmax"].Number(), kTolerance);
    EXPECT_NEAR(k.k_min * k.k_max, at["K"].Number(), kTolerance);
    EXPECT_NEAR(0.5 * (k.k_min + k.k_max), at["H"].Number(), kTolerance);
    EXPECT_NEAR(ContourDeterminant(s, f), at["D"].Number(), kTolerance);
    EXPECT_NEAR(ContourCurvature(s, f), at["kappa_contour_dir"].Number(), kTolerance);
    EXPECT_NEAR(NormalCurvature(f, -s.dv.z(), s.du.z()), at["kappa_contour_dir"].Number(), kTolerance);
    EXPECT_NEAR(NormalCurvature(f, s, Vec3::UnitZ().cross(normal)), at["kappa_contour_dir"].Number(),
                kTolerance);
  }
}

TEST(ContourInflection, SignsAndZeros) {
  const Json data = testing::LoadJson(PATCHMILL_SOURCE_DIR "/tests/vectors/contour_inflection.json");
  const PatchShape surface = InflectionSurface();
  const auto contour = [&](double u, double v) {
    const SurfaceJet s = Evaluate(surface, u, v);
    return ContourDeterminant(s, Forms(s, UpwardNormal(s).value()));
  };
  for (int j = 0; j < 12; ++j) {
    for (int i = 0; i < 12; ++i) {
      EXPECT_GT(contour((i + 0.5) / 12, (j + 0.5) / 12) * data["sign_grid"][j][i].Number(), 0.0);
    }
  }
  ASSERT_FALSE(data["zeros"].Items().empty());
  for (const Json& zero : data["zeros"].Items())
    EXPECT_NEAR(contour(zero[0].Number(), zero[1].Number()), 0, 1e-12);
  const auto at = [&](const char* key) {
    return Evaluate(surface, data[key][0].Number(), data[key][1].Number());
  };
  for (const char* const key : {"summit", "saddle"}) {
    EXPECT_NEAR(at(key).du.z(), 0.0, kTolerance) << key;
    EXPECT_NEAR(at(key).dv.z(), 0.0, kTolerance) << key;
  }
  EXPECT_LT(at("summit").duu.z(), 0.0);
  EXPECT_GT(at("summit").duu.z() * at("summit").dvv.z(), std::pow(at("summit").duv.z(), 2));
  const SurfaceJet saddle = at("saddle");
  EXPECT_NEAR(saddle.duu.z(), data["saddle_hessian"][0][0].Number(), kTolerance);
  EXPECT_NEAR(saddle.duv.z(), data["saddle_hessian"][0][1].Number(), kTolerance);
  EXPECT_NEAR(saddle.dvv.z(), data["saddle_hessian"][1][1].Number(), kTolerance);
  EXPECT_EQ(ContourCurvature(saddle, Forms(saddle, UnitNormal(saddle).value())), 0.0);
}

TEST(ToolpathOffset, ContactNormalAndBallCentre) {
  const Json data = testing::LoadJson(PATCHMILL_SOURCE_DIR "/tests/vectors/toolpath_offset.json");
  const PatchShape surface = InflectionSurface();
  const double radius = data["R"].Number();
  for (const Json& at : data["points"].Items()) {
    const SurfaceJet s = Evaluate(surface, at["u"].Number(), at["v"].Number());
    const Vec3 e = UpwardNormal(s).value();
    EXPECT_THAT(s.p, IsNear(at["contact"].Vector(), kTolerance)) << "contact";
    EXPECT_THAT(s.p + radius * e, IsNear(at["center"].Vector(), kTolerance)) << "center";
    EXPECT_THAT(s.p + radius * (e - Vec3::UnitZ()), IsNear(at["tip"].Vector(), kTolerance)) << "tip";
    EXPECT_NEAR(Degrees(std::acos(e.z())), at["slope_deg"].Number(), 1e-10);
    const FundamentalForms f = Forms(s, e);
    EXPECT_EQ(Principal(f).k_max <= 1 / radius, at["gouge_free"].Bool());
    // Weingarten: e_u = alpha S_u + beta S_v with (E F; F G)(alpha, beta) = -(L, M).
    const double w2 = f.E * f.G - f.F * f.F;
    const double alpha = (f.F * f.M - f.G * f.L) / w2, beta = (f.F * f.L - f.E * f.M) / w2;
    EXPECT_THAT(s.du + radius * (alpha * s.du + beta * s.dv), IsNear(at["center_u"].Vector(), kTolerance))
        << "center_u";
  }
}

}  // namespace
}  // namespace patchmill
