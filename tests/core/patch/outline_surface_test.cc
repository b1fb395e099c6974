// Skins and surfaces between boundary curves: what they contain, what they reproduce, what they refuse.
#include "core/patch/outline_surface.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error_details.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

BezierCurve RandomBezier(Random& random, int degree, const Vec3& from, const Vec3& to) {
  BezierCurve curve;
  for (int k = 0; k <= degree; ++k)
    curve.points.push_back(from + (to - from) * k / degree + random.Point(-1, 1));
  curve.points.front() = from;
  curve.points.back() = to;
  return curve;
}

// Mixed kinds and degrees.
std::vector<Curve> Sections(std::uint64_t seed) {
  Random random(seed);
  std::vector<Curve> sections;
  for (int k = 0; k < 6; ++k) {
    const Vec3 from(0, 4 * k + random.Uniform(-1, 1), 0), to(20, 4 * k, 1);
    if (k % 3 == 0) {
      BsplineCurve spline{3, {0, 0, 0, 0, 0.3, 0.5 + 0.05 * k, 1, 1, 1, 1}, {}};
      for (int i = 0; i < 6; ++i) spline.points.push_back(from + (to - from) * i / 5 + random.Point(-1, 1));
      sections.push_back(spline);
    } else {
      sections.push_back(RandomBezier(random, k % 3 == 1 ? 2 : 5, from, to));
    }
  }
  return sections;
}

// The lines v = const on which the sections lie: the knots, each once.
std::vector<double> Lines(const BsplinePatch& patch) {
  std::vector<double> lines = patch.knots_v;
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
  return lines;
}

TEST(SkinSurface, PassesThroughItsSectionsWithContinuousCurvatureAcross) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const std::vector<Curve> sections = Sections(seed);
    const auto skin = SkinSurface(sections);
    ASSERT_TRUE(skin.ok()) << skin.status();
    EXPECT_EQ(skin->degree_u, 5);
    EXPECT_EQ(skin->degree_v, 3);
    const std::vector<double> lines = Lines(*skin);
    ASSERT_EQ(lines.size(), sections.size());
    for (std::size_t k = 0; k < sections.size(); ++k) {
      for (int i = 0; i <= 40; ++i) {
        const double u = i / 40.0;
        EXPECT_LE((Position(*skin, u, lines[k]) - Evaluate(sections[k], u).p).norm(), 1e-12);
      }
    }
    for (std::size_t k = 1; k + 1 < lines.size(); ++k) {
      const SurfaceJet below = Evaluate(*skin, 0.43, std::nextafter(lines[k], 0.0)),
                       above = Evaluate(*skin, 0.43, lines[k]);
      EXPECT_LE((below.dv - above.dv).norm(), 1e-10);
      EXPECT_LE((below.dvv - above.dvv).norm(), 1e-8);
      EXPECT_LE((below.duv - above.duv).norm(), 1e-8);
    }
    EXPECT_LE(Evaluate(*skin, 0.43, 0.0).dvv.norm(), 1e-9);
    EXPECT_LE(Evaluate(*skin, 0.43, 1.0).dvv.norm(), 1e-9);
  }
}

// A curve moved along a line at uneven steps: the extrusion, exactly, in the arc parameter of the line.
TEST(SkinSurface, ReproducesAnExtrusion) {
  Random random(3);
  const BezierCurve curve = RandomBezier(random, 4, Vec3(0, 0, 0), Vec3(10, 0, 0));
  const Vec3 along(1, 5, 2);
  std::vector<Curve> sections;
  for (const double s : {0.0, 0.1, 0.5, 1.0}) {
    BezierCurve moved = curve;
    for (Vec3& p : moved.points) p += s * along;
    sections.push_back(moved);
  }
  const auto skin = SkinSurface(sections);
  ASSERT_TRUE(skin.ok());
  for (const double u : {0.1, 0.6}) {
    for (const double v : {0.03, 0.3, 0.77}) {
      EXPECT_LE((Position(*skin, u, v) - (Evaluate(curve, u).p + v * along)).norm(), 1e-13);
    }
  }
}

BoundaryCurves RandomOutline(std::uint64_t seed) {
  Random random(seed);
  const Vec3 corner[4] = {{0, 0, 1}, {10, 1, 0}, {11, 9, 2}, {-1, 8, 0}};
  BsplineCurve top{
      2, {0, 0, 0, 0.4, 1, 1, 1}, {corner[3], random.Point(2, 5), random.Point(5, 8), corner[2]}};
  return {RandomBezier(random, 3, corner[0], corner[1]), RandomBezier(random, 4, corner[1], corner[2]), top,
          RandomBezier(random, 1, corner[0], corner[3])};
}

TEST(CoonsSurface, IsTheBilinearBlendOfItsBoundary) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const BoundaryCurves outline = RandomOutline(seed);
    const auto coons = CoonsSurface(outline);
    ASSERT_TRUE(coons.ok()) << coons.status();
    const auto at = [&](std::size_t k, double t) { return Evaluate(outline[k], t).p; };
    for (const double u : {0.0, 0.2, 0.4, 0.71, 1.0}) {
      for (const double v : {0.0, 0.33, 0.9, 1.0}) {
        const Vec3 wanted = (1 - v) * at(0, u) + v * at(2, u) + (1 - u) * at(3, v) + u * at(1, v) -
                            ((1 - u) * (1 - v) * at(0, 0) + u * (1 - v) * at(0, 1) + (1 - u) * v * at(2, 0) +
                             u * v * at(2, 1));
        EXPECT_LE((Position(*coons, u, v) - wanted).norm(), 1e-13) << u << " " << v;
      }
    }
  }
}

TEST(HosakaSurface, HasItsBoundaryAndZeroCornerTwists) {
  BoundaryCurves outline = RandomOutline(7);
  EXPECT_FALSE(HosakaSurface(outline).ok());  // two spans
  Random random(7);
  outline[2] = RandomBezier(random, 2, Vec3(-1, 8, 0), Vec3(11, 9, 2));
  const auto surface = HosakaSurface(outline);
  ASSERT_TRUE(surface.ok()) << surface.status();
  for (const double t : {0.0, 0.3, 0.8, 1.0}) {
    EXPECT_LE((Position(*surface, t, 0) - Evaluate(outline[0], t).p).norm(), 1e-13);
    EXPECT_LE((Position(*surface, 1, t) - Evaluate(outline[1], t).p).norm(), 1e-13);
    EXPECT_LE((Position(*surface, t, 1) - Evaluate(outline[2], t).p).norm(), 1e-13);
    EXPECT_LE((Position(*surface, 0, t) - Evaluate(outline[3], t).p).norm(), 1e-13);
  }
  for (const double u : {0.0, 1.0}) {
    for (const double v : {0.0, 1.0}) EXPECT_LE(Evaluate(*surface, u, v).duv.norm(), 1e-12);
  }
}

TEST(OutlineSurface, RefusesWithTheCurve) {
  const auto says = [](const absl::Status& status, const std::string& field, const std::string& text) {
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_EQ(FieldOf(status), field);
    EXPECT_NE(std::string(status.message()).find(text), std::string::npos) << status;
  };
  std::vector<Curve> sections = Sections(1);
  std::get<BezierCurve>(sections[2]).points[1].x() = std::nan("");
  says(SkinSurface(sections).status(), "curves[2]", "has a number that is not finite");
  sections = Sections(1);
  sections[3] = sections[2];
  says(SkinSurface(sections).status(), "curves[3]", "is the same curve as the one before");
  sections.resize(2);
  says(SkinSurface(sections).status(), "curves", "are 2; must be 3 to 1000");
  std::get<BsplineCurve>(sections[0]).knots.pop_back();
  sections.push_back(sections[0]);
  says(SkinSurface(sections).status(), "curves[0]", "knots");
  BoundaryCurves outline = RandomOutline(2);
  std::get<BezierCurve>(outline[1]).points.back() += Vec3(0.01, 0, 0);
  says(CoonsSurface(outline).status(), "curves", "u=1, v=1");
}

}  // namespace
}  // namespace patchmill
