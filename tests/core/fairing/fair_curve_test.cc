// Fairing of curves: the vectors of [fairing, section 4], what must not move, and what fairing is for.
#include "core/fairing/fair_curve.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/index.h"
#include "core/fairing/box_minimum.h"
#include "tests/support/files.h"
#include "tests/support/json.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;
using testing::Json;
using testing::Random;

const Json& Data() {
  static const Json data = testing::LoadJson(PATCHMILL_SOURCE_DIR "/tests/vectors/okada_fairing.json");
  return data;
}

std::vector<Vec3> Points(const Json& list) {
  std::vector<Vec3> points;
  for (const Json& p : list.Items()) points.push_back(p.Vector());
  return points;
}

FairedCurve Fair(const CurveFairing& curve) {
  absl::StatusOr<FairedCurve> faired = FairCurve(curve);
  EXPECT_TRUE(faired.ok()) << faired.status();
  return *faired;
}

double Farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  EXPECT_EQ(a.size(), b.size());
  double farthest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) farthest = std::max(farthest, (a[i] - b[i]).norm());
  return farthest;
}

double Length(const std::vector<Vec3>& vectors) {
  double longest = 0.0;
  for (const Vec3& v : vectors) longest = std::max(longest, v.norm());
  return longest;
}

// A sine with noise, even in x.
CurveFairing Noisy(int n, double noise, std::uint64_t seed) {
  CurveFairing curve;
  Random random(seed);
  for (int i = 0; i < n; ++i) {
    const double x = 100.0 * i / (n - 1);
    curve.points.push_back(Vec3(x, 30 * std::sin(x / 20), 10 * std::cos(x / 30)) +
                           noise * random.Point(-1, 1));
  }
  return curve;
}

CurveFairing LockedRun() {
  CurveFairing curve;
  curve.points = Points(Data()["Pin"]);
  for (const Json& lock : Data()["locked"]["lock"].Items()) {
    curve.terms.locks.push_back({static_cast<int>(lock.Number()), {true, true, true}});
  }
  return curve;
}

constexpr double kIterated = 1e-9;  // tests/vectors/README.md: iterated results

TEST(FairCurve, LockedRunOfTheVectors) {
  const Json& run = Data()["locked"];
  CurveFairing curve = LockedRun();
  const FairedCurve faired = Fair(curve);
  EXPECT_TRUE(faired.settled);
  ASSERT_EQ(faired.iterations(), static_cast<int>(run["iterations"].Number()));
  for (int i = 0; i <= faired.iterations(); ++i) {
    EXPECT_NEAR(faired.energies[At(i)], run["energies"][i].Number(), kIterated);
  }
  EXPECT_LE(Farthest(faired.after.points, Points(run["P"])), kIterated);
  const CurvatureSigns signs = SignsOf(ProjectedCurvatures(faired.after), Diagonal(curve.points));
  for (int i = 0; i < 11; ++i) {
    const double c = faired.after.chords[At(std::min(i, 9))];
    EXPECT_LE((c * faired.after.tangents[At(i)] - run["X"][i].Vector()).norm(), kIterated);
    for (int plane = 0; plane < 3; ++plane) {
      EXPECT_EQ(signs[At(i)][At(plane)], static_cast<int>(run["signs"][i][plane].Number()));
    }
  }
  curve.terms.max_iterations = 1;
  EXPECT_LE(Farthest(Fair(curve).after.points, Points(run["first"])), kIterated);
  for (const int i : {0, 2, 5, 7, 10}) EXPECT_EQ(faired.after.points[At(i)], curve.points[At(i)]);
}

TEST(FairCurve, BandRunOfTheVectors) {
  const Json& run = Data()["band"];
  CurveFairing curve;
  curve.points = Points(Data()["Pin"]);
  curve.terms.axes = {false, true, true};
  curve.terms.band = run["band"].Vector();
  curve.terms.stop = FairingStop::kIterations;
  curve.terms.max_iterations = 4;
  curve.terms.band_rule = BandRule::kCut;
  const FairedCurve faired = Fair(curve);
  EXPECT_FALSE(faired.settled);
  ASSERT_EQ(faired.iterations(), 4);
  for (int i = 0; i <= 4; ++i) {
    EXPECT_NEAR(faired.energies[At(i)], run["energies"][i].Number(), kIterated);
  }
  EXPECT_LE(Farthest(faired.after.points, Points(run["P"])), kIterated);
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    EXPECT_EQ(faired.after.points[i].x(), curve.points[i].x());
  }
}

TEST(FairCurve, NoIterationsIsTheFit) {
  CurveFairing curve = Noisy(30, 0.1, 1);
  curve.terms.max_iterations = 0;
  const FairedCurve faired = Fair(curve);
  EXPECT_EQ(faired.after.points, curve.points);
  EXPECT_EQ(faired.iterations(), 0);
  EXPECT_EQ(Length(faired.moved), 0.0);
}

TEST(FairCurve, AStraightLineStays) {
  Random random(4);
  CurveFairing curve;
  const Vec3 direction = Vec3(3, -1, 2).normalized();
  for (double s = 0; s < 100; s += random.Uniform(0.2, 5)) {
    curve.points.push_back(Vec3(1000, 2000, -500) + s * direction);
  }
  curve.terms.stop = FairingStop::kIterations;
  curve.terms.max_iterations = 20;
  const FairedCurve faired = Fair(curve);
  EXPECT_LE(Length(faired.moved), 1e-10);  // rounding of 2000 mm, summed along the line
  EXPECT_LE(faired.energies.front(), 1e-15);
}

TEST(FairCurve, AFairArcStays) {
  // 60 degrees of radius r. Only the ends are not fair: the parabola's length of the end tangent is wrong by
  // (c/r)^2 of itself (c: chord), which pulls the next point by a share of c^3 / r^2.
  const double r = 50;
  for (const int n : {20, 40, 80}) {
    CurveFairing curve;
    for (int i = 0; i <= n; ++i) {
      const double a = kPi / 3 * i / n;
      curve.points.emplace_back(r * std::cos(a), r * std::sin(a), 0);
    }
    const FairedCurve faired = Fair(curve);
    EXPECT_TRUE(faired.settled);
    EXPECT_EQ(faired.iterations(), 1);  // no sign changes
    const double c = faired.before.chords[0];
    EXPECT_LE(Length(faired.moved), c * c * c / (r * r));
    EXPECT_NEAR(faired.energies.front() * r * 3 / kPi, 1.0, c * c / (r * r));  // the integral of 1/r^2
  }
}

TEST(FairCurve, NoiseGoesAwayAndTheShapeStays) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const CurveFairing noisy = Noisy(101, 0.1, seed), clean = Noisy(101, 0.0, seed);
    const FairedCurve faired = Fair(noisy);
    const double clean_energy = Fair(clean).energies.front();
    for (std::size_t k = 1; k < faired.energies.size(); ++k) {
      EXPECT_LT(faired.energies[k], faired.energies[k - 1]);
    }
    EXPECT_GT(faired.energies.front(), 5 * clean_energy);
    EXPECT_LT(faired.energies.back(), 1.5 * clean_energy);
    EXPECT_LE(Length(faired.moved), 0.5);
  }
}

TEST(FairCurve, BandsAndLocksHoldComponentByComponent) {
  CurveFairing curve = Noisy(60, 0.5, 7);
  curve.terms.band = {0.3, 0.2, 0.1};
  curve.terms.locks = {{10, {false, true, false}}, {20, {true, false, true}}, {30, {true, true, true}}};
  curve.terms.stop = FairingStop::kIterations;
  curve.terms.max_iterations = 30;
  const FairedCurve faired = Fair(curve);
  int at_limit = 0;
  for (std::size_t i = 0; i < 60; ++i) {
    for (int a = 0; a < 3; ++a) {
      EXPECT_LE(std::abs(faired.moved[i][a]), curve.terms.band[a] * (1 + 1e-14) + 1e-14);
      if (std::abs(faired.moved[i][a]) >= curve.terms.band[a] * (1 - 1e-12)) ++at_limit;
    }
  }
  EXPECT_GT(at_limit, 10);  // the bands are what held
  EXPECT_EQ(faired.moved[10].y(), 0.0);
  EXPECT_NE(faired.moved[10].x(), 0.0);
  EXPECT_EQ(faired.moved[20].x(), 0.0);
  EXPECT_NE(faired.moved[20].y(), 0.0);
  EXPECT_EQ(faired.moved[20].z(), 0.0);
  EXPECT_EQ(Length({faired.moved[0], faired.moved[30], faired.moved[59]}), 0.0);
}

// Numbers x y after the first line.
std::vector<Vec3> PointsOf(const std::string& text) {
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);
  std::vector<Vec3> points;
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    double x = 0, y = 0;
    if (numbers >> x >> y) points.emplace_back(x, y, 0);
  }
  return points;
}

// Points nearer to the one before than three times the noise tell nothing; the noise would turn them round.
std::vector<Vec3> WellSpaced(const std::vector<Vec3>& points) {
  std::vector<Vec3> kept = {points.front()};
  for (const Vec3& p : points) {
    if ((p - kept.back()).norm() > 0.003 * Diagonal(points)) kept.push_back(p);
  }
  return kept;
}

// With 0.1 % of noise, free and in bands of 0.2 and 0.1 %: the energy falls, the locked point stays, bands
// hold.
void ExpectFaired(const std::string& name, const std::vector<Vec3>& points) {
  SCOPED_TRACE(name);
  for (const double band : {kInfinity, 0.002, 0.001}) {
    CurveFairing curve;
    curve.points = points;
    const double diagonal = Diagonal(curve.points);
    Random random(5);
    for (Vec3& p : curve.points) p += 0.001 * diagonal * Lift(Xy(random.Point(-1, 1)), 0);
    const int locked = static_cast<int>(curve.points.size() / 2);
    curve.terms.locks = {{locked, {true, true, true}}};
    curve.terms.band.setConstant(band * diagonal);
    for (const FairingStop stop : {FairingStop::kSigns, FairingStop::kSignsAndEnergy}) {
      curve.terms.stop = stop;
      const FairedCurve faired = Fair(curve);
      ASSERT_GE(faired.iterations(), 1);
      for (int k = 1; k <= faired.iterations(); ++k)
        EXPECT_LT(faired.energies[At(k)], faired.energies[At(k - 1)]);
      EXPECT_EQ(faired.moved[At(locked)].norm(), 0.0);
      for (const Vec3& moved : faired.moved)
        EXPECT_LE(moved.cwiseAbs().maxCoeff(), band * diagonal * (1 + 1e-12));
    }
  }
}

TEST(FairCurve, AirfoilsAndAHullLineWithNoise) {
  for (const char* name : {"clarky.dat", "fx63143.dat", "goe387.dat", "gunnerus_waterline.csv"}) {
    const std::vector<Vec3> points =
        PointsOf(testing::ReadRepositoryFile(std::string("tests/models/curves/") + name));
    ASSERT_GE(points.size(), 30u) << name;
    ExpectFaired(name, points);
  }
}

TEST(FairCurve, AllAirfoilsAndWaterlinesAtHandWithNoise) {
  if (!testing::ReadSharedFile("data/curves/airfoils/clarky.dat")) GTEST_SKIP() << "no shared data";
  for (const char* name :
       {"clarky", "clarkysm", "fx63137", "fx63143", "goe387", "naca4412", "rae2822", "rhodesg34", "s1223"}) {
    const std::string path = std::string("data/curves/airfoils/") + name + ".dat";
    ExpectFaired(name, WellSpaced(PointsOf(testing::ReadSharedFile(path).value_or(""))));
  }
  int lines = 0;
  for (const char* name : {"PX121", "gunnerus"}) {
    const std::string path = std::string("data/curves/hulls/") + name + ".json";
    const testing::Json ship = testing::ParseJson(testing::ReadSharedFile(path).value_or(""));
    const testing::Json &hull = ship["structure"]["hull"], &offsets = hull["halfBreadths"];
    const double length = hull["attributes"]["LOA"].Number(), half = 0.5 * hull["attributes"]["BOA"].Number();
    for (const testing::Json& row : offsets["table"].Items()) {
      std::vector<Vec3> points;
      for (std::size_t k = 0; k < row.Items().size(); ++k) {
        const testing::Json& breadth = row.Items()[k];  // null outside the hull
        if (const double* b = std::get_if<double>(&breadth.value))
          points.emplace_back(length * offsets["stations"].Items()[k].Number(), half * *b, 0);
      }
      if (points.size() < 5) continue;
      ExpectFaired(std::string(name) + " waterline " + std::to_string(lines++), points);
    }
  }
  EXPECT_GE(lines, 20);
}

TEST(FairCurve, LeastEnergyInTheBandsBeatsCuttingBack) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    CurveFairing curve = Noisy(150, 0.1, seed);
    curve.terms.band.setConstant(0.1);
    const double least = Fair(curve).energies.back();
    curve.terms.band_rule = BandRule::kCut;
    EXPECT_LT(least, 0.5 * Fair(curve).energies.back());
  }
}

TEST(FairCurve, MirrorAndReversalGiveTheMirroredAndReversedCurve) {
  const CurveFairing curve = Noisy(40, 0.3, 8);
  CurveFairing mirrored = curve, reversed = curve;
  for (Vec3& p : mirrored.points) p.y() = -p.y();
  std::reverse(reversed.points.begin(), reversed.points.end());
  std::vector<Vec3> a = Fair(curve).after.points;
  const std::vector<Vec3> b = Fair(mirrored).after.points, c = Fair(reversed).after.points;
  EXPECT_LE(Farthest({a.rbegin(), a.rend()}, c), 1e-10);
  for (Vec3& p : a) p.y() = -p.y();
  EXPECT_EQ(Farthest(a, b), 0.0);
}

TEST(FairCurve, SymmetricInputGivesASymmetricCurve) {
  CurveFairing curve;
  Random random(9);
  std::vector<Vec3> half;
  for (int i = 1; i <= 20; ++i) half.push_back(Vec3(3 * i, 20 - 0.05 * i * i, i) + random.Point(-0.3, 0.3));
  const auto mirror = [](const Vec3& p) { return Vec3(-p.x(), p.y(), p.z()); };
  for (auto p = half.rbegin(); p != half.rend(); ++p) curve.points.push_back(mirror(*p));
  curve.points.emplace_back(0, 20.2, 0.1);
  curve.points.insert(curve.points.end(), half.begin(), half.end());
  const std::vector<Vec3> faired = Fair(curve).after.points;
  for (std::size_t i = 0; i < faired.size(); ++i) {
    EXPECT_LE((mirror(faired[i]) - faired[faired.size() - 1 - i]).norm(), 1e-10);
  }
}

TEST(FairCurve, ScaleAndShiftGoThrough) {
  const CurveFairing curve = Noisy(50, 0.2, 10);
  CurveFairing moved = curve;
  for (Vec3& p : moved.points) p = 1024.0 * p + Vec3(1, 2, 3) * 1e5;
  std::vector<Vec3> expected = Fair(curve).after.points;
  for (Vec3& p : expected) p = 1024.0 * p + Vec3(1, 2, 3) * 1e5;
  const FairedCurve faired = Fair(moved);
  EXPECT_EQ(faired.iterations(), Fair(curve).iterations());
  EXPECT_LE(Farthest(faired.after.points, expected), 1e-7);  // of coordinates of 4e5
}

TEST(FairCurve, CoincidentNeighboursAreOnePoint) {
  const CurveFairing plain = Noisy(30, 0.2, 11);
  CurveFairing doubled = plain;
  doubled.points.insert(doubled.points.begin() + 5, 2, plain.points[5]);
  doubled.points.push_back(plain.points.back());
  doubled.terms.locks = {{6, {true, true, true}}};  // a copy of point 5
  CurveFairing locked = plain;
  locked.terms.locks = {{5, {true, true, true}}};
  const FairedCurve a = Fair(doubled), b = Fair(locked);
  EXPECT_EQ(a.after.points, b.after.points);
  ASSERT_EQ(a.moved.size(), 33u);
  EXPECT_EQ(a.node[4], 4);
  EXPECT_EQ(a.node[7], 5);
  EXPECT_EQ(a.node[8], 6);
  EXPECT_EQ(a.node[32], 29);
}

TEST(FairCurve, WorkIsLinearInThePoints) {
  for (const int n : {10, 1000, 100'000}) {
    CurveFairing curve = Noisy(n, 0.2 / n, 12);
    curve.terms.stop = FairingStop::kIterations;
    curve.terms.max_iterations = 3;
    EXPECT_EQ(Fair(curve).rows, n + 3 * 4 * n);
    curve.terms.band.setConstant(0.05 / n);
    EXPECT_LE(Fair(curve).rows, n + 3LL * (3 * kMaxBoxSolves + 1 + kMaxHalvings) * n);
  }
}

TEST(FairCurve, EnergyStopGoesOnWhereTheSignsHaveSettled) {
  CurveFairing curve = Noisy(101, 0.1, 13);
  const FairedCurve by_signs = Fair(curve);
  curve.terms.stop = FairingStop::kSignsAndEnergy;
  curve.terms.max_iterations = 1000;
  const FairedCurve by_energy = Fair(curve);
  ASSERT_TRUE(by_energy.settled);
  EXPECT_GT(by_energy.iterations(), by_signs.iterations());
  const std::size_t last = by_energy.energies.size() - 1;
  EXPECT_LE(by_energy.energies[last - 1] - by_energy.energies[last], 1e-3 * by_energy.energies[last - 1]);
}

TEST(FairCurve, EndDirectionsAreKept) {
  CurveFairing curve = Noisy(30, 0.2, 14);
  curve.start_direction = Vec3(0, 2, 0);
  curve.end_direction = Vec3(1, 1, 1);
  const FairedCurve faired = Fair(curve);
  EXPECT_LE((faired.after.tangents.front().normalized() - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_LE((faired.after.tangents.back().normalized() - Vec3(1, 1, 1).normalized()).norm(), 1e-15);
}

TEST(FairCurve, BadRequests) {
  const CurveFairing good = Noisy(10, 0.1, 15);
  const auto fault = [](const CurveFairing& curve) {
    const absl::Status status = FairCurve(curve).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    return std::string(status.message());
  };
  CurveFairing c = good;
  c.points.resize(1);
  EXPECT_EQ(fault(c), "points are 1; must be 2 to 100000");
  c = good;
  c.points[3].y() = std::nan("");
  EXPECT_EQ(fault(c), "points[3] is not finite");
  c = good;
  c.points.assign(5, Vec3(1, 2, 3));
  EXPECT_EQ(fault(c), "points all coincide");
  c = good;
  for (Vec3& p : c.points) p *= 1e-120;
  EXPECT_EQ(fault(c), "points are too near each other for the range of numbers; scale them up");
  c = good;
  c.terms.band.y() = -1;
  EXPECT_EQ(fault(c), "band.y_mm = -1; must be >= 0");
  c = good;
  c.terms.locks = {{0, {}}, {10, {}}};
  EXPECT_EQ(fault(c), "locks[1].point_index = 10; must be in [0, 9]");
  c = good;
  c.terms.max_iterations = -1;
  EXPECT_EQ(fault(c), "max_iterations = -1; must be in [0, 10000]");
  c = good;
  c.end_direction = Vec3::Zero();
  EXPECT_THAT(fault(c), HasSubstr("end_direction = (0, 0, 0); must have a length"));
}

TEST(FairCurve, IsCancelled) {
  RunContext run;
  run.Cancel();
  EXPECT_EQ(FairCurve(Noisy(10, 0.1, 16), run).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
