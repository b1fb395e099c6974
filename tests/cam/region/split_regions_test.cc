#include "cam/region/split_regions.h"

#include <cmath>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "cam/limits/reach_tolerance.h"
#include "core/surface/closest.h"
#include "core/surface/surface.h"
#include "tests/support/fuzz.h"
#include "tests/support/model_table.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Half;

Surface Build(const PatchModel& model) {
  PatchNetwork network;
  network.model = model;
  network.join_tolerance = 1e-4;
  auto surface = BuildSurface(std::move(network), SurfaceParams{}, RunContext{});
  EXPECT_TRUE(surface.ok()) << surface.status();
  return *std::move(surface);
}

RegionMap Split(const Surface& surface, const RegionParams& params, int threads = 0) {
  auto map = SplitRegions(surface, params, RunContext(threads));
  EXPECT_TRUE(map.ok()) << map.status();
  return *std::move(map);
}

double Area(const RegionMap& map, RegionKind kind) {
  double sum = 0.0;
  for (const Region& r : map.regions) sum += r.kind == kind ? r.area : 0.0;
  return sum;
}

double Area(const RegionMap& map, UnreachableReason reason) {
  double sum = 0.0;
  for (const Region& r : map.regions) sum += r.reason == reason ? r.area : 0.0;
  return sum;
}

double Total(const RegionMap& map) {
  double sum = 0.0;
  for (const Region& r : map.regions) sum += r.area;
  return sum;
}

RegionParams Unmerged() {
  RegionParams p;
  p.detail = 1.0;
  p.border_tolerance = 1e-4;
  return p;
}

TEST(SplitRegions, TorusHasAnOuterMountainAndAnInnerBasin) {
  const Surface surface = Build(testing::Torus(Vec3::Zero(), 20, 6, Half::kUpper));
  const RegionMap map = Split(surface, Unmerged());
  EXPECT_NEAR(Area(map, RegionKind::kMountain), kPi * 6 * (kPi * 20 + 2 * 6), 0.05);
  EXPECT_NEAR(Area(map, RegionKind::kBasin), kPi * 6 * (kPi * 20 - 2 * 6), 0.05);
  EXPECT_EQ(Area(map, RegionKind::kUnreachable), 0.0);
  // Mountain and basin, each steep below and gentle above: four bands.
  EXPECT_EQ(map.regions.size(), 4u);
  for (const Region& r : map.regions) EXPECT_GE(r.border.size(), 1u) << r.id.value;
}

// A roof of a gentle and a steep plane: each region knows its patch.
TEST(SplitRegions, RegionsNameTheirPatches) {
  PatchModel model;
  const auto plane = [&](double x0, double z0, double x1, double z1) {
    model.patches.push_back(
        {"", BezierPatch{1, 1, {{x0, 0, z0}, {x0, 20, z0}, {x1, 0, z1}, {x1, 20, z1}}, {}}});
  };
  plane(0, 20, 20, 0);    // steeper than 30 degrees
  plane(-20, 18, 0, 20);  // gentler
  plane(-40, 16, -20, 18);
  RegionParams params = Unmerged();
  params.steep_angle = Radians(30.0);
  const RegionMap map = Split(Build(model), params);
  ASSERT_EQ(map.regions.size(), 2u);
  for (const Region& region : map.regions) {
    const bool steep = region.slope == SlopeClass::kSteep;
    EXPECT_EQ(region.patches,
              steep ? std::vector<PatchId>{PatchId(0)} : (std::vector<PatchId>{PatchId(1), PatchId(2)}));
  }
}

TEST(SplitRegions, SteepAndGentleMeetAtTheSplitAngle) {
  const Surface surface = Build(testing::Sphere(Vec3::Zero(), 10, Half::kUpper));
  for (const double degrees : {30.0, 45.0, 70.0}) {
    RegionParams params = Unmerged();
    params.steep_angle = Radians(degrees);
    const RegionMap map = Split(surface, params);
    double steep = 0.0, gentle = 0.0;
    for (const Region& r : map.regions) (r.slope == SlopeClass::kSteep ? steep : gentle) += r.area;
    // The cap above the polar angle t has the area 2 pi r^2 (1 - cos t).
    EXPECT_NEAR(gentle, 2 * kPi * 100 * (1 - std::cos(Radians(degrees))), 0.02) << degrees;
    EXPECT_NEAR(steep, 2 * kPi * 100 * std::cos(Radians(degrees)), 0.02) << degrees;
    for (const Region& r : map.regions) {
      EXPECT_EQ(r.kind, RegionKind::kMountain);
      if (r.slope != SlopeClass::kGentle) continue;
      ASSERT_EQ(r.border.size(), 1u);
      for (const Vec3& p : r.border[0]) EXPECT_NEAR(p.z(), 10 * std::cos(Radians(degrees)), 2e-4);
    }
  }
}

TEST(SplitRegions, SaddleHasFourSectors) {
  // z = .05 x^2 - .03 y^2: D = 0 on y = sqrt(a/b) x, both signs.
  const double a = 0.05, b = 0.03;
  const Surface surface = Build(testing::Saddle(a, b, 8));
  RegionParams params = Unmerged();
  params.radius = 1.0;
  params.steep_angle = Radians(85);
  const RegionMap map = Split(surface, params);
  int mountains = 0, basins = 0;
  for (const Region& r : map.regions) {
    mountains += r.kind == RegionKind::kMountain;
    basins += r.kind == RegionKind::kBasin;
    for (const auto& loop : r.border) {
      for (const Vec3& p : loop) {
        const bool outer = std::max(std::abs(p.x()), std::abs(p.y())) > 8 - 1e-9;
        const double off = std::abs(std::abs(p.y()) - std::sqrt(a / b) * std::abs(p.x()));
        EXPECT_TRUE(outer || off < 2e-3) << p.transpose();
      }
    }
  }
  EXPECT_EQ(mountains, 2);
  EXPECT_EQ(basins, 2);
}

TEST(SplitRegions, PlaneIsNeutralAndWhole) {
  const Surface surface = Build(testing::Plane(20, 0, 0.3, 0.1));
  const RegionMap map = Split(surface, RegionParams{});
  ASSERT_EQ(map.regions.size(), 1u);
  EXPECT_EQ(map.regions[0].kind, RegionKind::kNeutral);
  EXPECT_EQ(map.regions[0].slope, SlopeClass::kGentle);
  EXPECT_NEAR(map.regions[0].area, 1600 * std::sqrt(1 + 0.09 + 0.01), 1e-9);
  ASSERT_EQ(map.regions[0].border.size(), 1u);
}

TEST(SplitRegions, HemisphereOnAPlaneLeavesWhatTheBallCannotTouch) {
  const double r = 8, R = 3, reach_tolerance = 0.01;
  const PatchModel model =
      testing::Join({testing::Plane(20), testing::Sphere(Vec3::Zero(), r, Half::kUpper)});
  const Surface surface = Build(model);
  RegionParams params = Unmerged();
  params.tolerance = 2.0 * reach_tolerance;
  const RegionMap map = Split(surface, params);
  EXPECT_NEAR(Total(map), 1600 + 2 * kPi * r * r, 0.05);
  // Plane: everything nearer to the axis than a ball of R - g that stands R high and touches the sphere.
  // Sphere: everything lower than where a ball that touches it comes down to R - g.
  const double ring = kPi * ((r + R - reach_tolerance) * (r + R - reach_tolerance) - R * R);
  const double band = 2 * kPi * r * (R - reach_tolerance) * r / (r + R);
  EXPECT_NEAR(Area(map, RegionKind::kUnreachable), ring + band, 0.005 * (ring + band));
  EXPECT_GT(Area(map, UnreachableReason::kUndercut), 0.0);
  EXPECT_GT(Area(map, UnreachableReason::kConcave), band * 0.99);
}

TEST(SplitRegions, FloorTakesWhatLiesTooDeep) {
  const Surface surface = Build(testing::Sphere(Vec3::Zero(), 10, Half::kUpper));
  RegionParams params = Unmerged();
  params.floor_z = 0.0;
  params.tolerance = 0.01;
  const RegionMap map = Split(surface, params);
  // Tip = p_z + R e_z - R with p_z = 10 e_z: below the floor by more than the reach tolerance g for e_z < (R
  // - g) / (10 + R).
  const double lowest = (3.0 - ReachTolerance(params.tolerance)) / 13.0;
  EXPECT_NEAR(Area(map, UnreachableReason::kFloor), 2 * kPi * 100 * lowest, 0.05);
}

// A ramp whose slope sways about the split angle, in bands larger than any area that is merged for its size.
TEST(SplitRegions, ASlopeThatSwaysAboutTheSplitAngleDividesNothing) {
  const auto ramp = [](double sway) {
    const double k = kPi / 10.0;
    const auto height = [=](double x, double) { return x + sway / k * std::sin(k * x); };
    const Surface surface = Build(testing::Single(testing::InterpolatedHeights(height, 0, 60, 0, 40, 60, 8)));
    RegionParams params;
    params.floor_z = -100.0;
    int count = 0;
    for (const Region& r : Split(surface, params).regions) count += r.kind != RegionKind::kUnreachable;
    return count;
  };
  EXPECT_EQ(ramp(0.03), 1);  // by one degree
  EXPECT_GE(ramp(0.6), 6);   // from 22 to 58 degrees
}

// By Gauss' rule of five points, so many times in each direction of each piece.
double AreaByQuadrature(const Surface& surface, int parts = 8) {
  const double inner = std::sqrt(5.0 - 2.0 * std::sqrt(10.0 / 7.0)) / 3.0;
  const double outer = std::sqrt(5.0 + 2.0 * std::sqrt(10.0 / 7.0)) / 3.0;
  const double w_inner = (322.0 + 13.0 * std::sqrt(70.0)) / 900.0;
  const double w_outer = (322.0 - 13.0 * std::sqrt(70.0)) / 900.0;
  const std::pair<double, double> rule[] = {
      {-outer, w_outer}, {-inner, w_inner}, {0.0, 128.0 / 225.0}, {inner, w_inner}, {outer, w_outer}};
  double area = 0.0;
  for (const Piece& piece : surface.pieces) {
    for (int cell = 0; cell < parts * parts; ++cell) {
      for (const auto& [x, weight_x] : rule) {
        for (const auto& [y, weight_y] : rule) {
          const SurfaceJet jet =
              Evaluate(piece, (cell / parts + 0.5 + 0.5 * x) / parts, (cell % parts + 0.5 + 0.5 * y) / parts);
          area += 0.25 * weight_x * weight_y / (parts * parts) * jet.du.cross(jet.dv).norm();
        }
      }
    }
  }
  return area;
}

// This holds for any surface and any detail.
TEST(SplitRegions, OfAnyPartAreLargeClosedAndTileIt) {
  std::vector<std::pair<std::string, PatchModel>> parts;
  if (!testing::kSanitized) parts.emplace_back("bumpy", testing::Bumpy());  // minutes otherwise
  for (const std::uint64_t seed : {1u, 2u, 3u})
    parts.emplace_back("random " + std::to_string(seed), testing::RandomBspline(seed));
  for (const auto& [name, model] : parts) {
    SCOPED_TRACE(name);
    const Surface surface = Build(model);
    RegionParams params;
    const RegionMap map = Split(surface, params);
    params.detail = 1.0;
    const RegionMap raw = Split(surface, params);
    const double area = AreaByQuadrature(surface);
    EXPECT_NEAR(Total(map), area, 1e-6 * area);
    EXPECT_NEAR(Total(raw), area, 1e-6 * area);

    // Regions that have a reachable neighbour are no smaller than a turn of the ball.
    std::vector<bool> has_neighbour(map.regions.size(), false);
    const auto reached = [&](RegionId id) {
      return id != kNoRegion && map.regions[id.index()].kind != RegionKind::kUnreachable;
    };
    for (const BorderLine& line : map.border_lines) {
      if (!reached(line.region) || !reached(line.other)) continue;
      has_neighbour[line.region.index()] = true;
      has_neighbour[line.other.index()] = true;
    }
    int counted = 0;
    for (const Region& r : map.regions) {
      EXPECT_GT(r.area, 0.0);
      counted += has_neighbour[r.id.index()];
      EXPECT_GE(r.area, has_neighbour[r.id.index()] ? 2 * kPi * 9 : 0.0) << r.id.value;
      ASSERT_FALSE(r.border.empty());
      for (const auto& loop : r.border) {
        ASSERT_GE(loop.size(), 3u);
        // Closed along the surface: no step leaves it, the last one to the first point neither.
        double farthest = 0.0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const Vec3 middle = 0.5 * (loop[i] + loop[(i + 1) % loop.size()]);
          const auto at = ClosestToPoint(surface, middle, 1.0, 1e-4);
          farthest = std::max(farthest, at ? at->distance : 1.0);
        }
        EXPECT_LE(farthest, 2.0 * params.border_tolerance) << r.id.value;
      }
    }
    EXPECT_LE(counted, 20);  // 40 times the detail

    // Merging only groups. Most of the surface keeps the label of the split, and the unreachable area is the
    // same except for single cells that belong to specks of the raw split.
    ASSERT_EQ(map.cells, raw.cells);
    int cells = 0, relabelled = 0, turned = 0;
    for (std::size_t piece = 0; piece < map.labels.size(); ++piece) {
      for (std::size_t k = 0; k < map.labels[piece].size(); ++k) {
        const RegionId label = map.labels[piece][k], was = raw.labels[piece][k];
        ASSERT_LT(label.index(), map.regions.size());  // kNoRegion has no index below
        const Region &now = map.regions[label.index()], &then = raw.regions[was.index()];
        turned += (now.kind == RegionKind::kUnreachable) != (then.kind == RegionKind::kUnreachable);
        ++cells;
        relabelled += now.kind != then.kind || now.slope != then.slope;
      }
    }
    EXPECT_LE(relabelled, cells / 2);
    EXPECT_LE(turned, cells / 100000);
  }
}

// Gregory and rational patches, triangles, collapsed edges: whatever the pieces are.
TEST(SplitRegions, TileTheModelsAtHand) {
  const std::vector<testing::TableRow> table = testing::ModelTable();
  for (std::size_t k = 0; k < table.size(); ++k) {
    const testing::TableRow& row = table[k];
    if (k % 3 != 1 && !testing::LongTests()) continue;
    SCOPED_TRACE(row.file);
    const auto model = testing::ModelOf(row);
    if (!model) continue;
    const Surface surface = Build(*model);
    const double area = AreaByQuadrature(surface, 32);
    EXPECT_NEAR(Total(Split(surface, RegionParams())), area, 2e-7 * area);
  }
}

// Equal features are one region with one component for each of them. Borders know their components.
TEST(SplitRegions, RegionsFallIntoComponents) {
  constexpr int kCount = 24;
  PatchModel model;
  for (int k = 0; k < kCount; ++k)
    model = testing::Join({model, testing::Torus(Vec3(60.0 * k, 0, 0), 14, 5, testing::Half::kUpper)});
  const Surface surface = Build(model);
  const RegionMap map = Split(surface, RegionParams());
  ASSERT_FALSE(map.components.empty());
  EXPECT_TRUE(std::is_sorted(map.component_region.begin(), map.component_region.end()));
  const std::size_t pieces = surface.pieces.size() / kCount;  // of each torus
  std::vector<std::set<std::size_t>> tori(map.component_region.size());
  std::vector<std::set<ComponentId>> components(map.regions.size());
  for (std::size_t piece = 0; piece < map.labels.size(); ++piece) {
    for (std::size_t cell = 0; cell < map.labels[piece].size(); ++cell) {
      const ComponentId component = map.ComponentAt(piece, cell);
      const RegionId label = map.labels[piece][cell];
      ASSERT_NE(component, kNoComponent);
      ASSERT_EQ(map.component_region[component.index()], label);
      tori[component.index()].insert(piece / pieces);
      components[label.index()].insert(component);
    }
  }
  bool all_in_one = false;
  for (const Region& region : map.regions) {
    if (region.kind == RegionKind::kUnreachable) continue;
    // The steep area outside and inside it, or its crest.
    const double each = region.area / static_cast<double>(components[region.id.index()].size());
    EXPECT_LT(each, 1000.0);
    all_in_one = all_in_one || components[region.id.index()].size() >= kCount;
    for (const ComponentId component : components[region.id.index()])
      EXPECT_EQ(tori[component.index()].size(), 1u);
  }
  EXPECT_TRUE(all_in_one);
  for (const BorderLine& line : map.border_lines) {
    EXPECT_EQ(map.component_region[line.component.index()], line.region);
    if (line.other != kNoRegion) {
      EXPECT_EQ(map.component_region[line.other_component.index()], line.other);
      EXPECT_EQ(tori[line.component.index()], tori[line.other_component.index()]);
    } else {
      EXPECT_EQ(line.other_component, kNoComponent);
    }
  }
}

TEST(SplitRegions, DoesNotDependOnThreads) {
  const Surface surface = Build(testing::RandomBspline(7));
  const RegionMap one = Split(surface, RegionParams{}, 1), two = Split(surface, RegionParams{}, 2);
  ASSERT_EQ(one.regions.size(), two.regions.size());
  for (std::size_t i = 0; i < one.regions.size(); ++i) {
    EXPECT_EQ(one.regions[i].area, two.regions[i].area);
    EXPECT_EQ(one.regions[i].border, two.regions[i].border);
  }
  EXPECT_EQ(one.labels, two.labels);
}

TEST(SplitRegions, CancelIsObeyed) {
  const Surface surface = Build(testing::RandomBspline(7));
  RunContext run;
  run.Cancel();
  EXPECT_EQ(SplitRegions(surface, RegionParams{}, run).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
