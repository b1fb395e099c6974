#include "cam/region/split_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/diffgeo/forms.h"
#include "core/lines/triangle_quadrature.h"

namespace patchmill {

namespace {

constexpr double kMaxTurn = 0.35;  // rad, of the normal over one application of the rule
constexpr int kMaxHalvings = 3;

double Turn(const std::optional<Vec3>& a, const std::optional<Vec3>& b) {
  return a && b ? std::atan2(a->cross(*b).norm(), a->dot(*b)) : 0.0;
}

template <class Visit>
void Quarter(const Vec2& a, const Vec2& b, const Vec2& c, int halvings, const Visit& visit) {
  if (halvings == 0) {
    ForQuadraturePoints(a, b, c, visit);
    return;
  }
  const Vec2 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
  Quarter(a, ab, ca, halvings - 1, visit);
  Quarter(ab, b, bc, halvings - 1, visit);
  Quarter(ca, bc, c, halvings - 1, visit);
  Quarter(ab, bc, ca, halvings - 1, visit);
}

using Normal = std::optional<Vec3>;

Normal NormalAt(const Piece& piece, const Vec2& q) { return UnitNormal(Evaluate(piece, q.x(), q.y())); }

// visit(q, weight) at the points of a rule fine enough for how far the normal turns between the corners.
template <class Visit>
void Integrate(const std::array<Vec2, 3>& q, const std::array<const Normal*, 3>& normal, const Visit& visit) {
  double turn =
      std::max({Turn(*normal[0], *normal[1]), Turn(*normal[1], *normal[2]), Turn(*normal[2], *normal[0])});
  int halvings = 0;
  for (; turn > kMaxTurn && halvings < kMaxHalvings; turn *= 0.5) ++halvings;
  Quarter(q[0], q[1], q[2], halvings, visit);
}

// Normals at the vertices of a mesh, once each, where triangles ask for them.
class VertexNormals {
 public:
  VertexNormals(const Piece& piece, const std::vector<ZeroVertex>& vertices)
      : piece_(piece), vertices_(vertices), normals_(vertices.size()), known_(vertices.size(), false) {}

  const Normal& At(int vertex) {
    const auto i = static_cast<std::size_t>(vertex);
    if (!known_[i]) normals_[i] = NormalAt(piece_, {vertices_[i].u, vertices_[i].v});
    known_[i] = true;
    return normals_[i];
  }

 private:
  const Piece& piece_;
  const std::vector<ZeroVertex>& vertices_;
  std::vector<Normal> normals_;
  std::vector<bool> known_;
};

void Measure(const Piece& piece, const std::array<Vec2, 3>& q, const std::array<const Normal*, 3>& normal,
             double steep_angle, SplitTriangle& triangle) {
  triangle.area = triangle.curvature = triangle.steepness = 0.0;
  Integrate(q, normal, [&](const Vec2& at, double weight) {
    const SurfaceJet jet = Evaluate(piece, at.x(), at.y());
    const double element = weight * jet.du.cross(jet.dv).norm();
    triangle.area += element;
    if (triangle.label.reason != UnreachableReason::kNone) return;
    const auto unit = UnitNormal(jet);
    if (!unit) return;
    const double slope = std::atan2(Plan(*unit).norm(), std::abs(unit->z()));
    triangle.steepness += element * (slope - steep_angle);
    const double bend = triangle.turn * ContourCurvature(jet, Forms(jet, *unit));
    if (std::isfinite(bend)) triangle.curvature += element * bend;  // none at a summit or a pit
  });
}

Vec2 PlaceOf(const ZeroVertex& vertex) { return {vertex.u, vertex.v}; }

}  // namespace

double SurfaceArea(const Piece& piece, const Vec2& a, const Vec2& b, const Vec2& c) {
  double area = 0.0;
  const Normal na = NormalAt(piece, a), nb = NormalAt(piece, b), nc = NormalAt(piece, c);
  Integrate({a, b, c}, {&na, &nb, &nc}, [&](const Vec2& q, double weight) {
    const SurfaceJet jet = Evaluate(piece, q.x(), q.y());
    area += weight * jet.du.cross(jet.dv).norm();
  });
  return area;
}

void MeasureTriangle(const Piece& piece, const std::vector<ZeroVertex>& vertices, double steep_angle,
                     SplitTriangle& triangle) {
  std::array<Vec2, 3> q;
  std::array<Normal, 3> normal;
  for (std::size_t k = 0; k < 3; ++k) {
    q[k] = PlaceOf(vertices[static_cast<std::size_t>(triangle.vertex[k])]);
    normal[k] = NormalAt(piece, q[k]);
  }
  Measure(piece, q, {&normal[0], &normal[1], &normal[2]}, steep_angle, triangle);
}

SplitMesh BuildSplitMesh(const Piece& piece, std::span<const ZeroField> fields, double steep_angle,
                         const ZeroMeshParams& params) {
  ZeroMesh zero = BuildZeroMesh(piece, fields, params);
  SplitMesh mesh;
  mesh.vertices = std::move(zero.vertices);
  mesh.triangles.reserve(zero.triangles.size());
  VertexNormals normals(piece, mesh.vertices);
  for (const ZeroTriangle& t : zero.triangles) {
    if (params.run != nullptr && params.run->Cancelled()) break;
    SplitTriangle triangle{t.vertex, LabelOf(t), t.sign[static_cast<std::size_t>(Field::kTurn)]};
    std::array<Vec2, 3> q;
    std::array<const Normal*, 3> normal{};
    for (std::size_t k = 0; k < 3; ++k) {
      q[k] = PlaceOf(mesh.vertices[static_cast<std::size_t>(t.vertex[k])]);
      normal[k] = &normals.At(t.vertex[k]);
    }
    Measure(piece, q, normal, steep_angle, triangle);
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace patchmill
