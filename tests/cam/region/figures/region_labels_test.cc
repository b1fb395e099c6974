// Which region each cell of the lookup grid belongs to: all of them can be found there.
#include "cam/region/figures/region_labels.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

// The square in three: below the line v = 0.5, above it, and a speck in the middle of a cell's side.
struct Specks {
  std::vector<SplitMesh> meshes{1};
  PerTriangle<RegionId> region_of{1};

  void Add(const Vec2& a, const Vec2& b, const Vec2& c, int region) {
    SplitMesh& mesh = meshes[0];
    SplitTriangle triangle;
    int k = 0;
    for (const Vec2& q : {a, b, c}) {
      triangle.vertex[static_cast<std::size_t>(k++)] = static_cast<int>(mesh.vertices.size());
      ZeroVertex vertex;
      vertex.u = q.x();
      vertex.v = q.y();
      mesh.vertices.push_back(vertex);
    }
    mesh.triangles.push_back(triangle);
    region_of[0].push_back(RegionId(region));
  }
};

RegionLabels Labelled(const Specks& specks, std::size_t regions) {
  TriangleRegions triangles;
  triangles.region_count = regions;
  triangles.region_of = specks.region_of;
  const auto labels = LabelCells(specks.meshes, triangles, RunContext());
  EXPECT_TRUE(labels.ok()) << labels.status();
  return labels.value_or(RegionLabels());
}

std::size_t CellsOf(const RegionLabels& map, int id) {
  return static_cast<std::size_t>(std::count(map.labels[0].begin(), map.labels[0].end(), RegionId(id)));
}

Specks Halves() {
  Specks specks;
  specks.Add({0, 0}, {1, 0}, {1, 0.5}, 0);
  specks.Add({0, 0}, {1, 0.5}, {0, 0.5}, 0);
  specks.Add({0, 0.5}, {1, 0.5}, {1, 1}, 1);
  specks.Add({0, 0.5}, {1, 1}, {0, 1}, 1);
  return specks;
}

TEST(RegionLabels, FollowTheTriangles) {
  const RegionLabels map = Labelled(Halves(), 2);
  ASSERT_EQ(map.cells, 256);
  for (int i = 0; i < 256; ++i)
    for (int j = 0; j < 256; ++j)
      ASSERT_EQ(map.labels[0][static_cast<std::size_t>(256 * i + j)].value, j < 128 ? 0 : 1) << i << " " << j;
}

TEST(RegionLabels, GiveACellToWhatHoldsNoCellsCentre) {
  Specks specks = Halves();
  const double cell = 1.0 / 256, x = 100 * cell, y = 40 * cell;
  specks.Add({x + 0.1 * cell, y + 0.1 * cell}, {x + 0.3 * cell, y + 0.1 * cell},
             {x + 0.1 * cell, y + 0.3 * cell}, 2);
  const RegionLabels map = Labelled(specks, 3);
  EXPECT_EQ(CellsOf(map, 2), 1u);
  EXPECT_EQ(map.labels[0][256 * 100 + 40], RegionId(2));
  EXPECT_EQ(CellsOf(map, 0), 128u * 256 - 1);
}

TEST(RegionLabels, TakeNoRegionsOnlyCell) {
  Specks specks = Halves();
  const double cell = 1.0 / 256, x = 100 * cell, y = 40 * cell;
  for (const int id : {2, 3}) {
    const double at = 0.1 + 0.5 * (id - 2);
    specks.Add({x + at * cell, y + 0.1 * cell}, {x + (at + 0.2) * cell, y + 0.1 * cell},
               {x + at * cell, y + 0.3 * cell}, id);
  }
  const RegionLabels crowded = Labelled(specks, 4);
  EXPECT_EQ(CellsOf(crowded, 2), 1u);
  EXPECT_EQ(CellsOf(crowded, 3), 0u);
  // Unless another of its triangles is elsewhere.
  specks.Add({x + 1.1 * cell, y}, {x + 1.3 * cell, y}, {x + 1.1 * cell, y + 0.3 * cell}, 3);
  const RegionLabels both = Labelled(specks, 4);
  EXPECT_EQ(CellsOf(both, 2), 1u);
  EXPECT_EQ(CellsOf(both, 3), 1u);
}

}  // namespace
}  // namespace patchmill
