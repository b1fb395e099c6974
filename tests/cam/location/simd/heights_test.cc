// Heights of many places and what is in the way: the same bits on every instruction set, the same heights as
// one place at a time.
#include "cam/location/simd/heights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "core/base/digest.h"
#include "core/network/patch_model.h"
#include "tests/support/files.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using testing::Random;
using testing::SurfaceOf;
using Answers = std::vector<std::optional<CenterPoint>>;

struct Case {
  const char* name;
  PatchModel model;
  double radius;
  bool same_everywhere = true;  // the model's own numbers, whatever the processor it was made on
};

PatchModel Placed(const char* path, const Placement& placement) {
  return Place(placement, testing::LoadModel(path));
}

std::vector<Case> Cases() {
  std::vector<Case> cases;
  // Its points come from exp and the solution of a large system, which other processors may round otherwise.
  cases.push_back({"two hills", testing::TwoHills(), 3.0, false});
  cases.push_back({"teapot", Placed("examples/teapot.bpt", {.scale = 54.8, .up = UpAxis::kY}), 3.0});
  cases.push_back({"toroidal tet", Placed("tests/models/toroidal_tet.patches", {.scale = 40.0}), 3.0});
  cases.push_back({"sphere", testing::Sphere(Vec3(1, 2, 3), 6.0), 2.0});
  cases.push_back({"torus", testing::Torus(Vec3::Zero(), 9.0, 3.5), 4.0});
  cases.push_back({"block", testing::Block(5.0, 8.0, 15.0), 3.0});
  cases.push_back({"saddle", testing::Saddle(0.2, 0.3, 6.0), 1.5});
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const auto gregory = [&](GregoryPatch::Blend blend) {
      return testing::Single(testing::RandomGregory(seed, blend));
    };
    cases.push_back({"gregory, corners", gregory(GregoryPatch::Blend::kCorner), 2.0});
    cases.push_back({"gregory, edges", gregory(GregoryPatch::Blend::kEdge), 2.0});
    cases.push_back({"rational", testing::Single(testing::RandomBezier(seed, 4, 2, true)), 1.0});
    cases.push_back({"linear by quintic", testing::Single(testing::RandomBezier(seed, 1, 5, false)), 2.0});
    cases.push_back({"brown", testing::Single(testing::RandomBrown(seed, 3, 4)), 2.0});  // not in lanes
    cases.push_back({"triangle", testing::Single(testing::RandomTriangle(seed, 3, seed % 2 == 0)), 2.0});
  }
  return cases;
}

// A grid of rows beyond all borders, `count` squared.
void AddGrid(const Surface& surface, double radius, int count, std::vector<Vec2>& places) {
  const Vec2 low = Xy(surface.box.min) - Vec2::Constant(1.3 * radius);
  const Vec2 step = (Xy(surface.box.max) + Vec2::Constant(1.3 * radius) - low) / (count - 1);
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) places.push_back(low + step.cwiseProduct(Vec2(i, j)));
  }
}

// Around points of patch borders, silhouettes of the open ones among them, in no order at all: the ball's
// axis a little beside them, and at a distance of R with a little more or less, where they are about to come
// into or leave the disc.
void AddBorderPlaces(const Surface& surface, double radius, int count, std::vector<Vec2>& places) {
  Random random(5);
  for (int k = 0; k < count; ++k) {
    const int at = random.Int(static_cast<int>(surface.pieces.size()));
    double u = random.Unit(), v = random.Unit();
    (random.Int(2) == 0 ? u : v) = random.Int(2);
    const Vec3 p = Position(surface.pieces[static_cast<std::size_t>(at)], u, v);
    const double phi = random.Uniform(0, 2 * kPi), tiny = std::pow(10.0, random.Uniform(-9.0, -1.0));
    const double sign = random.Int(2) == 0 ? 1.0 : -1.0;
    const double distance = k % 3 == 0 ? tiny : radius + sign * tiny;
    places.push_back(Xy(p) + distance * Vec2(std::cos(phi), std::sin(phi)));
  }
}

// Places at which the ball touches given points of the surface along their normals, on steep areas and
// overhangs, too. They are runs of neighbours along u.
void AddRestingPlaces(const Surface& surface, double radius, int count, std::vector<Vec2>& places) {
  Random random(6);
  for (int k = 0; k < count; k += 10) {
    const int at = random.Int(static_cast<int>(surface.pieces.size()));
    const double v = random.Unit();
    for (int i = 0; i < 10; ++i) {
      const SurfaceJet jet = Evaluate(surface.pieces[static_cast<std::size_t>(at)], 0.1 * i, v);
      const Vec3 n = jet.du.cross(jet.dv);
      if (n.norm() > 0.0) places.push_back(Xy(jet.p) + radius / n.norm() * Xy(n));
    }
  }
}

std::vector<Vec2> Places(const Surface& surface, double radius, int count) {
  std::vector<Vec2> places;
  AddGrid(surface, radius, count, places);
  AddBorderPlaces(surface, radius, 15 * count, places);
  AddRestingPlaces(surface, radius, 15 * count, places);
  return places;
}

// For digests to compare builds for other processors by (scripts/cross_aarch64.sh).
void AddTo(Canonical& digest, const std::optional<CenterPoint>& h) {
  if (!h) return;
  digest.Add(h->z).Add(h->contact.u).Add(h->contact.v).Add(std::int64_t{h->contact.piece.value});
}
void AddTo(Canonical& digest, const std::optional<SurfacePoint>& p) {
  if (!p) return;
  digest.Add(p->p.x()).Add(p->p.y()).Add(p->p.z()).Add(p->u).Add(p->v).Add(std::int64_t{p->piece.value});
}

template <class Answer>
std::string DigestOf(const std::vector<Answer>& answers) {
  Canonical digest;
  for (const Answer& a : answers) AddTo(digest, a);
  return Hex(digest.Digest());
}

bool SameBits(const std::optional<CenterPoint>& a, const std::optional<CenterPoint>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  const auto numbers = [](const CenterPoint& c) {
    return std::array{c.z, c.contact.u, c.contact.v, c.contact.p.x(), c.contact.p.y(), c.contact.p.z()};
  };
  const auto x = numbers(*a), y = numbers(*b);
  return a->contact.piece == b->contact.piece && std::memcmp(x.data(), y.data(), sizeof x) == 0;
}

Answers HeightsOn(InstructionSet set, const Locator& locator, const std::vector<Vec2>& places) {
  const testing::OnInstructionSet on(set);
  Answers answers(places.size());
  Heights(locator, places, answers);
  return answers;
}

TEST(Heights, SameBitsOnEveryInstructionSet) {
  int digests = 0;
  for (const Case& c : Cases()) {
    SCOPED_TRACE(c.name);
    const Surface surface = SurfaceOf(c.model);
    const Locator locator(surface, c.radius);
    const std::vector<Vec2> places = Places(surface, c.radius, 19);
    const Answers plain = HeightsOn(InstructionSet::kPlain, locator, places);
    if (c.same_everywhere) RecordProperty("digest_" + std::to_string(digests++), DigestOf(plain));
    for (const InstructionSet set : InstructionSets()) {
      SCOPED_TRACE(Name(set));
      const Answers answers = HeightsOn(set, locator, places);
      for (std::size_t k = 0; k < places.size(); ++k) {
        ASSERT_TRUE(SameBits(plain[k], answers[k])) << places[k].transpose();
      }
    }
  }
}

// How much a height answers a rounding of the surface: where the contact lies `below` the centre, 1e-9 and
// more only within a few nanometres of grazing the ball's equator.
double Rounding(const Surface& surface, double radius, double below) {
  const double rounding = 4e-14 * surface.scale;
  return 1e-9 + std::sqrt(below * below + 2.0 * radius * rounding) - below;
}

TEST(Heights, AreThoseOfOnePlaceAtATime) {
  for (const Case& c : Cases()) {
    SCOPED_TRACE(c.name);
    const Surface surface = SurfaceOf(c.model);
    const Locator locator(surface, c.radius);
    const std::vector<Vec2> places = Places(surface, c.radius, 27);
    Answers answers(places.size());
    Heights(locator, places, answers);
    int found = 0, sharp = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const auto single = locator.CertifiedHeight(places[k], 1e-6);
      ASSERT_EQ(single.has_value(), answers[k].has_value()) << places[k].transpose();
      if (!single) continue;
      ++found;
      const double below =
          std::min(single->z - single->contact.p.z(), answers[k]->z - answers[k]->contact.p.z());
      ASSERT_NEAR(single->z, answers[k]->z, Rounding(surface, c.radius, below)) << places[k].transpose();
      sharp += Rounding(surface, c.radius, below) < 1.1e-9;
      // The contact is on the surface, and the ball at that height touches it.
      const SurfacePoint& p = answers[k]->contact;
      ASSERT_LE((Position(surface.piece(p.piece), p.u, p.v) - p.p).norm(), 1e-9);
      const double rim2 = c.radius * c.radius - (Xy(p.p) - places[k]).squaredNorm();
      ASSERT_NEAR(p.p.z() + std::sqrt(std::max(0.0, rim2)), answers[k]->z, 1e-12 * surface.scale);
    }
    EXPECT_GT(found, 100);
    EXPECT_GT(sharp, found * 9 / 10);
  }
}

TEST(Obstacles, StandBelowTheHeightsAndNotAbove) {
  for (const Case& c : Cases()) {
    SCOPED_TRACE(c.name);
    const Surface surface = SurfaceOf(c.model);
    const Locator locator(surface, c.radius);
    std::vector<Vec2> places;
    AddGrid(surface, c.radius, 40, places);
    Answers heights(places.size());
    Heights(locator, places, heights);
    // Just above and just below h, and anywhere where nothing lies below.
    for (const double over : {1e-5, -1e-5, 0.7, -0.7}) {
      std::vector<Vec3> centers;
      for (std::size_t i = 0; i < places.size(); ++i)
        centers.push_back(Lift(places[i], heights[i] ? heights[i]->z + over : -100.0));
      std::vector<std::optional<SurfacePoint>> obstacles(centers.size());
      FindObstacles(locator, centers, obstacles);
      for (std::size_t i = 0; i < centers.size(); ++i) {
        EXPECT_EQ(!obstacles[i], !heights[i] || over > 0.0) << centers[i].transpose() << " over " << over;
        if (!obstacles[i]) continue;
        const Vec3 d = obstacles[i]->p - centers[i];  // in the ball, or above it and beside its axis
        EXPECT_LT(Vec3(d.x(), d.y(), std::min(d.z(), 0.0)).norm(), c.radius) << centers[i].transpose();
      }
    }
  }
}

// Centres at the heights themselves, within rounding and a little more of them, and far from them: where a
// ball that only just touches is free or not.
std::vector<Vec3> CentersNearTheHeights(const Surface& surface, const Locator& locator) {
  const std::vector<Vec2> places = Places(surface, locator.radius(), 15);
  const Answers heights = HeightsOn(InstructionSet::kPlain, locator, places);
  Random random(7);
  std::vector<Vec3> centers;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double h = heights[k] ? heights[k]->z : surface.box.min.z();
    const double tiny = std::pow(10.0, random.Uniform(-16.0, 0.5));
    for (const double over : {0.0, tiny, -tiny}) centers.push_back(Lift(places[k], h + over));
  }
  return centers;
}

TEST(Obstacles, SameBitsOnEveryInstructionSet) {
  int digests = 0;
  for (const Case& c : Cases()) {
    SCOPED_TRACE(c.name);
    const Surface surface = SurfaceOf(c.model);
    const Locator locator(surface, c.radius);
    const std::vector<Vec3> centers = CentersNearTheHeights(surface, locator);
    const auto obstacles_on = [&](InstructionSet set) {
      const testing::OnInstructionSet on(set);
      std::vector<std::optional<SurfacePoint>> obstacles(centers.size());
      FindObstacles(locator, centers, obstacles);
      return obstacles;
    };
    const auto plain = obstacles_on(InstructionSet::kPlain);
    if (c.same_everywhere) RecordProperty("digest_" + std::to_string(digests++), DigestOf(plain));
    const auto found = std::count_if(plain.begin(), plain.end(), [](const auto& p) { return p.has_value(); });
    EXPECT_GT(found, 100);
    EXPECT_GT(static_cast<std::int64_t>(centers.size()) - found, 100);
    for (const InstructionSet set : InstructionSets()) {
      SCOPED_TRACE(Name(set));
      const auto obstacles = obstacles_on(set);
      for (std::size_t k = 0; k < centers.size(); ++k) {
        ASSERT_EQ(plain[k].has_value(), obstacles[k].has_value()) << centers[k].transpose();
        if (!plain[k]) continue;
        const SurfacePoint &a = *plain[k], &b = *obstacles[k];
        ASSERT_EQ(std::memcmp(a.p.data(), b.p.data(), sizeof(Vec3)), 0) << centers[k].transpose();
        ASSERT_TRUE(a.piece == b.piece && a.u == b.u && a.v == b.v) << centers[k].transpose();
      }
    }
  }
}

// A ball on a sphere, in closed form.
TEST(Heights, OnASphere) {
  const Surface surface = SurfaceOf(testing::Sphere(Vec3(1, 2, 3), 6.0));
  const Locator locator(surface, 2.0);
  std::vector<Vec2> places;
  AddGrid(surface, 2.0, 60, places);
  for (const InstructionSet set : InstructionSets()) {
    const Answers answers = HeightsOn(set, locator, places);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const double d = (places[k] - Vec2(1, 2)).norm();
      ASSERT_EQ(answers[k].has_value(), d <= 8.0);
      if (d > 8.0) continue;
      ASSERT_NEAR(answers[k]->z, 3.0 + std::sqrt(64.0 - d * d), 1e-9);
    }
  }
}

TEST(Heights, NoPlacesAndNoSurfaceBelow) {
  const Surface surface = SurfaceOf(testing::Plane(5.0));
  const Locator locator(surface, 1.0);
  Heights(locator, {}, {});
  const std::vector<Vec2> far = {{50, 50}, {51, 50}, {0, 0}};
  Answers answers(3, CenterPoint{});
  Heights(locator, far, answers);
  EXPECT_FALSE(answers[0].has_value());
  EXPECT_FALSE(answers[1].has_value());
  ASSERT_TRUE(answers[2].has_value());
  EXPECT_NEAR(answers[2]->z, 1.0, 1e-12);
}

}  // namespace
}  // namespace patchmill
