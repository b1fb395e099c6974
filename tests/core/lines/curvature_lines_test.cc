// Lines of curvature against closed forms.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "core/diffgeo/forms.h"
#include "core/diffgeo/principal_directions.h"
#include "core/lines/flow_lines.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

FlowLines Trace(const Surface& surface, double spacing, double tolerance = 1e-3) {
  auto lines = TraceFlowLines(
      surface, {.kind = FlowKind::kAlongCurvature, .spacing = spacing, .tolerance = tolerance}, RunContext());
  EXPECT_TRUE(lines.ok()) << lines.status();
  return *std::move(lines);
}

// The range of a function of places along a line.
template <typename Function>
double Spread(const ZeroCurve& line, const Function& function) {
  double low = kInfinity, high = -kInfinity;
  for (const SurfacePoint& p : line.points) {
    low = std::min(low, function(p.p));
    high = std::max(high, function(p.p));
  }
  return high - low;
}

// The largest distance of the places from the half plane through the z axis and the middle place.
double MeridianSpread(const ZeroCurve& line) {
  const Vec2 across = Xy(line.points[line.points.size() / 2].p).normalized();
  return Spread(line, [&](const Vec3& p) { return Cross(across, Xy(p)); });
}

// A cone with its axis along z, of radius 3 at z = 0 and 9 at z = 8.
PatchModel Cone() {
  const Eigen::Affine3d up(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()));
  PatchModel model = Transformed(Cylinder(Vec3::Zero(), 1.0, 1.0), up);
  for (Patch& patch : model.patches) {
    for (Vec3& p : std::get<BezierPatch>(patch.shape).points) {
      const double share = 0.5 * (p.z() + 1.0), radius = 3.0 + 6.0 * share;
      p = Vec3(radius * p.x(), radius * p.y(), 8.0 * share);
    }
  }
  return model;
}

// The figures of the lines of a surface of revolution about z.
struct Families {
  int meridians = 0, parallels = 0, closed_parallels = 0, others = 0;
  double longest_meridian = 0.0;
};
Families FamiliesOf(const std::vector<ZeroCurve>& lines, double tolerance) {
  Families families;
  for (const ZeroCurve& line : lines) {
    const bool level = Spread(line, [](const Vec3& p) { return p.z(); }) < tolerance &&
                       Spread(line, [](const Vec3& p) { return Xy(p).norm(); }) < tolerance;
    if (level) {
      ++families.parallels;
      families.closed_parallels += line.closed;
    } else if (MeridianSpread(line) < tolerance) {
      ++families.meridians;
      double length = 0.0;
      for (std::size_t i = 1; i < line.points.size(); ++i) {
        length += (line.points[i].p - line.points[i - 1].p).norm();
      }
      families.longest_meridian = std::max(families.longest_meridian, length);
    } else {
      ++families.others;
    }
  }
  return families;
}

// Rulings of full length and closed circles, over all four patches.
TEST(CurvatureLines, OfACylinderAndACone) {
  const Eigen::Affine3d up(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()));
  struct Case {
    PatchModel model;
    double ruling, height;
  };
  for (const auto& [model, ruling, height] :
       {Case{Transformed(Cylinder(Vec3::Zero(), 5.0, 6.0), up), 12.0, 12.0}, Case{Cone(), 10.0, 8.0}}) {
    const Families families = FamiliesOf(Trace(SurfaceOf(model), 1.0).curves, 0.01);
    EXPECT_EQ(families.others, 0);
    EXPECT_GE(families.meridians, 15);  // around the narrow end of the cone: 19 mm
    EXPECT_NEAR(families.longest_meridian, ruling, 0.01);
    EXPECT_EQ(families.closed_parallels, families.parallels);  // none ends at the seams
    EXPECT_GE(families.parallels, height - 2.0);
    EXPECT_LE(families.parallels, 2.0 * ruling + 1.0);  // no two nearer than half the spacing
  }
}

// Circles of both families close over all sixteen patches.
TEST(CurvatureLines, OfATorus) {
  const double major = 12.0, minor = 4.0;
  const std::vector<ZeroCurve> lines = Trace(SurfaceOf(Torus(Vec3::Zero(), major, minor)), 2.0).curves;
  const Families families = FamiliesOf(lines, 0.01);
  EXPECT_EQ(families.others, 0);
  EXPECT_EQ(families.closed_parallels, families.parallels);
  EXPECT_GE(families.parallels, 6);                                             // 25 mm around the tube
  EXPECT_GE(families.meridians, 20);                                            // 50 mm around the inside
  EXPECT_NEAR(families.longest_meridian, 2.0 * kPi * minor, 0.4 * 2.0 + 0.01);  // closed, but for one chord
}

TEST(CurvatureLines, OfAnEllipsoidOfRevolutionAreMeridiansAndParallels) {
  const Eigen::Affine3d longer(Eigen::Scaling(Vec3(1.0, 1.0, 1.6)));
  const Surface surface = SurfaceOf(Transformed(Sphere(Vec3::Zero(), 8.0), longer));
  const Families families = FamiliesOf(Trace(surface, 1.5).curves, 0.02);
  EXPECT_EQ(families.others, 0);
  EXPECT_GE(families.meridians, 20);
  EXPECT_GE(families.parallels, 12);
  EXPECT_EQ(families.closed_parallels, families.parallels);
}

// The lines of curvature of an ellipsoid are its intersections with confocal quadrics: one of the two
// other confocal parameters is the same all along a line. Sum of x_k^2 / (a_k^2 + lambda) = 1.
TEST(CurvatureLines, OfAnEllipsoidLieOnConfocalQuadrics) {
  const Vec3 squares(100.0, 64.0, 36.0);
  const Eigen::Affine3d axes(Eigen::Scaling(Vec3(10.0, 8.0, 6.0)));
  const Surface surface = SurfaceOf(Transformed(Sphere(Vec3::Zero(), 1.0), axes));
  const FlowLines made = Trace(surface, 1.5, 1e-4);
  const auto roots = [&](const Vec3& p) {
    const Vec3 q = p.cwiseProduct(p);
    const double a = squares.x(), b = squares.y(), c = squares.z();
    const double half = 0.5 * (a + b + c - q.sum());
    const double last = a * b + b * c + c * a - q.x() * (b + c) - q.y() * (a + c) - q.z() * (a + b);
    const double root = std::sqrt(std::max(0.0, half * half - last));
    return std::array<double, 2>{-half - root, -half + root};
  };
  // The distance from p, on the quadric of parameter lambda, to that of parameter mu. Quadrics near a focal
  // plane are as far from it as the root of the difference of the parameters, so roots are compared.
  const auto distance = [&](const Vec3& p, double lambda, double mu) {
    const auto root = [&](double x) {
      return std::sqrt((squares + Vec3::Constant(x)).cwiseAbs().minCoeff());
    };
    const double slope = root(lambda) * p.cwiseQuotient(squares + Vec3::Constant(lambda)).norm();
    return std::isfinite(slope) ? slope * std::abs(root(lambda) - root(mu)) : 0.0;
  };
  EXPECT_FALSE(made.all_singular);
  EXPECT_GT(made.curves.size(), 20u);
  std::array<int, 2> of_family{};
  int judged = 0;
  for (const ZeroCurve& line : made.curves) {
    std::array<double, 2> worst{};
    const std::array<double, 2> at = roots(line.points[line.points.size() / 2].p);
    for (const SurfacePoint& p : line.points) {
      const std::array<double, 2> here = roots(p.p);
      for (int k = 0; k < 2; ++k) {
        worst[k] = std::max(worst[k], distance(p.p, here[k], at[k]));
      }
      ++judged;
    }
    EXPECT_LT(std::min(worst[0], worst[1]), 0.01) << worst[0] << " " << worst[1];
    ++of_family[worst[0] < worst[1] ? 0 : 1];
  }
  EXPECT_GT(judged, 1000);
  EXPECT_GT(of_family[0], 8);
  EXPECT_GT(of_family[1], 8);
}

// A patch whose normal is turned over swaps the smaller and the larger curvature. The lines go on.
TEST(CurvatureLines, GoOnWhereNormalsAreTurnedOver) {
  const Eigen::Affine3d up(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()));
  PatchModel model = Transformed(Cylinder(Vec3::Zero(), 5.0, 6.0), up);
  auto& patch = std::get<BezierPatch>(model.patches[1].shape);
  const int row = patch.degree_v + 1;
  for (int j = 0; j < row; ++j) {  // u the other way round
    std::swap(patch.points[static_cast<std::size_t>(j)], patch.points[static_cast<std::size_t>(row + j)]);
    std::swap(patch.weights[static_cast<std::size_t>(j)], patch.weights[static_cast<std::size_t>(row + j)]);
  }
  const Families families = FamiliesOf(Trace(SurfaceOf(model), 1.0).curves, 0.01);
  EXPECT_EQ(families.others, 0);
  EXPECT_GT(families.parallels, 8);
  EXPECT_EQ(families.closed_parallels, families.parallels);
}

// Everywhere within a spacing of a line of either family, away from umbilics.
TEST(CurvatureLines, CoverASurfaceEvenly) {
  const double spacing = 2.0;
  const Surface surface = SurfaceOf(Quadratic(0.02, -0.05, 12.0));
  const FlowLines made = Trace(surface, spacing);
  for (double u = 0.05; u < 1.0; u += 0.1) {
    for (double v = 0.05; v < 1.0; v += 0.1) {
      const SurfaceJet jet = Evaluate(surface, PieceId(0), u, v);
      const auto directions = DirectionsOf(jet, Forms(jet, *UnitNormal(jet)));
      ASSERT_TRUE(directions.has_value());
      std::array<double, 2> nearest{kInfinity, kInfinity};
      for (const ZeroCurve& line : made.curves) {
        for (std::size_t i = 1; i < line.points.size(); ++i) {
          const Vec3 chord = (line.points[i].p - line.points[i - 1].p).normalized();
          const bool max = std::abs(chord.dot(directions->max)) > std::abs(chord.dot(directions->min));
          nearest[max] = std::min(nearest[max], (line.points[i].p - jet.p).norm());
        }
      }
      EXPECT_LT(nearest[0], 1.1 * spacing) << u << " " << v;
      EXPECT_LT(nearest[1], 1.1 * spacing) << u << " " << v;
    }
  }
}

TEST(CurvatureLines, NoneOnPlanesAndSpheres) {
  for (const PatchModel& model : {Plane(5, 2, 0.3), Sphere(Vec3(1, 2, 3), 10.0)}) {
    const FlowLines made = Trace(SurfaceOf(model), 1.0);
    EXPECT_TRUE(made.curves.empty());
    EXPECT_TRUE(made.all_singular);
  }
  EXPECT_FALSE(Trace(SurfaceOf(Cone()), 1.0).all_singular);
}

}  // namespace
}  // namespace patchmill
