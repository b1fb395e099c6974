// Fairing of nets: the five-term equation of the vectors, planes, locks and bands, noise on a known surface.
#include "core/fairing/fair_net.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/index.h"
#include "tests/support/json.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Json;
using testing::Random;

FairedNet Fair(const NetFairing& net) {
  absl::StatusOr<FairedNet> faired = FairNet(net);
  EXPECT_TRUE(faired.ok()) << faired.status();
  return *faired;
}

// z = f(x,y) over an uneven net, with noise in all components.
NetFairing Hill(int nu, int nv, double noise, std::uint64_t seed) {
  Random random(seed);
  NetFairing net{nu, nv, {}, {}};
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) {
      const double x = 100.0 * i / (nu - 1), y = 80.0 * j / (nv - 1) * (1 + 0.003 * x);
      const bool border = i == 0 || j == 0 || i == nu - 1 || j == nv - 1;
      const Vec3 off = random.Point(-1, 1);
      net.points.push_back(Vec3(x, y, 8 * std::sin(x / 25) * std::cos(y / 20)) +
                           (border ? 0.0 : noise) * off);
    }
  }
  return net;
}

double Length(const std::vector<Vec3>& vectors) {
  double longest = 0.0;
  for (const Vec3& v : vectors) longest = std::max(longest, v.norm());
  return longest;
}

TEST(FairNet, FiveTermEquationOfTheVectors) {
  const Json data = testing::LoadJson(PATCHMILL_SOURCE_DIR "/tests/vectors/okada_surface.json");
  const int nu = static_cast<int>(data["P"].Items().size()),
            nv = static_cast<int>(data["P"][0].Items().size());
  std::vector<Vec3> points;
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) points.push_back(data["P"][i][j].Vector());
  }
  BeamNet net = FitNet(nu, points);
  for (int i = 0; i < nu; ++i) {  // X of the file to m: divide by the chord
    for (int j = 0; j < nv; ++j) {
      Beam &u = net.u[At(j)], &v = net.v[At(i)];
      u.tangents[At(i)] = data["Xu"][i][j].Vector() / u.chords[At(std::min(i, nu - 2))];
      v.tangents[At(j)] = data["Xv"][i][j].Vector() / v.chords[At(std::min(j, nv - 2))];
    }
  }
  const int i = static_cast<int>(data["i"].Number()), j = static_cast<int>(data["j"].Number());
  const FiveTermRow row = FiveTermRowOf(net, i, j);
  const auto p = [&](int a, int b) { return points[At(a * nv + b)]; };
  const Vec3 lhs = 2.0 * row.u.before * (p(i, j) - p(i - 1, j)) +
                   2.0 * row.u.after * (p(i, j) - p(i + 1, j)) +
                   2.0 * row.v.before * (p(i, j) - p(i, j - 1)) + 2.0 * row.v.after * (p(i, j) - p(i, j + 1));
  const Vec3 rhs = row.u.rhs + row.v.rhs;
  EXPECT_LE((lhs - data["lhs"].Vector()).norm(), 1e-12);
  EXPECT_LE((rhs - data["rhs"].Vector()).norm(), 1e-12);
  EXPECT_LE((12.0 * (lhs - rhs) - data["grad"].Vector()).norm(), 1e-11);
  // And it is the gradient of V with chords and tangents frozen, by central differences of a quadratic.
  for (int axis = 0; axis < 3; ++axis) {
    const auto energy = [&](double step) {
      BeamNet other = net;
      other.u[At(j)].points[At(i)][axis] += step;
      other.v[At(i)].points[At(j)][axis] += step;
      return Energy(other);
    };
    EXPECT_NEAR((energy(0.5) - energy(-0.5)), data["grad"].Vector()[axis], 1e-10);
  }
}

// The five-term system is solved: with tangents and chords of the first state frozen, no free node of the
// target feels a force. Seen through one full step: bands and halvings out of play, energy of the frozen
// state is least there.
TEST(FairNet, OneIterationIsTheLeastOfTheFrozenEnergy) {
  NetFairing net = Hill(7, 6, 0.3, 1);
  net.terms.max_iterations = 1;
  const FairedNet faired = Fair(net);
  ASSERT_EQ(faired.energies.size(), 2u);
  const auto frozen = [&](const std::vector<Vec3>& points) {
    BeamNet state = faired.before;
    for (int i = 0; i < 7; ++i) {
      for (int j = 0; j < 6; ++j) {
        state.u[At(j)].points[At(i)] = state.v[At(i)].points[At(j)] = points[At(i * 6 + j)];
      }
    }
    return Energy(state);
  };
  const double least = frozen(faired.after.points);
  EXPECT_LT(least, faired.energies[0]);
  for (int i = 1; i < 6; ++i) {
    for (int j = 1; j < 5; ++j) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const double step : {-1e-3, 1e-3}) {
          std::vector<Vec3> points = faired.after.points;
          points[At(i * 6 + j)][axis] += step;
          EXPECT_GT(frozen(points), least);
        }
      }
    }
  }
}

TEST(FairNet, APlaneNetOfStraightLinesStays) {
  NetFairing net{9, 8, {}, {}};
  Random random(2);
  std::vector<double> s{0}, t{0};
  for (int k = 0; k < 8; ++k)
    s.push_back(s.back() + random.Uniform(1, 4)), t.push_back(t.back() + random.Uniform(1, 4));
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 8; ++j) {
      net.points.push_back(Vec3(300, -200, 100) + s[At(i)] * Vec3(1, 0.2, 0.5) +
                           t[At(j)] * Vec3(-0.3, 1, 0.1));
    }
  }
  net.terms.stop = FairingStop::kIterations;
  net.terms.max_iterations = 10;
  EXPECT_LE(Length(Fair(net).moved), 1e-11);
}

TEST(FairNet, NoiseGoesAway) {
  const NetFairing noisy = Hill(21, 17, 0.1, 3), clean = Hill(21, 17, 0.0, 3);
  const FairedNet faired = Fair(noisy);
  for (std::size_t k = 1; k < faired.energies.size(); ++k) {
    EXPECT_LT(faired.energies[k], faired.energies[k - 1]);
  }
  const double clean_energy = Energy(FitNet(21, clean.points));
  EXPECT_GT(faired.energies.front() - clean_energy, 0.5 * clean_energy);
  EXPECT_LT(faired.energies.back() - clean_energy, 0.1 * (faired.energies.front() - clean_energy));
}

TEST(FairNet, BordersLocksAndBandsHold) {
  NetFairing net = Hill(12, 11, 0.5, 4);
  net.terms.band = {0.2, 0.3, 0.1};
  net.terms.locks = {{5 * 11 + 5, {true, true, true}}, {6 * 11 + 6, {false, false, true}}};
  net.terms.stop = FairingStop::kIterations;
  net.terms.max_iterations = 5;
  const FairedNet faired = Fair(net);
  int at_limit = 0;
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 11; ++j) {
      const Vec3& moved = faired.moved[At(i * 11 + j)];
      if (i == 0 || j == 0 || i == 11 || j == 10) {
        EXPECT_EQ(moved.norm(), 0.0);
      }
      for (int a = 0; a < 3; ++a) {
        EXPECT_LE(std::abs(moved[a]), net.terms.band[a] * (1 + 1e-12));
        if (std::abs(moved[a]) > net.terms.band[a] * (1 - 1e-12)) ++at_limit;
      }
    }
  }
  EXPECT_GT(at_limit, 10);
  EXPECT_EQ(faired.moved[5 * 11 + 5].norm(), 0.0);
  EXPECT_EQ(faired.moved[6 * 11 + 6].z(), 0.0);
  EXPECT_NE(faired.moved[6 * 11 + 6].x(), 0.0);
}

TEST(FairNet, TransposedNetGivesTheTransposedResult) {
  const NetFairing net = Hill(9, 7, 0.2, 5);
  NetFairing other{7, 9, {}, {}};
  for (int j = 0; j < 7; ++j) {
    for (int i = 0; i < 9; ++i) other.points.push_back(net.points[At(i * 7 + j)]);
  }
  const FairedNet a = Fair(net), b = Fair(other);
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 7; ++j) {
      EXPECT_LE((a.after.points[At(i * 7 + j)] - b.after.points[At(j * 9 + i)]).norm(), 1e-10);
    }
  }
}

TEST(FairNet, ANetOfTwoLinesIsAllBorder) {
  const NetFairing net = Hill(2, 6, 0.0, 6);
  const FairedNet faired = Fair(net);
  EXPECT_TRUE(faired.settled);
  EXPECT_EQ(Length(faired.moved), 0.0);
}

TEST(FairNet, BadRequests) {
  const NetFairing good = Hill(5, 4, 0.0, 7);
  const auto fault = [](const NetFairing& net) {
    const absl::Status status = FairNet(net).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    return std::string(status.message());
  };
  NetFairing net = good;
  net.count_u = 4;
  EXPECT_EQ(fault(net), "points are 20; must be count_u x count_v = 4 x 4, each >= 2");
  net = good;
  net.count_u = 20, net.count_v = 1;
  EXPECT_EQ(fault(net), "points are 20; must be count_u x count_v = 20 x 1, each >= 2");
  net = good;
  net.points[6] = net.points[5];
  EXPECT_EQ(fault(net), "points coincide at the nodes (1, 1) and (1, 2)");
  net = good;
  net.points[6] = net.points[10];
  EXPECT_EQ(fault(net), "points coincide at the nodes (1, 2) and (2, 2)");
  net = good;
  net.terms.locks = {{20, {}}};
  EXPECT_EQ(fault(net), "locks[0].point_index = 20; must be in [0, 19]");
}

}  // namespace
}  // namespace patchmill
