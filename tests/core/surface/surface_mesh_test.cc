#include "core/surface/surface_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "tests/core/surface/surface_models.h"

namespace patchmill {
namespace {

using testing::MakeSurface;

std::vector<PieceTriangles> Mesh(const Surface& surface, const MeshParams& params, int threads = 2) {
  auto mesh = MakeSurfaceMesh(surface, params, RunContext(threads));
  EXPECT_TRUE(mesh.ok()) << mesh.status();
  return *std::move(mesh);
}

double AreaOf(const PieceTriangles& piece, const MeshTriangle& t) {
  const Vec3 &a = piece.vertices[t.vertices[0]].at.p, &b = piece.vertices[t.vertices[1]].at.p,
             &c = piece.vertices[t.vertices[2]].at.p;
  return 0.5 * (b - a).cross(c - a).norm();
}

// A label in each quarter of the unit circle around a corner of the parameters, as a grid of cells has it.
constexpr int kLabelCells = 64;
int Quarter(PieceId, double u, double v) {
  const auto cell = [](double t) {
    return (std::min(kLabelCells - 1, static_cast<int>(t * kLabelCells)) + 0.5) / kLabelCells;
  };
  return std::hypot(cell(u), cell(v)) < 0.7 ? 1 : 0;
}

class EverySurfaceMesh : public ::testing::TestWithParam<testing::NamedModel> {};

// Each side of a triangle inside a piece is a side of another triangle, the other way round. Sides at a pole
// count by their places, because triangles without an area are left out there.
TEST_P(EverySurfaceMesh, IsClosedWithinEachPieceAndLiesOnTheSurface) {
  const Surface s = MakeSurface(GetParam().model);
  for (const bool labels : {false, true}) {
    MeshParams params{.chord = 0.05};
    if (labels) {
      params.label = Quarter;
      params.label_cells = kLabelCells;
    }
    for (const PieceTriangles& piece : Mesh(s, params)) {
      using Place = std::array<double, 3>;
      const auto place = [&](std::uint32_t v) {
        const Vec3& p = piece.vertices[v].at.p;
        const auto micro = [](double x) { return std::round(x * 1e9) * 1e-9 + 0.0; };  // poles are rounded
        return Place{micro(p.x()), micro(p.y()), micro(p.z())};
      };
      // The four borders, by places: at a pole, all of one border is a place of its neighbours.
      std::array<std::set<Place>, 4> borders;
      for (std::uint32_t v = 0; v < piece.vertices.size(); ++v) {
        const SurfacePoint& at = piece.vertices[v].at;
        for (const auto& [border, on] :
             {std::pair{0u, at.u == 0.0}, {1u, at.u == 1.0}, {2u, at.v == 0.0}, {3u, at.v == 1.0}})
          if (on) borders[border].insert(place(v));
      }
      const auto on_border = [&](std::uint32_t a, std::uint32_t b) {
        return std::any_of(borders.begin(), borders.end(), [&](const std::set<Place>& border) {
          return border.contains(place(a)) && border.contains(place(b));
        });
      };
      std::map<std::pair<Place, Place>, int> open;  // sides inside the piece without their other triangle
      for (const MeshTriangle& t : piece.triangles) {
        const SurfacePoint &a = piece.vertices[t.vertices[0]].at, &b = piece.vertices[t.vertices[1]].at,
                           &c = piece.vertices[t.vertices[2]].at;
        EXPECT_GT((b.u - a.u) * (c.v - a.v) - (c.u - a.u) * (b.v - a.v), 0.0) << "turned round or empty";
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t from = t.vertices[k], to = t.vertices[(k + 1) % 3];
          if (on_border(from, to)) continue;
          const auto other = open.find({place(to), place(from)});
          if (other == open.end()) {
            ++open[{place(from), place(to)}];
          } else if (--other->second == 0) {
            open.erase(other);
          }
        }
      }
      EXPECT_TRUE(open.empty()) << open.size() << " open sides";
      for (const MeshVertex& vertex : piece.vertices)
        EXPECT_LT((vertex.at.p - Position(s.piece(piece.piece), vertex.at.u, vertex.at.v)).norm(), 1e-11);
    }
  }
}

TEST_P(EverySurfaceMesh, IsTheSameOnOneThreadAndTwo) {
  const Surface s = MakeSurface(GetParam().model);
  const MeshParams params{.chord = 0.1, .label = Quarter, .label_cells = kLabelCells};
  const auto one = Mesh(s, params, 1), two = Mesh(s, params, 2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    ASSERT_EQ(one[k].triangles.size(), two[k].triangles.size());
    for (std::size_t i = 0; i < one[k].triangles.size(); ++i) {
      EXPECT_EQ(one[k].triangles[i].vertices, two[k].triangles[i].vertices);
      EXPECT_EQ(one[k].triangles[i].label, two[k].triangles[i].label);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(SurfaceMesh, EverySurfaceMesh, ::testing::ValuesIn(testing::EveryKindOfPatch()),
                         [](const auto& model) { return model.param.name; });

// The area of an inscribed mesh is below 4 pi r^2, and above that of the ball that the chord is cut from.
TEST(SurfaceMesh, OfASphereHasItsAreaSlopeAndCurvature) {
  const Vec3 center(1, 2, 3);
  constexpr double kR = 7.0, kChord = 0.002;
  const Surface s = MakeSurface(testing::Sphere(center, kR));
  double area = 0.0;
  for (const PieceTriangles& piece : Mesh(s, {.chord = kChord})) {
    for (const MeshTriangle& t : piece.triangles) area += AreaOf(piece, t);
    for (const MeshVertex& vertex : piece.vertices) {
      const Vec3 out = (vertex.at.p - center) / kR;
      EXPECT_NEAR(std::abs(vertex.normal.dot(out)), 1.0, 1e-9);
      EXPECT_NEAR(std::abs(std::cos(vertex.slope)), std::abs(out.z()), 1e-9);
      // The normal curvature along a level circle of a sphere is 1 / r everywhere.
      const double level = std::hypot(out.x(), out.y());
      if (level > 1e-3) {
        EXPECT_NEAR(std::abs(vertex.contour_curvature), 1.0 / kR, 1e-6);
      }
    }
  }
  EXPECT_LT(area, 4.0 * kPi * kR * kR);
  EXPECT_GT(area, 4.0 * kPi * (kR - 2.0 * kChord) * (kR - 2.0 * kChord));
}

// The upper half alone: the normal points outward everywhere, on the rim too, and contours bend outward.
TEST(SurfaceMesh, OfAHemisphereLooksOutwardOnItsRimToo) {
  const Vec3 center(1, 2, 3);
  constexpr double kR = 7.0;
  const Surface s = MakeSurface(testing::Sphere(center, kR, testing::Half::kUpper));
  int on_rim = 0;
  for (const PieceTriangles& piece : Mesh(s, {.chord = 0.01})) {
    for (const MeshVertex& vertex : piece.vertices) {
      const Vec3 out = (vertex.at.p - center) / kR;
      EXPECT_GT(vertex.normal.dot(out), 0.999999) << out.transpose();
      if (std::hypot(out.x(), out.y()) > 1e-3) {
        EXPECT_NEAR(vertex.contour_curvature, -1.0 / kR, 1e-6);
      }
      on_rim += std::abs(out.z()) < 1e-9;
    }
  }
  EXPECT_GT(on_rim, 10);
}

// A long trough: its cells are fine across and coarse along, and a label at its end has its area all the
// same.
TEST(SurfaceMesh, LabelsOfLongPiecesHaveTheirArea) {
  const Surface s = MakeSurface(testing::Cylinder(Vec3::Zero(), 40.0, 150.0, testing::Half::kUpper));
  const auto label = [](PieceId, double u, double v) {
    const auto cell = [](double t) { return std::min(kLabelCells - 1, static_cast<int>(t * kLabelCells)); };
    return cell(u) < 2 || cell(v) < 2 ? 1 : 0;  // strips along two sides
  };
  for (const PieceTriangles& piece : Mesh(s, {.chord = 0.05, .label = label, .label_cells = kLabelCells})) {
    double all = 0.0, strips = 0.0;
    for (const MeshTriangle& t : piece.triangles) {
      const double area = AreaOf(piece, t);
      all += area;
      if (t.label == 1) strips += area;
    }
    const double share = 1.0 - (62.0 / 64.0) * (62.0 / 64.0);  // of the parameters
    EXPECT_NEAR(strips / all, share, 0.5 * share);
  }
}

TEST(SurfaceMesh, SidesAreAsShortAsAsked) {
  const Surface s = MakeSurface(testing::Plane(50.0));
  for (const PieceTriangles& piece : Mesh(s, {.chord = 1.0, .longest_edge = 3.0})) {
    for (const MeshTriangle& t : piece.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 way = piece.vertices[t.vertices[k]].at.p - piece.vertices[t.vertices[(k + 1) % 3]].at.p;
        EXPECT_LE(way.norm(), 3.0 * std::sqrt(2.0) + 1e-9);
      }
    }
  }
}

// A plane is two triangles; only the line between labels is fine.
TEST(SurfaceMesh, IsFineWhereTheLabelChanges) {
  constexpr double kSide = 50.0;
  const Surface s = MakeSurface(testing::Plane(kSide));
  EXPECT_EQ(Mesh(s, {.chord = 1e-3}).front().triangles.size(), 2u);
  const auto mesh = Mesh(s, {.chord = 1e-3, .label = Quarter, .label_cells = kLabelCells});
  EXPECT_LT(mesh.front().triangles.size(), 1500u);  // 32 x 32 cells would have 2048
  double inside = 0.0, all = 0.0;
  for (const MeshTriangle& t : mesh.front().triangles) {
    const double area = AreaOf(mesh.front(), t);
    all += area;
    if (t.label == 1) inside += area;
  }
  EXPECT_NEAR(all, (s.box.max.x() - s.box.min.x()) * (s.box.max.y() - s.box.min.y()), 1e-6);
  EXPECT_NEAR(inside / all, 0.25 * kPi * 0.7 * 0.7, 0.01);
}

TEST(SurfaceMesh, EndsAtItsLimit) {
  const Surface s = MakeSurface(testing::Sphere(Vec3::Zero(), 7.0));
  const auto mesh = MakeSurfaceMesh(s, {.chord = 0.001, .most_triangles = 100}, RunContext(2));
  EXPECT_EQ(mesh.status().code(), absl::StatusCode::kResourceExhausted) << mesh.status();
}

}  // namespace
}  // namespace patchmill
