// Flow lines of known shapes: where they run, where they end, how they are spread.
#include "core/lines/flow_lines.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/diffgeo/forms.h"
#include "tests/support/files.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

std::vector<ZeroCurve> Trace(const Surface& surface, const FlowParams& params) {
  auto lines = TraceFlowLines(surface, params, RunContext());
  EXPECT_TRUE(lines.ok()) << lines.status();
  return std::move(lines->curves);
}

TEST(FlowLines, StraightDownATiltedPlane) {
  const Surface surface = SurfaceOf(Plane(10, 0, 0.3, 0.4));
  const auto lines = Trace(surface, {.spacing = 2.0});
  EXPECT_GE(lines.size(), 10u);  // 24 mm across the flow at most
  const Vec2 up = Vec2(0.3, 0.4).normalized();
  for (const ZeroCurve& line : lines) {
    const Vec2 first = Xy(line.points.front().p), last = Xy(line.points.back().p);
    EXPECT_GT((last - first).dot(up), 0.0);
    for (const SurfacePoint& p : line.points) EXPECT_NEAR(Cross(up, Xy(p.p) - first), 0.0, 1e-9);
  }
}

// z = a x^2 + b y^2: y^a = C x^b along each line.
TEST(FlowLines, OfAnEllipticParaboloid) {
  const double a = 0.02, b = 0.05;
  const auto height = [&](double x, double y) { return a * x * x + b * y * y; };
  const PatchModel spans = Single(InterpolatedHeights(height, -12, 12, -12, 12, 5, 7));  // exact: 35 pieces
  for (const PatchModel& model : {Quadratic(a, b, 12), spans}) {
    const Surface surface = SurfaceOf(model);
    const auto lines = Trace(surface, {.spacing = 1.5, .tolerance = 1e-4});
    EXPECT_GT(lines.size(), 20u);
    int judged = 0;
    for (const ZeroCurve& line : lines) {
      const Vec3 end = line.points.back().p;  // out at the border: far from both axes, or on one
      if (std::min(std::abs(end.x()), std::abs(end.y())) < 1.0) continue;
      const double c = a * std::log(std::abs(end.y())) - b * std::log(std::abs(end.x()));
      for (const SurfacePoint& p : line.points) {
        const double x = std::abs(p.p.x()), y = std::abs(p.p.y());
        if (std::min(x, y) < 0.5) continue;
        EXPECT_NEAR(a * std::log(y) - b * std::log(x), c, 1e-4);
        ++judged;
      }
    }
    EXPECT_GT(judged, 200);
  }
}

// Meridians, from pole to pole, over all eight patches.
TEST(FlowLines, OfASphereAreMeridians) {
  const double r = 10;
  const Surface surface = SurfaceOf(Sphere(Vec3::Zero(), r));
  for (const FlowKind kind : {FlowKind::kAlongHeight, FlowKind::kAlongSlope}) {
    const auto lines = Trace(surface, {.kind = kind, .spacing = 2.0, .tolerance = 1e-4});
    double longest = 0.0;
    for (const ZeroCurve& line : lines) {
      double length = 0.0;
      const Vec2 first = Xy(line.points[line.points.size() / 2].p).normalized();
      for (std::size_t i = 0; i < line.points.size(); ++i) {
        const Vec3& p = line.points[i].p;
        EXPECT_NEAR(p.norm(), r, 1e-9);
        EXPECT_NEAR(Cross(first, Xy(p)), 0.0, 0.003);
        if (i == 0) continue;
        length += (p - line.points[i - 1].p).norm();
        // Height grows along the flow; so does |n_z|, away from the equator.
        const double grown = kind == FlowKind::kAlongHeight
                                 ? p.z() - line.points[i - 1].p.z()
                                 : std::abs(p.z()) - std::abs(line.points[i - 1].p.z());
        EXPECT_GT(grown, 0.0);
      }
      longest = std::max(longest, length);
    }
    EXPECT_GT(longest, (kind == FlowKind::kAlongHeight ? 0.9 : 0.4) * kPi * r);
  }
}

TEST(FlowLines, AreSpreadEvenly) {
  const double spacing = 1.5;
  const Surface surface = SurfaceOf(TwoSpheres(10, 12));
  const auto lines = Trace(surface, {.spacing = spacing});
  Random random(3);
  int open = 0;
  for (int i = 0; i < 400; ++i) {
    const PieceId piece(
        static_cast<std::int32_t>(random.Uniform(0, 1) * static_cast<double>(surface.pieces.size())));
    const SurfaceJet jet = Evaluate(surface, piece, random.Uniform(0, 1), random.Uniform(0, 1));
    const auto normal = UnitNormal(jet);
    if (!normal || std::abs(normal->z()) > 0.99) continue;  // around the summits they end
    double nearest = kInfinity;
    for (const ZeroCurve& line : lines) {
      for (const SurfacePoint& p : line.points) nearest = std::min(nearest, (p.p - jet.p).norm());
    }
    open += nearest > 1.1 * spacing;
  }
  EXPECT_EQ(open, 0);
  // No two beside each other nearer than half the spacing.
  for (std::size_t k = 0; k < lines.size(); ++k) {
    for (std::size_t l = 0; l < k; ++l) {
      double nearest = kInfinity;
      for (const SurfacePoint& p : lines[k].points) {
        for (const SurfacePoint& q : lines[l].points) {
          const bool same_sheet =
              UnitNormal(Evaluate(surface, p.piece, p.u, p.v))
                  .value_or(Vec3::Zero())
                  .dot(UnitNormal(Evaluate(surface, q.piece, q.u, q.v)).value_or(Vec3::Zero())) > 0;
          if (same_sheet) nearest = std::min(nearest, (p.p - q.p).norm());
        }
      }
      EXPECT_GT(nearest, 0.45 * spacing) << k << " " << l;
    }
  }
}

// Gradient lines: what they follow grows all along them, so none closes, on any surface: as many loops as a
// sign grid could find, none. Each runs along [lines (3), (7)], and ends where there is no gradient, at a
// border, or beside another line.
TEST(FlowLines, OfATorusAndTheTeapotHaveNoLoops) {
  Eigen::Affine3d up(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()));
  up.scale(10.0);
  for (const PatchModel& model :
       {Torus(Vec3::Zero(), 20, 6), Transformed(LoadModel("examples/teapot.bpt"), up)}) {
    const Surface surface = SurfaceOf(model);
    const Vec3 f(0, 0, 1);
    for (const FlowKind kind : {FlowKind::kAlongHeight, FlowKind::kAlongSlope}) {
      const auto lines = Trace(surface, {.kind = kind, .spacing = 1.5, .tolerance = 1e-4});
      EXPECT_GT(lines.size(), 10u);
      std::size_t judged = 0, sharp = 0;
      for (const ZeroCurve& line : lines) {
        EXPECT_FALSE(line.closed);
        for (std::size_t i = 1; i < line.points.size(); ++i) {
          const SurfacePoint &a = line.points[i - 1], &b = line.points[i];
          if (a.piece != b.piece || (b.p - a.p).norm() < 1e-6) continue;  // slopes jump at creases
          const SurfaceJet from = Evaluate(surface, a.piece, a.u, a.v),
                           to = Evaluate(surface, b.piece, b.u, b.v);
          const auto n = UnitNormal(from), m = UnitNormal(to);
          if (!n || !m) continue;
          const double grown =
              kind == FlowKind::kAlongHeight ? f.dot(b.p - a.p) : std::abs(f.dot(*m)) - std::abs(f.dot(*n));
          EXPECT_GE(grown, -1e-6) << i << " of " << line.points.size();
          // The direction of [lines (3), (7)] in space, from the forms, and the chord to the next point.
          const FundamentalForms forms = Forms(from, *n);
          const double E = forms.E, F = forms.F, G = forms.G, L = forms.L, M = forms.M, N = forms.N;
          double gu = f.dot(from.du), gv = f.dot(from.dv);
          if (kind == FlowKind::kAlongSlope) {
            const double w = E * G - F * F, u = gu, v = gv;
            gu = ((M * F - L * G) * u + (L * F - M * E) * v) / w;
            gv = ((N * F - M * G) * u + (M * F - N * E) * v) / w;
          }
          // (gv E - gu F) du + (gv F - gu G) dv = 0
          const Vec3 along = (gu * G - gv * F) * from.du + (gv * E - gu * F) * from.dv;
          const Vec3 chord = b.p - a.p;
          const double step = chord.norm(), bend = step + 2e-4 / step;  // turns of 2/mm; the tolerance, twice
          if (along.norm() < 1e-3 * from.du.norm() * from.dv.norm() || step < 0.02 || step > 0.3) continue;
          const double sine = along.normalized().cross(chord.normalized()).norm();
          EXPECT_LE(sine, 0.5);
          sharp += sine > bend;  // the line itself bends more, beside a summit
          ++judged;
        }
      }
      EXPECT_GT(judged, 100u);
      EXPECT_LE(10 * sharp, judged);
    }
  }
}

TEST(FlowLines, NothingOnFlatSurfaceAndBadSpacingIsRefused) {
  EXPECT_TRUE(Trace(SurfaceOf(Plane(5, 2)), {}).empty());
  EXPECT_FALSE(TraceFlowLines(SurfaceOf(Plane(5)), {.spacing = 0.0}, RunContext()).ok());
  RunContext run;
  run.Cancel();
  EXPECT_EQ(TraceFlowLines(SurfaceOf(Plane(5, 0, 0.3)), {}, run).status().code(),
            absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
