// Meshes cut along zero curves: whole, on the curves, and right about what is connected.
#include "core/lines/zero_mesh.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "core/lines/line_fields.h"
#include "core/lines/zero_root.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

Vec2 Parameters(const ZeroMesh& mesh, int id) {
  const ZeroVertex& v = mesh.vertices[static_cast<std::size_t>(id)];
  return {v.u, v.v};
}

// The triangles tile the unit square: areas add up, and every inner side has its partner.
void ExpectWhole(const ZeroMesh& mesh) {
  double area = 0.0;
  std::map<std::pair<int, int>, int> sides;
  for (const ZeroTriangle& t : mesh.triangles) {
    const Vec2 a = Parameters(mesh, t.vertex[0]), b = Parameters(mesh, t.vertex[1]),
               c = Parameters(mesh, t.vertex[2]);
    const double twice = Cross(b - a, c - a);
    EXPECT_GE(twice, -1e-3);  // a crossing of two curves is moved onto both, off the side it was found on
    area += 0.5 * twice;
    for (std::size_t s = 0; s < 3; ++s) ++sides[{t.vertex[s], t.vertex[(s + 1) % 3]}];
  }
  EXPECT_NEAR(area, 1.0, 1e-12);
  for (const auto& [side, count] : sides) {
    EXPECT_EQ(count, 1);
    if (sides.contains({side.second, side.first})) continue;
    const Vec2 a = Parameters(mesh, side.first), b = Parameters(mesh, side.second);
    const bool border =
        (a.x() == b.x() && (a.x() == 0 || a.x() == 1)) || (a.y() == b.y() && (a.y() == 0 || a.y() == 1));
    EXPECT_TRUE(border) << a.transpose() << " to " << b.transpose();
  }
}

TEST(ZeroMesh, TilesThePieceWhateverTheFields) {
  const std::vector<ZeroField> fields = {SilhouetteField(), SlopeField(Radians(30)), ContourCurvatureField()};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    for (const PatchShape& shape :
         {PatchShape(RandomBezier(seed, 3, 3, false)), PatchShape(RandomBezier(seed, 2, 2, true)),
          PatchShape(RandomGregory(seed, GregoryPatch::Blend::kCorner))}) {
      const Piece piece = SplitIntoPieces(PatchId(0), shape)[0];
      const ZeroMesh mesh = BuildZeroMesh(piece, fields, ZeroMeshParams());
      ExpectWhole(mesh);
      for (const ZeroVertex& vertex : mesh.vertices) {
        // At a saddle the contour has no direction and its curvature no value.
        const SurfaceJet jet = Evaluate(piece, vertex.u, vertex.v);
        bool node = std::hypot(jet.du.z(), jet.dv.z()) < 1e-9;
        // Corners of Gregory patches have no second derivative, only limits.
        const Vec2 corner(std::round(vertex.u), std::round(vertex.v));
        node = node || (piece.gregory && (Vec2(vertex.u, vertex.v) - corner).norm() < 2e-6);
        for (std::size_t k = 0; k < fields.size(); ++k) {
          if (vertex.on == 1u << k && !node) {
            EXPECT_NEAR(Value(fields[k], piece, {vertex.u, vertex.v}), 0.0, 1e-8);
          }
        }
      }
    }
  }
}

// Curves that count only on one side of a limit are cut in there alone, and the mesh has no gap along it.
TEST(ZeroMesh, FieldsCountWhereAnotherSaysSo) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const PatchShape shape = RandomBezier(seed, 3, 3, false);
    const Piece piece = SplitIntoPieces(PatchId(0), shape)[0];
    const Vec3 middle = Position(piece, 0.45, 0.55);
    const double radius = 0.4 * (Position(piece, 1.0, 1.0) - Position(piece, 0.0, 0.0)).norm();
    ZeroField limit;
    limit.smooth = false;
    limit.resolution = 1e-6;
    limit.value = [&](const SurfaceJet& jet) { return (jet.p - middle).norm() < radius ? 1.0 : -1.0; };
    for (const int wanted : {1, -1}) {
      std::vector<ZeroField> fields = {limit, SlopeField(Radians(30)), ContourCurvatureField(),
                                       ContourField(middle.z())};
      for (const std::size_t k : {1u, 2u}) {
        fields[k].where = 0;
        fields[k].where_sign = static_cast<std::int8_t>(wanted);
      }
      const ZeroMesh mesh = BuildZeroMesh(piece, fields, ZeroMeshParams());
      ExpectWhole(mesh);
      int count = 0;
      for (const ZeroTriangle& t : mesh.triangles) {
        for (const std::size_t k : {1u, 2u}) {
          if (t.sign[0] != wanted) {
            EXPECT_EQ(t.sign[k], 0);
            continue;
          }
          ++count;
          for (const int id : t.vertex) EXPECT_GE(mesh.vertices[id].sign[k] * t.sign[k], 0);
        }
        for (const int id : t.vertex) EXPECT_GE(mesh.vertices[id].sign[3] * t.sign[3], 0);
      }
      EXPECT_GT(count, 0);
      EXPECT_LT(count, 2 * static_cast<int>(mesh.triangles.size()));
    }
  }
}

TEST(ZeroMesh, SmallLoopsAreFound) {
  // Two bumps of radius 0.3 mm cut a level of a 40 mm patch: sampling every cell would miss them.
  BezierPatch patch;
  patch.degree_u = patch.degree_v = 2;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      // z = -(x - 7.3)^2 - (y + 4.1)^2 in Bernstein form, x = -20 + 40 u.
      const auto square = [](double c, int k) {  // coefficients of (40 t - 20 - c)^2
        const double a = -20 - c, b = 20 - c;
        return k == 0 ? a * a : k == 1 ? a * b : b * b;
      };
      patch.points.push_back(Vec3(-20 + 20 * i, -20 + 20 * j, -square(7.3, i) - square(-4.1, j)));
    }
  }
  const PatchShape shape = patch;
  const Piece piece = SplitIntoPieces(PatchId(0), shape)[0];
  const std::vector<ZeroField> fields = {ContourField(-0.09)};
  ZeroMeshParams params;
  params.max_cell = 20;
  params.max_turn = 10;
  const ZeroMesh mesh = BuildZeroMesh(piece, fields, params);
  ExpectWhole(mesh);
  int on = 0;
  for (const ZeroVertex& vertex : mesh.vertices) {
    if (vertex.on == 0) continue;
    ++on;
    EXPECT_NEAR(std::hypot(vertex.p.x() - 7.3, vertex.p.y() + 4.1), 0.3, 1e-9);
  }
  EXPECT_GE(on, 4);
}

// Saddle a x^2 - b y^2 over [-8,8]^2 with its node moved to `node` by a linear part.
Piece MovedSaddle(double a, double b, const Vec2& node) {
  auto patch = std::get<BezierPatch>(Saddle(a, b, 8).patches[0].shape);
  for (Vec3& p : patch.points) p.z() += -2 * a * node.x() * p.x() + 2 * b * node.y() * p.y();
  const PatchShape shape = patch;
  return SplitIntoPieces(PatchId(0), shape)[0];
}

TEST(ZeroMesh, SaddlesAreVerticesWithFourSectorsWhereverTheyLie) {
  // Inside a cell, on a side of cells (u = 37/64), at a corner, on the piece's side, and nearly there.
  const double side = -8 + 16 * 37.0 / 64;
  for (const Vec2& node :
       {Vec2(1.3, -0.7), Vec2(2.71, 3.14), Vec2(side, 1.1), Vec2(1.1, side), Vec2(side, side), Vec2(0, 0),
        Vec2(8, 0.77), Vec2(0.77, -8), Vec2(side + 1e-10, side - 1e-10), Vec2(side + 1e-4, side),
        Vec2(side + 1e-6, 1.1)}) {
    const Piece piece = MovedSaddle(0.05, 0.03, node);
    const std::vector<ZeroField> fields = {ContourCurvatureField()};
    const ZeroMesh mesh = BuildZeroMesh(piece, fields, ZeroMeshParams());
    ExpectWhole(mesh);
    int at = -1;
    double nearest = 1e-9;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      const double away = (Xy(mesh.vertices[i].p) - node).norm();
      if (mesh.vertices[i].on != 1 || away >= nearest) continue;
      at = static_cast<int>(i);
      nearest = away;
    }
    ASSERT_GE(at, 0) << node.transpose();
    // Changes of sign going round it, an open walk on the piece's side.
    std::map<int, std::pair<int, int>> next;  // from vertex to vertex, sign of the triangle between
    for (const ZeroTriangle& t : mesh.triangles) {
      for (std::size_t s = 0; s < 3; ++s) {
        if (t.vertex[s] == at) next[t.vertex[(s + 1) % 3]] = {t.vertex[(s + 2) % 3], t.sign[0]};
      }
    }
    std::map<int, int> before;
    for (const auto& [from, to] : next) before[to.first] = to.second;
    int changes = 0;
    for (const auto& [from, to] : next) changes += before.contains(from) && before[from] != to.second;
    const bool inner = node.cwiseAbs().maxCoeff() < 8;
    EXPECT_EQ(changes, inner ? 4 : 2) << node.transpose();
  }
}

TEST(ZeroMesh, CrossingsOfTwoFieldsLieOnBoth) {
  // Saddle a x^2 - b y^2: slope circle-like ellipse and the inflection lines meet in four points.
  const Piece piece = SplitIntoPieces(PatchId(0), Saddle(0.05, 0.03, 8).patches[0].shape)[0];
  const std::vector<ZeroField> fields = {SlopeField(Radians(20)), ContourCurvatureField()};
  const ZeroMesh mesh = BuildZeroMesh(piece, fields, ZeroMeshParams());
  int both = 0;
  for (const ZeroVertex& vertex : mesh.vertices) {
    if (vertex.on != 3) continue;
    ++both;
    for (const ZeroField& field : fields) EXPECT_NEAR(Value(field, piece, {vertex.u, vertex.v}), 0.0, 1e-10);
  }
  EXPECT_EQ(both, 4);
}

TEST(RefineZeroArc, KeepsToTheChordTolerance) {
  // Latitude of a sphere between two points a quarter apart.
  const Piece piece = SplitIntoPieces(PatchId(0), Sphere(Vec3::Zero(), 10, Half::kUpper).patches[0].shape)[0];
  const ZeroField field = ContourField(6.0);
  const auto on_side = [&](double u) {
    const Vec2 from(u, 0), to(u, 0.999);
    const double t =
        ZeroBetween(field, piece, {from, to, Value(field, piece, from), Value(field, piece, to)}, 1e-13);
    return Vec2(from + t * (to - from));
  };
  const Vec2 a = on_side(0), b = on_side(1);
  for (const double tolerance : {0.1, 1e-3, 1e-6}) {
    std::vector<Vec2> arc = {a};
    for (const Vec2& q : RefineZeroArc(piece, field, a, b, tolerance)) arc.push_back(q);
    arc.push_back(b);
    // Circle of radius 8: chords of half angle h have the sagitta 8 (1 - cos h).
    for (std::size_t i = 0; i + 1 < arc.size(); ++i) {
      const Vec3 p = Position(piece, arc[i].x(), arc[i].y()),
                 q = Position(piece, arc[i + 1].x(), arc[i + 1].y());
      EXPECT_NEAR(p.z(), 6.0, 1e-9);
      EXPECT_LE(8.0 - std::sqrt(64.0 - 0.25 * (p - q).squaredNorm()), 1.01 * tolerance);
    }
    EXPECT_LE(arc.size(), 4 + 2 * kPi / 2 * std::sqrt(8.0 / (2 * tolerance)));
  }
}

}  // namespace
}  // namespace patchmill
