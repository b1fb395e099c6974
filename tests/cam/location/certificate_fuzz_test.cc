// Certificates against the lanes on random parts: no certificate ever improves a height that was found, by
// lanes or by the search it belongs to. PATCHMILL_FUZZ_QUERIES sets how many heights are asked for.
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cam/location/heights.h"
#include "core/base/parallel.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using testing::Random;
using testing::SurfaceOf;

constexpr long kQueries = 300'000;
constexpr std::size_t kRows = 250;  // of eight places, on each part
constexpr double kEps = 1e-6;

struct Part {
  PatchModel model;
  double radius = 1.0;
};

PatchModel RandomModel(Random& random) {
  const std::uint64_t seed = random.Bits();
  const bool coin = random.Int(2) == 0;
  const auto blend = coin ? GregoryPatch::Blend::kCorner : GregoryPatch::Blend::kEdge;
  switch (random.Int(16)) {
    case 0:
    case 1:
      return testing::RandomBspline(seed, {.spans = 3, .size = 20.0});
    case 2:
      return testing::RandomBspline(seed, {.spans = 3, .size = 20.0, .folds = true, .rational = coin});
    case 3:
      return testing::Single(testing::RandomBezier(seed, 1 + random.Int(6), 1 + random.Int(6), coin));
    case 4:
      return testing::Single(testing::RandomKnots(seed, 3, 1 + random.Int(3), coin));
    case 5:
      return testing::Single(testing::RandomGregory(seed, blend));
    case 6:
      return testing::Single(testing::RandomTriangle(seed, 1 + random.Int(5), coin));
    case 7:
      return testing::Single(testing::RandomBrown(seed, 3, 3));
    case 8:
      return testing::Single(testing::RandomGregoryTriangle(seed, blend));
    case 9:
      return testing::Single(testing::RandomLoftTriangle(seed, 3, coin));
    case 10:
      return testing::Single(testing::RandomG2Gregory(seed, 5));
    case 11:
      return testing::Single(testing::RandomHosaka(seed, 3, coin, true));
    case 12:
      return testing::Block(random.Uniform(3, 8), random.Uniform(1, 8), 12.0);
    case 13:
      return testing::TwoPlanes(random.Uniform(-1.5, 1.5), 10.0);
    case 14:
      return testing::Torus(Vec3::Zero(), random.Uniform(3, 8), 3.0);
    default:
      return testing::TwoSpheres(random.Uniform(3, 6), random.Uniform(2, 11));
  }
}

// Now and then two of them at once, the same one twice, a sliver, or one turned on its side; from microns to
// a hundred metres.
Part RandomPart(Random& random) {
  PatchModel model = RandomModel(random);
  const int more = random.Int(12);
  Eigen::Affine3d motion = Eigen::Affine3d::Identity();
  if (more == 0) model = testing::Join({model, model});
  if (more == 1) model = testing::Join({model, RandomModel(random)});
  if (more == 2) motion.scale(Vec3(1.0, std::pow(10.0, random.Uniform(-4.0, -1.0)), 1.0));
  if (more == 3) motion.rotate(Eigen::AngleAxisd(random.Uniform(0, kPi), random.Point(-1, 1).normalized()));
  if (more == 4) motion.translate(random.Point(-1e3, 1e3));
  const double scale = more == 5 ? std::pow(10.0, random.Uniform(-4.0, 4.0)) : 1.0;
  if (more >= 2 && more <= 5)
    model = testing::Transformed(model, Eigen::Affine3d(Eigen::Scaling(scale) * motion));
  return {std::move(model), scale * std::pow(10.0, random.Uniform(-0.3, 0.8))};
}

// A random place on the surface whose normal is level, if one is met between two random places.
std::optional<SurfaceJet> Silhouette(const Piece& piece, Random& random) {
  const Vec2 a(random.Unit(), random.Unit()), b(random.Unit(), random.Unit());
  const auto at = [&](double t) {
    return Evaluate(piece, a.x() + t * (b.x() - a.x()), a.y() + t * (b.y() - a.y()));
  };
  const auto rise = [&](double t) {
    const SurfaceJet jet = at(t);
    return jet.du.cross(jet.dv).z();
  };
  double low = 0.0, high = 1.0;
  const bool up = rise(high) > 0.0;
  if ((rise(low) > 0.0) == up) return std::nullopt;
  for (int k = 0; k < 50; ++k) {
    const double t = 0.5 * (low + high);
    ((rise(t) > 0.0) == up ? high : low) = t;
  }
  return at(high);
}

// Where rows begin: anywhere; beside patch borders, or a radius from them; where the ball rests on a random
// place; where it touches a silhouette with its equator.
Vec2 RandomPlace(const Surface& surface, double radius, Random& random) {
  const Box3& box = surface.box;
  const int kind = random.Int(5);
  const double x = random.Uniform(box.min.x() - radius, box.max.x() + radius);
  const double y = random.Uniform(box.min.y() - radius, box.max.y() + radius);
  if (kind == 0) return {x, y};
  const Piece& piece =
      surface.pieces[static_cast<std::size_t>(random.Int(static_cast<int>(surface.pieces.size())))];
  const double phi = random.Uniform(0, 2 * kPi);
  const double tiny =
      radius * std::pow(10.0, random.Uniform(-10.0, -1.0)) * (random.Int(2) == 0 ? 1.0 : -1.0);
  const Vec2 direction(std::cos(phi), std::sin(phi));
  double u = random.Unit(), v = random.Unit();
  if (kind <= 2) {
    (random.Int(2) == 0 ? u : v) = random.Int(2);
    const double distance = kind == 1 ? tiny : radius + tiny;
    return Plan(Position(piece, u, v)) + distance * direction;
  }
  SurfaceJet jet = Evaluate(piece, u, v);
  if (kind == 4) jet = Silhouette(piece, random).value_or(jet);
  const Vec3 n = jet.du.cross(jet.dv);
  if (!(n.norm() > 0.0)) return Plan(jet.p);
  return Plan(jet.p) + (radius + tiny) / n.norm() * Plan(n);
}

struct Tally {
  long asked = 0, certified = 0;
  long below = 0;     // heights of lanes below certified ones: missed maxima
  long above = 0;     // above them: no contact can be there
  long missing = 0;   // found by one of the two only
  long open = 0;      // gaps that did not close
  long defects = 0;   // as the locator counts them
  std::string first;  // where the first went wrong
};

void Judge(std::uint64_t seed, Tally& tally) {
  Random random(seed);
  const Part part = RandomPart(random);
  const Surface surface = SurfaceOf(part.model, {.leaf_thickness = 0.1 * part.radius});
  const Locator locator(surface, part.radius);
  std::vector<Vec2> places;
  for (std::size_t row = 0; row < kRows; ++row) {
    const Vec2 at = RandomPlace(surface, part.radius, random);
    const double phi = random.Uniform(0, 2 * kPi);
    const double step = part.radius * std::pow(10.0, random.Uniform(-9.0, 0.0));
    for (int k = 0; k < 8; ++k) places.push_back(at + k * step * Vec2(std::cos(phi), std::sin(phi)));
  }
  std::vector<std::optional<CenterPoint>> heights(places.size());
  Heights(locator, places, heights);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto c = locator.CertifiedHeight(places[i], kEps);
    ++tally.asked;
    const auto bad = [&](long& count, const char* what) {
      ++count;
      if (tally.first.empty())
        tally.first = std::string(what) + ", seed " + std::to_string(seed) + " place " + std::to_string(i);
    };
    if (heights[i].has_value() != c.has_value()) bad(tally.missing, "missing");
    if (!heights[i] || !c) continue;
    ++tally.certified;
    // Near the ball's equator h answers a rounding of the surface by its square root.
    const double below = std::min(c->z - c->contact.p.z(), heights[i]->z - heights[i]->contact.p.z());
    const double grain = 4e-14 * surface.scale;
    const double rounding = 1e-9 + std::sqrt(below * below + 2.0 * part.radius * grain) - below;
    if (heights[i]->z < c->z - rounding) bad(tally.below, "below");
    if (heights[i]->z > c->z + rounding) bad(tally.above, "above");
    if (c->gap > kEps + 1e-11 * surface.scale) bad(tally.open, "open");
  }
  if (locator.defect_count() > 0) {
    tally.defects += static_cast<long>(locator.defect_count());
    if (tally.first.empty()) tally.first = "defects, seed " + std::to_string(seed);
  }
}

void ExpectClean(const Tally& all) {
  EXPECT_GT(all.certified, all.asked / 2);
  EXPECT_EQ(all.below, 0) << all.first;
  EXPECT_EQ(all.above, 0) << all.first;
  EXPECT_EQ(all.missing, 0) << all.first;
  EXPECT_EQ(all.open, 0) << all.first;
  EXPECT_EQ(all.defects, 0) << all.first;
}

TEST(CertificateFuzz, NoCertificateImprovesAHeight) {
  const char* asked = std::getenv("PATCHMILL_FUZZ_QUERIES");
  const long queries = asked != nullptr ? std::atol(asked) : kQueries;
  const std::size_t parts = static_cast<std::size_t>(queries) / (8 * kRows) + 1;
  std::vector<Tally> tallies(parts);
  const absl::Status status =
      ParallelFor(RunContext(), nullptr, parts, [&](std::size_t i) { Judge(i, tallies[i]); });
  ASSERT_TRUE(status.ok()) << status;
  Tally all;
  for (const Tally& t : tallies) {
    all.asked += t.asked;
    all.certified += t.certified;
    all.below += t.below;
    all.above += t.above;
    all.missing += t.missing;
    all.open += t.open;
    all.defects += t.defects;
    if (all.first.empty()) all.first = t.first;
  }
  EXPECT_GE(all.asked, queries);
  ExpectClean(all);
}

// Upright leaves that were too hollow for the ball on one side only, or touched on their rim, or near the
// equator: maxima once missed.
TEST(CertificateFuzz, UprightGround) {
  for (const std::uint64_t seed : {457, 816, 916}) {
    Tally tally;
    Judge(seed, tally);
    ExpectClean(tally);
  }
}

}  // namespace
}  // namespace patchmill
