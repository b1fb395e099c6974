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
constexpr double kMaxOff = 1e-4;   // of OffQuadratic
constexpr int kMaxHalvings = 3;

double Turn(const std::optional<Vec3>& a, const std::optional<Vec3>& b) {
  return a && b ? std::atan2(a->cross(*b).norm(), a->dot(*b)) : 0.0;
}

// Of the surface over parameters, or of one point of them: per unit of (u,v).
struct Measures {
  double area = 0.0, curvature = 0.0, steepness = 0.0;

  void Add(double weight, const Measures& m) {
    area += weight * m.area;
    curvature += weight * m.curvature;
    steepness += weight * m.steepness;
  }
};

// How far seven elements of area, in the order of the rule's points, are from every polynomial of degree two,
// of their size: what is left over of it in the rule of degree 5 is about its square.
double OffQuadratic(const std::array<double, 7>& element) {
  const double near_sides = (element[1] + element[2] + element[3]) / 3.0;
  const double near_corners = (element[4] + element[5] + element[6]) / 3.0;
  // The squares of the barycentric coordinates add up to 1/3 in the middle, so much more at the others.
  constexpr double kSides = 0.112298, kCorners = 0.323080;
  const double off = kCorners * (near_sides - element[0]) - kSides * (near_corners - element[0]);
  const double size = std::max({near_sides, near_corners, element[0]});
  return size > 0.0 ? std::abs(off) / size : 0.0;
}

// Of the triangle a b c: halved so often for certain, and more often where the element of area asks for it.
template <class MeasuresAt>
Measures Integral(const MeasuresAt& at, const Vec2& a, const Vec2& b, const Vec2& c, int halvings, int more) {
  Measures sum;
  if (halvings == 0) {
    std::array<double, 7> element{};
    std::size_t n = 0;
    ForQuadraturePoints(a, b, c, [&](const Vec2& q, double weight) {
      const Measures m = at(q);
      element[n++] = m.area;
      sum.Add(weight, m);
    });
    if (more == 0 || OffQuadratic(element) <= kMaxOff) return sum;
    sum = {};
    halvings = 1;
    --more;
  }
  const Vec2 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
  sum.Add(1.0, Integral(at, a, ab, ca, halvings - 1, more));
  sum.Add(1.0, Integral(at, ab, b, bc, halvings - 1, more));
  sum.Add(1.0, Integral(at, ca, bc, c, halvings - 1, more));
  sum.Add(1.0, Integral(at, ab, bc, ca, halvings - 1, more));
  return sum;
}

using Normal = std::optional<Vec3>;

Normal NormalAt(const Piece& piece, const Vec2& q) { return UnitNormal(Evaluate(piece, q.x(), q.y())); }

// By a rule fine enough for how far the normal turns between the corners, and for the element of area.
template <class MeasuresAt>
Measures Integral(const MeasuresAt& at, const std::array<Vec2, 3>& q,
                  const std::array<const Normal*, 3>& normal) {
  double turn =
      std::max({Turn(*normal[0], *normal[1]), Turn(*normal[1], *normal[2]), Turn(*normal[2], *normal[0])});
  int halvings = 0;
  for (; turn > kMaxTurn && halvings < kMaxHalvings; turn *= 0.5) ++halvings;
  return Integral(at, q[0], q[1], q[2], halvings, kMaxHalvings - halvings);
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
  const Measures measures = Integral(
      [&](const Vec2& at) {
        const SurfaceJet jet = Evaluate(piece, at.x(), at.y());
        Measures m{.area = jet.du.cross(jet.dv).norm()};
        if (triangle.label.reason != UnreachableReason::kNone) return m;
        const auto unit = UnitNormal(jet);
        if (!unit) return m;
        const double slope = std::atan2(Plan(*unit).norm(), std::abs(unit->z()));
        m.steepness = m.area * (slope - steep_angle);
        const double bend = triangle.turn * ContourCurvature(jet, Forms(jet, *unit));
        if (std::isfinite(bend)) m.curvature = m.area * bend;  // none at a summit or a pit
        return m;
      },
      q, normal);
  triangle.area = measures.area;
  triangle.curvature = measures.curvature;
  triangle.steepness = measures.steepness;
}

Vec2 PlaceOf(const ZeroVertex& vertex) { return {vertex.u, vertex.v}; }

}  // namespace

double SurfaceArea(const Piece& piece, const Vec2& a, const Vec2& b, const Vec2& c) {
  const Normal na = NormalAt(piece, a), nb = NormalAt(piece, b), nc = NormalAt(piece, c);
  const auto at = [&](const Vec2& q) {
    const SurfaceJet jet = Evaluate(piece, q.x(), q.y());
    return Measures{.area = jet.du.cross(jet.dv).norm()};
  };
  return Integral(at, {a, b, c}, {&na, &nb, &nc}).area;
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
