// Lines of every kind on quadrics, where each is the zero of a known function of place: nothing else is
// drawn, and all of it.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/lines/line_fields.h"
#include "core/lines/zero_curves.h"
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

double Distance(const std::vector<ZeroCurve>& curves, const Vec3& p) {
  double nearest = kInfinity;
  for (const ZeroCurve& curve : curves) {
    const std::size_t n = curve.points.size();
    for (std::size_t i = 0; i + 1 < n + (curve.closed ? 1 : 0); ++i) {
      const Vec3 a = curve.points[i].p, along = curve.points[(i + 1) % n].p - a;
      const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (p - a - t * along).norm());
    }
  }
  return nearest;
}

struct Line {
  std::string name;
  ZeroField field;
  std::function<double(const Vec3&)> zero;  // of mm or a pure number, changes its sign on the line
};

// Every point drawn is a zero; every zero found between two of `places` is drawn. How many those were.
int ExpectTheLine(const PatchModel& model, const Line& line, const std::vector<std::pair<Vec3, Vec3>>& edges,
                  const std::function<Vec3(const Vec3&)>& onto) {
  SCOPED_TRACE(line.name);
  const auto curves = Trace(model, line.field);
  for (const ZeroCurve& curve : curves) {
    for (const SurfacePoint& p : curve.points) EXPECT_NEAR(line.zero(p.p), 0.0, 1e-8) << p.p.transpose();
  }
  int found = 0;
  for (auto [a, b] : edges) {
    const bool positive = line.zero(a) > 0.0;
    if (positive == (line.zero(b) > 0.0)) continue;
    for (int i = 0; i < 45; ++i) {
      const Vec3 m = onto(0.5 * (a + b));
      ((line.zero(m) > 0.0) == positive ? a : b) = m;
    }
    EXPECT_LT(Distance(curves, a), 2e-4) << a.transpose();
    ++found;
  }
  return found;
}

constexpr double kHalf = 8.0;

// z = a x^2 + b y^2: n is along (-2 a x, -2 b y, 1).
void ExpectLinesOfQuadratic(double a, double b) {
  SCOPED_TRACE(std::to_string(a) + " " + std::to_string(b));
  const PatchModel model = Quadratic(a, b, kHalf);
  const auto onto = [=](const Vec3& p) { return Vec3(p.x(), p.y(), a * p.x() * p.x() + b * p.y() * p.y()); };
  const auto normal = [=](const Vec3& p) { return Vec3(-2 * a * p.x(), -2 * b * p.y(), 1).normalized(); };
  std::vector<std::pair<Vec3, Vec3>> edges;
  const int n = 41;
  const auto place = [&](int i, int j) {
    return onto(Vec3((2.0 * i / n - 1) * kHalf, (2.0 * j / n - 1) * kHalf, 0));
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= n; ++j) {
      edges.emplace_back(place(i, j), place(i + 1, j));
      edges.emplace_back(place(j, i), place(j, i + 1));
    }
  }
  const Vec3 tilted = Vec3(0.3, 0.2, 0.9).normalized(), eye(3, 30, -4);
  const std::vector<Line> lines = {
      {"contour", ContourField(0.7), [](const Vec3& p) { return p.z() - 0.7; }},
      {"tilted contour", ContourField(0.7, tilted), [=](const Vec3& p) { return tilted.dot(p) - 0.7; }},
      {"slope", SlopeField(Radians(20)),
       [=](const Vec3& p) { return normal(p).z() - std::cos(Radians(20)); }},
      {"tilted slope", SlopeField(Radians(20), tilted),
       [=](const Vec3& p) { return std::abs(normal(p).dot(tilted)) - std::cos(Radians(20)); }},
      {"brightness", BrightnessField(0.9, tilted),
       [=](const Vec3& p) { return normal(p).dot(tilted) - 0.9; }},
      {"silhouette", SilhouetteField(Vec3(0.8, 0.5, 0.1).normalized()),
       [=](const Vec3& p) { return normal(p).dot(Vec3(0.8, 0.5, 0.1).normalized()); }},
      {"eye", EyeSilhouetteField(eye), [=](const Vec3& p) { return (p - eye).dot(normal(p)); }},
      // A section by a plane across y runs along z' = 2 a x; that is 0.3 at x = 0.15 / a.
      {"highlight", HighlightField(Vec3::UnitY(), Vec3(-0.3, 0, 1).normalized()),
       [=](const Vec3& p) { return (2 * a * p.x() - 0.3) / std::sqrt(1.09); }},
  };
  for (const Line& line : lines) EXPECT_GE(ExpectTheLine(model, line, edges, onto), 10);

  // Along the contour, (-b y, a x) in plan, z'' is 2 a b (b y^2 + a x^2): on saddles zero along two lines.
  const Line inflection{"inflection", ContourCurvatureField(),
                        [=](const Vec3& p) { return a * b * (b * p.y() * p.y() + a * p.x() * p.x()); }};
  EXPECT_EQ(ExpectTheLine(model, inflection, edges, onto) > 10, a * b < 0);
  EXPECT_EQ(Trace(model, inflection.field).empty(), a * b >= 0);
  // Extremal slope along the axes, unless all contours are circles or straight.
  const Line extremum{"slope extremum", SlopeExtremumField(),
                      [=](const Vec3& p) { return (a - b) * a * b * p.x() * p.y(); }};
  EXPECT_EQ(ExpectTheLine(model, extremum, edges, onto) > 10, a != b && a * b != 0);
  EXPECT_EQ(Trace(model, extremum.field).empty(), a == b || a * b == 0);
}

TEST(ClosedForms, Paraboloid) { ExpectLinesOfQuadratic(0.05, 0.05); }
TEST(ClosedForms, EllipticParaboloid) { ExpectLinesOfQuadratic(0.05, 0.02); }
TEST(ClosedForms, Saddle) { ExpectLinesOfQuadratic(0.05, -0.03); }
TEST(ClosedForms, Valley) { ExpectLinesOfQuadratic(0.05, 0.0); }

TEST(ClosedForms, Cylinder) {
  const double radius = 5;
  const PatchModel model = Cylinder(Vec3::Zero(), radius, 8);
  const auto onto = [=](const Vec3& p) {
    const Vec3 out(p.x(), 0, p.z());
    return Vec3(radius * out.normalized() + p.y() * Vec3::UnitY());
  };
  const auto normal = [](const Vec3& p) { return Vec3(p.x(), 0, p.z()).normalized(); };
  std::vector<std::pair<Vec3, Vec3>> edges;
  const int n = 60;
  const auto place = [&](int i, int j) {
    const double w = 2 * kPi * (i + 0.3) / n;
    return Vec3(radius * std::cos(w), -8 + 16.0 * j / n, radius * std::sin(w));
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      edges.emplace_back(place(i, j), place(i + 1, j));
      edges.emplace_back(place(i, j), place(i, j + 1));
    }
  }
  const Vec3 tilted = Vec3(0.3, 0.4, 0.8).normalized(), eye(9, 2, 4);
  const std::vector<Line> lines = {
      {"contour", ContourField(2.0), [](const Vec3& p) { return p.z() - 2; }},
      {"tilted contour", ContourField(2.0, tilted), [=](const Vec3& p) { return tilted.dot(p) - 2; }},
      {"slope", SlopeField(Radians(50)),
       [=](const Vec3& p) { return std::abs(normal(p).z()) - std::cos(Radians(50)); }},
      {"brightness", BrightnessField(0.4, tilted),
       [=](const Vec3& p) { return normal(p).dot(tilted) - 0.4; }},
      {"silhouette", SilhouetteField(tilted), [=](const Vec3& p) { return normal(p).dot(tilted); }},
      {"eye", EyeSilhouetteField(eye), [=](const Vec3& p) { return (p - eye).dot(normal(p)); }},
      {"highlight", HighlightField(Vec3::UnitY(), Vec3(0.6, 0, 0.8)),
       [=](const Vec3& p) { return normal(p).dot(Vec3::UnitY().cross(Vec3(0.6, 0, 0.8))); }},
      // The contour runs along the ruling or the circle: the first where n lies in the plane of axis and y.
      {"slope extremum", SlopeExtremumField(tilted),
       [=](const Vec3& p) { return tilted.x() * normal(p).z() - tilted.z() * normal(p).x(); }},
  };
  for (const Line& line : lines) EXPECT_GE(ExpectTheLine(model, line, edges, onto), 10);
  // Ellipses and straight lines have no inflections.
  EXPECT_TRUE(Trace(model, ContourCurvatureField(tilted)).empty());
}

// Where a field vanishes all over a plane there is nothing to draw; where it does not, nothing either.
TEST(ClosedForms, PlanesHaveContoursOnly) {
  const PatchModel plane = Plane(10, 0, 0.3, 0.4),
                   wall = Transformed(Plane(10), [] {
                     return Eigen::Affine3d(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()));
                   }());
  const Vec3 normal = Vec3(-0.3, -0.4, 1).normalized();
  const double slope = std::acos(normal.z());
  for (const ZeroField& field :
       {SlopeField(slope), SlopeField(0.5 * slope), BrightnessField(normal.z(), Vec3::UnitZ()),
        BrightnessField(0.1, Vec3::UnitZ()), SilhouetteField(), SilhouetteField(normal.unitOrthogonal()),
        EyeSilhouetteField(Vec3(0, 0, 0)), EyeSilhouetteField(Vec3(0, 0, 40)),
        HighlightField(Vec3::UnitY(), Vec3(-0.3, 0, 1).normalized()), ContourCurvatureField(),
        SlopeExtremumField()}) {
    EXPECT_TRUE(Trace(plane, field).empty());
    EXPECT_TRUE(Trace(wall, field).empty());
  }
  const auto contour = Trace(plane, ContourField(1.0));
  ASSERT_EQ(contour.size(), 1u);
  for (const SurfacePoint& p : contour[0].points) EXPECT_NEAR(p.p.z(), 1.0, 1e-12);
}

// x^2/9 + y^2/4 + z^2 = 100. With n along D p, D = diag(1/9, 1/4, 1), the torsion along t = f x n vanishes
// with det(n, t, D t); so it does, for every f, in the umbilics.
TEST(ClosedForms, SlopeExtremumLinesOfAnEllipsoidPassItsUmbilics) {
  const Vec3 axes(30, 20, 10);
  Eigen::Affine3d stretch(Eigen::Scaling(axes));
  stretch.rotate(Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()));  // borders off the planes of symmetry
  const PatchModel model = Transformed(Sphere(Vec3::Zero(), 1), stretch);
  const Vec3 squares = axes.cwiseAbs2();
  const double x = 30 * std::sqrt((900.0 - 400) / (900 - 100)),
               z = 10 * std::sqrt((400.0 - 100) / (900 - 100));
  for (const Vec3& f : {Vec3(0.28, 0.36, 0.89).normalized(), Vec3(0.8, -0.1, 0.3).normalized()}) {
    const auto curves = Trace(model, SlopeExtremumField(f));
    ASSERT_FALSE(curves.empty());
    const Vec3 summit = squares.cwiseProduct(f) / std::sqrt(f.dot(squares.cwiseProduct(f)));  // n along f
    for (const ZeroCurve& curve : curves) {
      for (const SurfacePoint& p : curve.points) {
        const Vec3 n = p.p.cwiseQuotient(squares).normalized();
        const Vec3 t = f.cross(n);
        if (t.norm() < 1e-3) continue;
        const Vec3 turned = t.normalized().cwiseQuotient(squares) * 100;
        EXPECT_NEAR(n.dot(t.normalized().cross(turned)), 0.0, 1e-7) << p.p.transpose();
      }
      if (curve.closed) continue;
      for (const SurfacePoint& end : {curve.points.front(), curve.points.back()})
        EXPECT_LT(std::min((end.p - summit).norm(), (end.p + summit).norm()), 1e-6) << end.p.transpose();
    }
    for (const Vec3& umbilic : {Vec3(x, 0, z), Vec3(-x, 0, z), Vec3(x, 0, -z), Vec3(-x, 0, -z)})
      EXPECT_LT(Distance(curves, umbilic), 2e-4) << umbilic.transpose();
  }
}

}  // namespace
}  // namespace patchmill
