// The beam: Okada's energy and equations against the vectors and by identities [fairing, section 2].
#include "core/fairing/beam.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/index.h"
#include "tests/support/json.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Json;
using testing::Random;

std::vector<Vec3> Points(const Json& list) {
  std::vector<Vec3> points;
  for (const Json& p : list.Items()) points.push_back(p.Vector());
  return points;
}

Json Vectors(const char* name) {
  return testing::LoadJson(std::string(PATCHMILL_SOURCE_DIR "/tests/vectors/") + name + ".json");
}

// The curve of a file that gives X, not m.
Beam BeamOf(const std::vector<Vec3>& points, const std::vector<Vec3>& x) {
  Beam beam{points, Chords(points), x};
  for (std::size_t i = 0; i < x.size(); ++i) beam.tangents[i] = x[i] / beam.chords[std::min(i, x.size() - 2)];
  return beam;
}

std::vector<Vec3> RandomPoints(Random& random, int n) {
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) points.push_back(Vec3(2.0 * i, 0, 0) + random.Point(-0.8, 0.8));
  return points;
}

TEST(Beam, EnergyAndGradientsOfTheVectors) {
  const Json data = Vectors("okada_energy");
  const Beam beam = BeamOf(Points(data["P"]), Points(data["X"]));
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(beam.chords[At(i)], data["C"][i].Number(), 1e-14);
  EXPECT_NEAR(Energy(beam), data["V"].Number(), 1e-11);
  for (const Json& g : data["gradients"].Items()) {
    const int i = static_cast<int>(g["i"].Number());
    const std::vector<Vec3>&p = beam.points, &m = beam.tangents;
    const TangentRow t = TangentRowOf(beam, i);
    EXPECT_NEAR(t.k, data["k"][i].Number(), 1e-14);
    const Vec3 off = m[At(i - 1)] + 2.0 * (1.0 + t.k) * m[At(i)] + t.k * m[At(i + 1)] - t.rhs;
    const double c = beam.chords[At(i - 1)];
    EXPECT_LE((4.0 * t.k / (c * c) * off - g["dVdX"].Vector()).norm(), 1e-11) << i;
    const PositionRow r = PositionRowOf(beam, i);
    const Vec3 lhs = 2.0 * r.before * (p[At(i)] - p[At(i - 1)]) + 2.0 * r.after * (p[At(i)] - p[At(i + 1)]);
    EXPECT_LE((12.0 * (lhs - r.rhs) - g["dVdP"].Vector()).norm(), 1e-11) << i;
  }
}

TEST(Beam, EnergyIsTheIntegralOfTheSquaredSecondDerivative) {
  Random random(1);
  const std::vector<Vec3> p = RandomPoints(random, 9);
  Beam beam = FitBeam(p, {}, {});
  for (Vec3& m : beam.tangents) m += random.Point(-0.3, 0.3);
  double sum = 0.0;  // Simpson is exact: the integrand is quadratic
  for (int i = 0; i < 8; ++i) {
    const BeamSegment s = Segment(beam, i);
    sum += (s.Second(0).squaredNorm() + 4 * s.Second(0.5).squaredNorm() + s.Second(1).squaredNorm()) / 6 /
           std::pow(beam.chords[At(i)], 3);
  }
  EXPECT_NEAR(Energy(beam), sum, 1e-13 * sum);
}

TEST(Beam, FitOfTheVectors) {
  const Json data = Vectors("okada_fairing");
  const std::vector<Vec3> p = Points(data["Pin"]);
  const EndTangents ends = FitEndTangents(p, Chords(p), {}, {});
  EXPECT_LE((ends.start * Chords(p).front() - data["X0"].Vector()).norm(), 1e-12 * 25);
  EXPECT_LE((ends.end * Chords(p).back() - data["Xn"].Vector()).norm(), 1e-12 * 25);
  const Beam beam = FitBeam(p, {}, {}), expected = BeamOf(p, Points(data["X_fit"]));
  const std::vector<Vec3> curvatures = ProjectedCurvatures(beam);
  for (int i = 0; i < beam.count(); ++i) {
    EXPECT_LE((beam.tangents[At(i)] - expected.tangents[At(i)]).norm(), 1e-12) << i;
    EXPECT_LE((curvatures[At(i)] - data["curvature_fit"][i].Vector()).norm(), 1e-11) << i;
  }
  const Json& line = data["polyline"];
  EXPECT_EQ(PolylineSteps(Segment(beam, static_cast<int>(line["segment"].Number())), line["tol"].Number()),
            static_cast<int>(line["N"].Number()));
}

TEST(Beam, FitIsSmoothToTheSecondDerivativeAndOfLeastEnergy) {
  Random random(2);
  const std::vector<Vec3> p = RandomPoints(random, 12);
  const Beam beam = FitBeam(p, Vec3(1, 1, 0), Vec3(1, 0, -1));
  EXPECT_LE(beam.tangents.front().cross(Vec3(1, 1, 0)).norm(), 1e-15);
  EXPECT_LE(beam.tangents.back().cross(Vec3(1, 0, -1)).norm(), 1e-15);
  for (int i = 1; i < 11; ++i) {
    const double a = beam.chords[At(i - 1)], b = beam.chords[At(i)];
    EXPECT_LE((Segment(beam, i - 1).Derivative(1) / a - Segment(beam, i).Derivative(0) / b).norm(), 1e-14);
    EXPECT_LE((Segment(beam, i - 1).Second(1) / (a * a) - Segment(beam, i).Second(0) / (b * b)).norm(),
              1e-13);
    for (int axis = 0; axis < 3; ++axis) {
      for (const double step : {-1e-3, 1e-3}) {
        Beam other = beam;
        other.tangents[At(i)][axis] += step;
        EXPECT_GT(Energy(other), Energy(beam));
      }
    }
  }
}

TEST(Beam, EndDirectionOfACircleIsItsTangent) {
  const Vec3 center(1, 2, 3), e1 = Vec3(1, 1, 0).normalized(), e2 = Vec3(1, -1, 1).normalized();
  std::vector<Vec3> p;
  for (const double a : {0.2, 0.9, 1.3}) p.push_back(center + 2.0 * (std::cos(a) * e1 + std::sin(a) * e2));
  const EndTangents ends = FitEndTangents(p, Chords(p), {}, {});
  EXPECT_LE((ends.start.normalized() - (-std::sin(0.2) * e1 + std::cos(0.2) * e2)).norm(), 1e-14);
  EXPECT_LE((ends.end.normalized() - (-std::sin(1.3) * e1 + std::cos(1.3) * e2)).norm(), 1e-14);
}

TEST(Beam, EndsInLineAndTurningBack) {
  const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
  EXPECT_LE((FitEndTangents(line, Chords(line), {}, {}).start - Vec3(1, 0, 0)).norm(), 1e-15);
  EXPECT_LE((FitEndTangents(line, Chords(line), {}, {}).end - Vec3(1, 0, 0)).norm(), 1e-15);
  const std::vector<Vec3> back{{0, 0, 0}, {2, 0, 0}, {0, 0, 0}};  // the third is the first again
  EXPECT_GT(FitEndTangents(back, Chords(back), {}, {}).start.x(), 0.0);
  EXPECT_LT(FitEndTangents(back, Chords(back), {}, {}).end.x(), 0.0);
  const std::vector<Vec3> two{{0, 0, 0}, {0, 2, 0}};
  const Beam beam = FitBeam(two, {}, {});
  EXPECT_LE((Segment(beam, 0).Point(0.25) - Vec3(0, 0.5, 0)).norm(), 1e-15);
}

TEST(Beam, CurvatureOfAParabolaIsExact) {
  // z(x) = x^2 / 2 over even x, its projection on the plane zx alone: the parameter is x, the cubic exact.
  std::vector<Vec3> p, m;
  for (int i = 0; i <= 4; ++i) p.emplace_back(i, 0, 0.5 * i * i), m.emplace_back(1, 0, i);
  const Beam beam{p, {1, 1, 1, 1}, m};
  for (int i = 0; i <= 4; ++i) {
    const Vec3 k = ProjectedCurvatures(beam)[At(i)];
    EXPECT_NEAR(k.z(), -std::pow(1.0 + i * i, -1.5), 1e-15);  // z turns to x: the other way round
    EXPECT_EQ(k.x(), 0.0);
    EXPECT_EQ(k.y(), 0.0);
  }
}

TEST(Beam, PolylineIsWithinToleranceAndHitsTheNodes) {
  Random random(3);
  const Beam beam = FitBeam(RandomPoints(random, 20), {}, {});
  for (const double tolerance : {0.5, 1e-2, 1e-4}) {
    const std::vector<Vec3> line = Polyline(beam, tolerance);
    ASSERT_EQ(static_cast<double>(line.size()), PolylineSize(beam, tolerance));
    std::size_t at = 0;
    for (int i = 0; i < 19; ++i) {
      const BeamSegment s = Segment(beam, i);
      const int steps = PolylineSteps(s, tolerance);
      EXPECT_EQ(line[at], beam.points[At(i)]);
      for (int k = 0; k < steps; ++k, ++at) {
        const Vec3 a = line[at], chord = line[at + 1] - a;
        for (int j = 1; j < 8; ++j) {
          const Vec3 off = s.Point((k + j / 8.0) / steps) - a;
          const double along = std::clamp(off.dot(chord) / chord.squaredNorm(), 0.0, 1.0);
          EXPECT_LE((off - along * chord).norm(), tolerance);
        }
      }
    }
    EXPECT_EQ(line.back(), beam.points.back());
  }
}

}  // namespace
}  // namespace patchmill
