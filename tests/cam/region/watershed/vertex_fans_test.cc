#include "cam/region/watershed/vertex_fans.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

using Lists = std::vector<std::vector<int>>;  // corners around each vertex, the plain way

void ExpectSame(const VertexFans& fans, const Lists& lists) {
  for (std::size_t v = 0; v < lists.size(); ++v) {
    std::vector<int> triangles, expected;
    fans.ForEach(static_cast<int>(v), [&](int t) { triangles.push_back(t); });
    for (const int corner : lists[v]) expected.push_back(corner / 3);
    EXPECT_EQ(triangles, expected) << "vertex " << v;
  }
}

TEST(VertexFans, AreThePlainListsThroughAllChanges) {
  constexpr std::size_t kVertices = 40;
  testing::Random random(5);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random.Int(static_cast<int>(n))); };
  std::vector<SplitTriangle> triangles(100);
  Lists lists(kVertices + 1);  // the last one has no triangles
  int corner = 0;
  for (SplitTriangle& t : triangles) {
    const std::size_t first = below(kVertices);
    for (std::size_t k = 0; k < 3; ++k) {
      t.vertex[k] = static_cast<int>((first + k * 7) % kVertices);
      lists[static_cast<std::size_t>(t.vertex[k])].push_back(corner++);
    }
  }
  VertexFans fans(triangles, kVertices + 1);
  ExpectSame(fans, lists);

  for (int change = 0; change < 300; ++change) {
    const auto v = below(lists.size());
    if (change % 10 == 0) {
      fans.AddVertex();
      lists.emplace_back();
    }
    fans.AddTriangle();  // corners `corner` to corner + 2
    if (!lists[v].empty() && change % 3 != 0) {
      int& old = lists[v][below(lists[v].size())];
      fans.Replace(static_cast<int>(v), old, corner);
      const auto other = below(lists.size());  // as a cut triangle's corner goes to the new vertex
      fans.Append(static_cast<int>(other), old);
      const int freed = old;
      old = corner;
      lists[other].push_back(freed);
    } else {
      fans.Append(static_cast<int>(v), corner);
      lists[v].push_back(corner);
    }
    corner += 3;
    ExpectSame(fans, lists);
  }
}

}  // namespace
}  // namespace patchmill
