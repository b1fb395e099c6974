#include "core/surface/cap_holes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "core/base/status.h"
#include "core/surface/face_figures.h"
#include "core/surface/holes.h"
#include "tests/support/faced_turning.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

PatchNetwork NetworkOf(const PatchModel& model) {
  auto network = BuildNetwork(model);
  PM_CHECK(network.ok());
  return *std::move(network);
}

Surface SurfaceOf(const PatchModel& model) {
  auto surface = BuildSurface(NetworkOf(model), SurfaceParams{}, RunContext());
  PM_CHECK(surface.ok());
  return *std::move(surface);
}

CappedModel Capped(PatchModel model, double diameter, double scale = 1.0) {
  auto capped = CapHoles(std::move(model), {diameter, scale}, RunContext());
  PM_CHECK(capped.ok());
  return *std::move(capped);
}

double AreaOf(const PatchModel& model) {
  auto figures = MeasureFaces(SurfaceOf(model), RunContext());
  PM_CHECK(figures.ok());
  return std::accumulate(figures->begin(), figures->end(), 0.0,
                         [](double sum, const FaceFigures& face) { return sum + face.area; });
}

int WarningsOf(const CappedModel& capped) {
  return static_cast<int>(std::count_if(capped.findings.begin(), capped.findings.end(),
                                        [](const Diagnostic& d) { return d.code == "HOLE_NOT_CAPPED"; }));
}

const TurnedFace kRim = Pin(20, 0, 10), kTop = Ring(20, 3, 10), kFloor = Ring(0, 20, 0);
// A closed disc, a closed body without any hole.
constexpr double kDisc = 2 * kPi * 20 * 20 + 2 * kPi * 20 * 10;

// What is left of a part whose holes are closed: a ball by its topology, with caps that look out of the body.
void ExpectDisc(const CappedModel& capped, double area) {
  const PatchNetwork network = NetworkOf(capped.model);
  EXPECT_EQ(network.open_edge_count, 0);
  EXPECT_EQ(network.euler_characteristic, 2);
  EXPECT_EQ(network.component_count, 1);
  for (const Diagnostic& finding : network.findings) EXPECT_NE(finding.code, "INCONSISTENT_ORIENTATION");
  EXPECT_NEAR(AreaOf(capped.model), area, 1e-9 * area);
  EXPECT_TRUE(FindHoles(SurfaceOf(capped.model), RunContext())->empty());
  EXPECT_EQ(WarningsOf(capped), 0);
}

TEST(CapHoles, AThroughHoleGetsTwoCaps) {
  TurnedFace bore = Bore(3, 10, 0);
  bore.halves = true;
  const CappedModel capped = Capped(TurnedPart({kRim, kTop, bore, Ring(3, 20, 0)}), 6.0);
  ExpectDisc(capped, kDisc);
  EXPECT_EQ(capped.model.faces.size(), 5U);
  EXPECT_EQ(capped.model.faces[3].id, "cap1");
  EXPECT_EQ(capped.model.faces[3].kind, SurfaceKind::kPlane);
  EXPECT_EQ(capped.findings.front().code, "HOLES_CAPPED");
  EXPECT_NE(capped.findings.front().message.find("1 hole of at most 6 mm closed by 2 caps: f3"),
            std::string::npos)
      << capped.findings.front().message;
}

TEST(CapHoles, BlindHolesLoseTheirFloors) {
  const TurnedFace fillet{Round({3, 4}, {3, 3}, {2, 3}), SurfaceKind::kTorus, 1, true};
  ExpectDisc(Capped(TurnedPart({kRim, kTop, Bore(3, 10, 4), Ring(3, 0, 4), kFloor}), 6.0), kDisc);
  ExpectDisc(Capped(TurnedPart({kRim, kTop, Bore(3, 10, 4), fillet, Ring(2, 0, 3), kFloor}), 6.0), kDisc);
}

// A counterbore goes with the hole in its floor. If only the narrow hole is to be closed, the wide one stays.
TEST(CapHoles, Counterbores) {
  const PatchModel part =
      TurnedPart({kRim, Ring(20, 5, 10), Bore(5, 10, 6), Ring(5, 3, 6), Bore(3, 6, 0), Ring(3, 20, 0)});
  ExpectDisc(Capped(part, 10.0), kDisc);
  const CappedModel narrow = Capped(part, 6.0);
  const PatchNetwork network = NetworkOf(narrow.model);
  EXPECT_EQ(network.open_edge_count, 0);
  EXPECT_EQ(network.euler_characteristic, 2);
  EXPECT_NEAR(AreaOf(narrow.model), kDisc + 2 * kPi * 5 * 4, 1e-6);
  EXPECT_EQ(FindHoles(SurfaceOf(narrow.model), RunContext())->size(), 1U);
}

// The cap lies over the chamfer or rounding around the mouth, unless that is wider than asked.
TEST(CapHoles, Chamfers) {
  const TurnedFace chamfer{Line({4, 10}, {3, 9}), SurfaceKind::kCone};
  const TurnedFace rounding{Round({4, 10}, {3, 10}, {3, 9}), SurfaceKind::kTorus, 1};
  for (const TurnedFace& mouth : {chamfer, rounding}) {
    const PatchModel part = TurnedPart({kRim, Ring(20, 4, 10), mouth, Bore(3, 9, 0), Ring(3, 20, 0)});
    ExpectDisc(Capped(part, 8.0), kDisc);
    const CappedModel below = Capped(part, 6.0);  // the cap lies at the foot of the chamfer
    EXPECT_EQ(NetworkOf(below.model).euler_characteristic, 2);
    EXPECT_GT(AreaOf(below.model), kDisc);
    EXPECT_EQ(WarningsOf(below), 0);
  }
}

// A cap joins a mouth that is not plane to its middle, up to a tenth of the diameter.
TEST(CapHoles, MouthsOffTheirPlane) {
  const PatchModel part = TurnedPart({kRim, kTop, Bore(3, 10, 0), Ring(3, 20, 0)});
  for (const double bend : {0.5, 0.7}) {
    PatchModel bent = part;
    for (Patch& patch : bent.patches) {
      for (Vec3& p : std::get<BezierPatch>(patch.shape).points) {
        const double x = std::abs(p.x()), y = std::abs(p.y());  // a saddle
        if (p.z() == 10.0) p.z() += bend * (x - y) / std::max(x, y);
      }
    }
    EXPECT_EQ(WarningsOf(Capped(bent, 6.0)), bend < 0.6 ? 0 : 1);
  }
}

TEST(CapHoles, WiderHolesPinsAndModelsWithoutFacesStay) {
  const PatchModel part = TurnedPart({kRim, kTop, Bore(3, 10, 0), Ring(3, 20, 0)});
  const CappedModel same = Capped(part, 5.9);
  EXPECT_EQ(same.model.patches.size(), part.patches.size());
  EXPECT_EQ(same.findings.size(), 1U);
  EXPECT_NE(same.findings[0].message.find("0 holes"), std::string::npos);
  PatchModel plain = part;
  plain.faces.clear();
  for (Patch& patch : plain.patches) patch.face.reset();
  const CappedModel without = Capped(plain, 50.0);
  EXPECT_EQ(without.model.patches.size(), part.patches.size());
  ASSERT_EQ(without.findings.size(), 1U);
  EXPECT_EQ(without.findings[0].severity, Severity::kWarning);
  EXPECT_NE(without.findings[0].message.find("no faces"), std::string::npos);
}

// The diameter, and all that is said, are those of the placed model.
TEST(CapHoles, OfAModelThatIsScaled) {
  const PatchModel part = TurnedPart({kRim, kTop, Bore(3, 10, 0), Ring(3, 20, 0)});
  EXPECT_NE(Capped(part, 11.9, 2.0).findings[0].message.find("0 holes of at most 11.9 mm"),
            std::string::npos);
  const CappedModel capped = Capped(part, 12.0, 2.0);
  ExpectDisc(capped, kDisc);
  EXPECT_NE(capped.findings[0].message.find("1 hole of at most 12 mm closed by 2 caps: f3 (diameter 12 mm)"),
            std::string::npos)
      << capped.findings[0].message;
}

// The end of a tube is rounded from its bore to its outside. The cap ends where the rounding is highest, and
// its outer half stays.
TEST(CapHoles, ATubeKeepsItsRoundedEnd) {
  const TurnedFace outside = Pin(5, 0, 8), inner{Round({4, 9}, {3, 9}, {3, 8}), SurfaceKind::kTorus, 1},
                   outer{Round({5, 8}, {5, 9}, {4, 9}), SurfaceKind::kTorus, 1};
  const PatchModel tube = TurnedPart({outside, outer, inner, Bore(3, 8, 0), Ring(3, 5, 0)});
  const CappedModel capped = Capped(tube, 12.0);
  EXPECT_EQ(WarningsOf(capped), 0);
  EXPECT_EQ(NetworkOf(capped.model).euler_characteristic, 2);
  double highest = 0.0;
  for (const Patch& patch : capped.model.patches)
    highest = std::max(highest, Position(patch.shape, 1.0, 1.0).z());
  EXPECT_NEAR(highest, 9.0, 1e-12);
}

// A sheet whose hole ends at its border has one mouth.
TEST(CapHoles, HolesOfSheets) {
  const CappedModel capped = Capped(TurnedPart({kTop, Bore(3, 10, 2)}), 6.0);
  EXPECT_NEAR(AreaOf(capped.model), kPi * 20 * 20, 1e-6);
  EXPECT_EQ(WarningsOf(capped), 0);
}

// A hole into a hollow that is open elsewhere cannot be closed without closing that.
TEST(CapHoles, AHoleIntoAnOpenHollowStays) {
  // The bore ends in a cone that widens into a chamber open to below.
  const TurnedFace wide{Line({3, 8}, {12, 0}), SurfaceKind::kCone};
  const CappedModel capped = Capped(TurnedPart({kRim, kTop, Bore(3, 10, 8), wide, Ring(12, 20, 0)}), 6.0);
  // Its lower end is a mouth, and is capped there: the chamber stays.
  EXPECT_EQ(NetworkOf(capped.model).euler_characteristic, 2);
  EXPECT_EQ(WarningsOf(capped), 0);
}

// Where a quarter of the surface around the mouth is missing, no edges close around it.
TEST(CapHoles, ARimWithAGapStaysOpen) {
  PatchModel part = TurnedPart({kTop, Bore(3, 10, 4), Ring(3, 0, 4)});
  part.patches.erase(part.patches.begin() + 1);
  const CappedModel capped = Capped(part, 6.0);
  EXPECT_EQ(WarningsOf(capped), 1);
  EXPECT_EQ(capped.model.patches.size(), part.patches.size());
}

// Capping must not cut off a pin that stands in a hole.
TEST(CapHoles, APinThatStandsOutStays) {
  for (const double top : {15.0, 9.0}) {
    const CappedModel capped = Capped(
        TurnedPart({Ring(20, 3, 10), Bore(3, 10, 4), Ring(3, 2, 4), Pin(2, 4, top), Ring(2, 0, top)}), 6.0);
    EXPECT_EQ(WarningsOf(capped), top > 10.0 ? 1 : 0);
    if (top < 10.0) {
      EXPECT_NEAR(AreaOf(capped.model), kPi * 20 * 20, 1e-6);
    }
  }
}

// A hole in a slope is capped along it.
TEST(CapHoles, MouthsInSlopes) {
  PatchModel part = TurnedPart({kRim, kTop, Bore(3, 10, 0), Ring(3, 20, 0)});
  for (Patch& patch : part.patches) {
    for (Vec3& p : std::get<BezierPatch>(patch.shape).points) {
      if (p.z() == 10.0) p.z() += 0.4 * p.x();
    }
  }
  ExpectDisc(Capped(part, 6.0), kPi * 20 * 20 * (1 + std::hypot(1, 0.4)) + 2 * kPi * 20 * 10);
}

}  // namespace
}  // namespace patchmill
