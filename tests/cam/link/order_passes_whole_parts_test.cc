// The order of the passes of a whole part: hills from the top, pits from the rim inwards, one after the
// other.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "cam/link/order_passes.h"
#include "cam/path/contour/contour_paths.h"
#include "cam/path/parallel/zigzag_paths.h"
#include "cam/region/split_regions.h"
#include "tests/support/joined_surface.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

constexpr double kRadius = 2.0;

struct Feature {
  Vec2 at;
  double height;  // below 0: a pit
};
constexpr double kWide = 7.0;
const std::array<Feature, 4> kFeatures{
    {{{20, 20}, 12.0}, {{60, 24}, 9.0}, {{24, 60}, -10.0}, {{60, 62}, 11.0}}};

double HeightAt(double x, double y) {
  double z = 0.0;
  for (const Feature& f : kFeatures)
    z += f.height * std::exp(-(Vec2(x, y) - f.at).squaredNorm() / (2.0 * kWide * kWide));
  return z;
}

std::size_t FeatureOf(const CutterPath& path) {
  Vec2 middle = Vec2::Zero();
  for (const CutterPoint& p : path.points) middle += Xy(p.center) / static_cast<double>(path.points.size());
  const auto nearer = [&](const Feature& a, const Feature& b) {
    return (a.at - middle).norm() < (b.at - middle).norm();
  };
  return static_cast<std::size_t>(std::min_element(kFeatures.begin(), kFeatures.end(), nearer) -
                                  kFeatures.begin());
}

class OrderOfParts : public ::testing::Test {
 protected:
  OrderOfParts()
      : surface_(testing::JoinedSurface(
            testing::Single(testing::InterpolatedHeights(HeightAt, 0.0, 84.0, 0.0, 84.0, 40, 40)))),
        locator_(surface_, kRadius) {
    ContourParams steep;
    steep.pass.scallop = 0.02;
    steep.pass.window.min = Radians(25);
    const auto contours = ContourPaths(locator_, steep, RunContext());
    EXPECT_TRUE(contours.ok()) << contours.status();
    ZigzagParams gentle;
    gentle.pass.scallop = 0.05;
    gentle.pass.window.max = Radians(25);
    const auto lines = ZigzagPaths(locator_, gentle, RunContext());
    EXPECT_TRUE(lines.ok()) << lines.status();
    auto map = SplitRegions(surface_, {.radius = kRadius, .steep_angle = Radians(25)}, RunContext());
    EXPECT_TRUE(map.ok()) << map.status();
    std::vector<CutterPath> all = *lines;
    all.insert(all.end(), contours->paths.begin(), contours->paths.end());
    for (CutterPath& path : all) {
      const auto& middle = path.points[path.points.size() / 2];
      if (middle.contact) path.region = map->At(*middle.contact);
    }
    count_ = all.size();
    lines_ = lines->size();
    auto ordered = OrderPasses(*map, std::move(all),
                               {.neighbor_distance = kRadius,
                                .at_hand = 2.0 * kRadius,
                                .travel = [](const Vec3& a, const Vec3& b) { return (b - a).norm(); }},
                               RunContext(1));
    EXPECT_TRUE(ordered.ok()) << ordered.status();
    ordered_ = *std::move(ordered);
  }
  static double Step() { return 2.0 * std::sqrt(2.0 * kRadius * 0.05); }

  std::vector<const CutterPath*> Of(PassKind kind) const {
    std::vector<const CutterPath*> paths;
    for (const CutterPath& path : ordered_)
      if (path.kind == kind) paths.push_back(&path);
    return paths;
  }

  Surface surface_;
  Locator locator_;
  std::size_t count_ = 0, lines_ = 0;
  std::vector<CutterPath> ordered_;
};

TEST_F(OrderOfParts, OneHillOrPitAfterTheOther) {
  const auto contours = Of(PassKind::kContour);
  ASSERT_EQ(ordered_.size(), count_);
  ASSERT_GT(contours.size(), 80u);
  int changes = 0;
  std::array<int, 4> passes{};
  for (std::size_t i = 0; i < contours.size(); ++i) {
    ++passes[FeatureOf(*contours[i])];
    changes += i > 0 && FeatureOf(*contours[i]) != FeatureOf(*contours[i - 1]);
  }
  EXPECT_EQ(changes, 3);
  for (const int count : passes) EXPECT_GT(count, 10);
}

TEST_F(OrderOfParts, EachFromTheTop) {
  // On a hill that is outwards, in a pit inwards.
  const auto contours = Of(PassKind::kContour);
  for (std::size_t i = 1; i < contours.size(); ++i) {
    const std::size_t feature = FeatureOf(*contours[i]);
    if (feature != FeatureOf(*contours[i - 1])) continue;
    const Vec3 before = contours[i - 1]->points.front().center, now = contours[i]->points.front().center;
    EXPECT_LE(now.z(), before.z()) << i;
    const double out = (Xy(now) - kFeatures[feature].at).norm() - (Xy(before) - kFeatures[feature].at).norm();
    if (now.z() < before.z() - 1e-3) {
      EXPECT_GT(kFeatures[feature].height > 0 ? out : -out, 0.0) << i;
    }
  }
}

TEST_F(OrderOfParts, CapThenFlankThenSurfaceThenWallThenFloor) {
  // Of each feature: the place in the order of its first and last contour, and of the lines on its cap or
  // floor.
  struct Span {
    std::size_t first = std::numeric_limits<std::size_t>::max(), last = 0;
    void Add(std::size_t i) {
      first = std::min(first, i);
      last = std::max(last, i);
    }
  };
  std::array<Span, 4> steep, end, around;
  for (std::size_t i = 0; i < ordered_.size(); ++i) {
    const std::size_t feature = FeatureOf(ordered_[i]);
    if (ordered_[i].kind == PassKind::kContour) {
      steep[feature].Add(i);
    } else {
      double near = kInfinity, far = 0.0;
      for (const CutterPoint& p : ordered_[i].points) {
        const double distance = (Xy(p.center) - kFeatures[feature].at).norm();
        near = std::min(near, distance);
        far = std::max(far, distance);
      }
      if (far < kWide) end[feature].Add(i);
      if (far > kWide && near < 2.2 * kWide) around[feature].Add(i);  // slopes end at about 2 kWide
    }
  }
  for (std::size_t f = 0; f < kFeatures.size(); ++f) {
    const bool hill = kFeatures[f].height > 0;
    for (const Span* span : {&steep[f], &end[f], &around[f]}) EXPECT_LE(span->first, span->last) << f;
    const Span &upper = hill ? end[f] : around[f], &lower = hill ? around[f] : end[f];
    EXPECT_LT(upper.last, steep[f].first) << f;
    EXPECT_LT(steep[f].last, lower.first) << f;
    // One hill with all that is on it before the next.
    for (std::size_t g = 0; g < kFeatures.size(); ++g) {
      if (g == f || !hill || kFeatures[g].height < 0) continue;
      EXPECT_TRUE(steep[g].last < end[f].first || end[g].first > steep[f].last) << f << " and " << g;
    }
  }
}

// Caps and flanks of many equal domes are two regions; each dome is cut from its top before the next.
TEST(OrderOfEqualParts, OneDomeAfterTheOther) {
  constexpr int kDomes = 24;
  constexpr double kApart = 20.0, kDome = 6.0;
  PatchModel model;
  for (int i = 0; i < kDomes; ++i) {
    const PatchModel dome =
        testing::Sphere({i % 4 * kApart, i / 4 * kApart, 0.0}, kDome, testing::Half::kUpper);
    model = i == 0 ? dome : testing::Join({model, dome});
  }
  const Surface surface = testing::JoinedSurface(model);
  const Locator locator(surface, kRadius);
  ContourParams steep;
  steep.pass.scallop = 0.05;
  steep.pass.window.min = Radians(45);
  std::vector<CutterPath> all = ContourPaths(locator, steep, RunContext())->paths;
  ZigzagParams gentle;
  gentle.pass.scallop = 0.05;
  gentle.pass.window.max = Radians(45);
  const std::vector<CutterPath> lines = *ZigzagPaths(locator, gentle, RunContext());
  all.insert(all.end(), lines.begin(), lines.end());
  const RegionMap map = *SplitRegions(surface, {.radius = kRadius}, RunContext());
  ASSERT_LT(map.regions.size(), 20u);
  ASSERT_GE(map.component_region.size(), 2u * kDomes);
  for (CutterPath& path : all) {
    const auto& middle = path.points[path.points.size() / 2];
    if (middle.contact) path.region = map.At(*middle.contact);
  }
  const auto ordered =
      OrderPasses(map, all, {.neighbor_distance = kRadius, .at_hand = 2.0 * kRadius}, RunContext(1));
  ASSERT_TRUE(ordered.ok()) << ordered.status();
  ASSERT_EQ(ordered->size(), all.size());
  const auto dome_of = [&](const CutterPath& path) {
    const Vec3& p = path.points.front().center;
    return std::lround(p.x() / kApart) + 4 * std::lround(p.y() / kApart);
  };
  int changes = 0;
  bool contours = false;  // of the dome that is being cut
  for (std::size_t i = 0; i < ordered->size(); ++i) {
    const CutterPath& path = (*ordered)[i];
    const bool next = i > 0 && dome_of(path) != dome_of((*ordered)[i - 1]);
    changes += next;
    contours = (contours && !next) || path.kind == PassKind::kContour;
    EXPECT_FALSE(contours && path.kind == PassKind::kZigzag) << i;
  }
  EXPECT_EQ(changes, kDomes - 1);
}

TEST_F(OrderOfParts, LinesGoToAndFro) {
  const auto lines = Of(PassKind::kZigzag);
  ASSERT_EQ(lines.size(), lines_);
  // But for few jumps around the hills the next line begins where the last one ended.
  std::size_t jumps = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const Vec3 gap = lines[i]->points.front().center - lines[i - 1]->points.back().center;
    jumps += Xy(gap).norm() > 6.0 * Step();
  }
  EXPECT_LE(jumps, lines.size() / 8) << lines.size();
}

}  // namespace
}  // namespace patchmill
