#include "cam/region/split/split_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/progress_throttle.h"
#include "core/diffgeo/forms.h"
#include "core/lines/triangle_quadrature.h"

namespace patchmill {

namespace {

constexpr double kMaxTurn = 0.35;  // rad; turn of the normal over a triangle to which the rule is applied
constexpr double kMaxOff = 1e-4;   // OffQuadratic above which a triangle is quartered
constexpr int kMaxHalvings = 3;    // of the sides of one triangle
// Up to these limits the corners and the middle of a triangle give its area to about 1e-7: turn of the normal
// (rad), spread of the area element over the corners, and deviation of its value in the middle from their
// mean, both in parts of the mean.
constexpr double kSmallTurn = 0.15, kSmallSpread = 0.1, kSmallBend = 2e-3;

double Turn(const std::optional<Vec3>& a, const std::optional<Vec3>& b) {
  return a && b ? std::atan2(a->cross(*b).norm(), a->dot(*b)) : 0.0;
}

// Nearly the turn if it is small, and cheaper.
double Chord(const std::optional<Vec3>& a, const std::optional<Vec3>& b) {
  return a && b ? (*a - *b).norm() : 0.0;
}

// Integrals over a part of the surface, as in SplitTriangle.
struct Measures {
  double area = 0.0, curvature = 0.0, steepness = 0.0;

  void Add(const Measures& m) {
    area += m.area;
    curvature += m.curvature;
    steepness += m.steepness;
  }
};

// How far seven values of the area element, in the order of the rule's points, deviate from every polynomial
// of degree 2, relative to their size. The relative error of the rule of degree 5 is about its square.
double OffQuadratic(const std::array<double, 7>& element) {
  const double near_sides = (element[1] + element[2] + element[3]) / 3.0;
  const double near_corners = (element[4] + element[5] + element[6]) / 3.0;
  // The squares of the barycentric coordinates add up to 1/3 in the middle and to these amounts more at the
  // other points.
  constexpr double kSides = 0.112298, kCorners = 0.323080;
  const double off = kCorners * (near_sides - element[0]) - kSides * (near_corners - element[0]);
  const double size = std::max({near_sides, near_corners, element[0]});
  return size > 0.0 ? std::abs(off) / size : 0.0;
}

// Integrands at one point: the area element per unit of (u,v), and per unit of area the contour curvature
// (1/mm) and the slope less the steep angle (rad).
struct PointMeasures {
  double element = 0.0, bend = 0.0, steeper = 0.0;
};

// Integrates over a triangle. It is quartered `halvings` times, and up to `more` times again where
// the area element is not nearly quadratic. at(q, whole) computes all integrands only if `whole` is true, in
// the middle of each part. Curvature and steepness need no better rule: they only decide which regions are
// merged.
template <class MeasuresAt>
Measures Integral(const MeasuresAt& at, const std::array<Vec2, 3>& triangle, int halvings, int more) {
  const auto& [a, b, c] = triangle;
  Measures sum;
  if (halvings == 0) {
    std::array<double, 7> element{};
    std::size_t n = 0;
    PointMeasures middle;
    ForQuadraturePoints(a, b, c, [&](const Vec2& q, double weight) {
      const PointMeasures m = at(q, n == 0);
      if (n == 0) middle = m;
      element[n++] = m.element;
      sum.area += weight * m.element;
    });
    sum.curvature = middle.bend * sum.area;
    sum.steepness = middle.steeper * sum.area;
    if (more == 0 || OffQuadratic(element) <= kMaxOff) return sum;
    sum = {};
    halvings = 1;
    --more;
  }
  const Vec2 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
  sum.Add(Integral(at, {a, ab, ca}, halvings - 1, more));
  sum.Add(Integral(at, {ab, b, bc}, halvings - 1, more));
  sum.Add(Integral(at, {ca, bc, c}, halvings - 1, more));
  sum.Add(Integral(at, {ab, bc, ca}, halvings - 1, more));
  return sum;
}

// The surface at a corner of triangles.
struct Corner {
  std::optional<Vec3> normal;
  double element = 0.0;  // area element
};

Corner CornerAt(const Piece& piece, const Vec2& q) {
  const SurfaceJet jet = EvaluateSlopes(piece, q.x(), q.y());
  return {UnitNormal(jet), jet.du.cross(jet.dv).norm()};
}

// Integrates with a rule that fits the turn of the normal between the corners and the area element. If the
// area element is nearly linear, its values at the corners and in the middle are enough.
template <class MeasuresAt>
Measures Integral(const MeasuresAt& at, const std::array<Vec2, 3>& q,
                  const std::array<const Corner*, 3>& corner) {
  const auto of_sides = [&](const auto& of_two) {
    return std::max({of_two(corner[0]->normal, corner[1]->normal),
                     of_two(corner[1]->normal, corner[2]->normal),
                     of_two(corner[2]->normal, corner[0]->normal)});
  };
  if (of_sides(Chord) <= kSmallTurn) {
    const PointMeasures middle = at((q[0] + q[1] + q[2]) / 3.0, true);
    const double e[3] = {corner[0]->element, corner[1]->element, corner[2]->element};
    const double mean = (e[0] + e[1] + e[2]) / 3.0;
    const double spread = std::max({e[0], e[1], e[2]}) - std::min({e[0], e[1], e[2]});
    if (spread <= kSmallSpread * mean && std::abs(middle.element - mean) <= kSmallBend * mean) {
      const double area = 0.5 * Cross(q[1] - q[0], q[2] - q[0]) * (0.75 * middle.element + 0.25 * mean);
      return {area, middle.bend * area, middle.steeper * area};
    }
  }
  int halvings = 0;
  for (double turn = of_sides(Turn); turn > kMaxTurn && halvings < kMaxHalvings; turn *= 0.5) ++halvings;
  return Integral(at, q, halvings, kMaxHalvings - halvings);
}

// The corners at the vertices of a mesh. Each is evaluated once, when a triangle needs it.
class Corners {
 public:
  Corners(const Piece& piece, const std::vector<ZeroVertex>& vertices)
      : piece_(piece), vertices_(vertices), corners_(vertices.size()), known_(vertices.size(), false) {}

  const Corner& At(int vertex) {
    const auto i = static_cast<std::size_t>(vertex);
    if (!known_[i]) corners_[i] = CornerAt(piece_, {vertices_[i].u, vertices_[i].v});
    known_[i] = true;
    return corners_[i];
  }

 private:
  const Piece& piece_;
  const std::vector<ZeroVertex>& vertices_;
  std::vector<Corner> corners_;
  std::vector<bool> known_;
};

void Measure(const Piece& piece, const std::array<Vec2, 3>& q, const std::array<const Corner*, 3>& corner,
             double steep_angle, SplitTriangle& triangle) {
  const Measures measures = Integral(
      [&](const Vec2& at, bool whole) {
        const bool more = whole && (triangle.label.reason == UnreachableReason::kNone ||
                                    triangle.label.reason == UnreachableReason::kStrategy);
        const SurfaceJet jet = more ? Evaluate(piece, at.x(), at.y()) : EvaluateSlopes(piece, at.x(), at.y());
        PointMeasures m{.element = jet.du.cross(jet.dv).norm()};
        if (!more) return m;
        const auto unit = UnitNormal(jet);
        if (!unit) return m;
        m.steeper = std::atan2(Xy(*unit).norm(), std::abs(unit->z())) - steep_angle;
        const double bend = triangle.turn * ContourCurvature(jet, Forms(jet, *unit));
        if (std::isfinite(bend)) m.bend = bend;  // it has no value at a summit or a pit
        return m;
      },
      q, corner);
  triangle.area = measures.area;
  triangle.curvature = measures.curvature;
  triangle.steepness = measures.steepness;
}

Vec2 PlaceOf(const ZeroVertex& vertex) { return {vertex.u, vertex.v}; }

}  // namespace

double SurfaceArea(const Piece& piece, const Vec2& a, const Vec2& b, const Vec2& c) {
  const Corner at_a = CornerAt(piece, a), at_b = CornerAt(piece, b), at_c = CornerAt(piece, c);
  const auto at = [&](const Vec2& q, bool) {
    const SurfaceJet jet = EvaluateSlopes(piece, q.x(), q.y());
    return PointMeasures{.element = jet.du.cross(jet.dv).norm()};
  };
  return Integral(at, {a, b, c}, {&at_a, &at_b, &at_c}).area;
}

void MeasureTriangle(const Piece& piece, const std::vector<ZeroVertex>& vertices, double steep_angle,
                     SplitTriangle& triangle) {
  std::array<Vec2, 3> q;
  std::array<Corner, 3> corner;
  for (std::size_t k = 0; k < 3; ++k) {
    q[k] = PlaceOf(vertices[static_cast<std::size_t>(triangle.vertex[k])]);
    corner[k] = CornerAt(piece, q[k]);
  }
  Measure(piece, q, {&corner[0], &corner[1], &corner[2]}, steep_angle, triangle);
}

SplitMesh BuildSplitMesh(const Piece& piece, std::span<const ZeroField> fields, double steep_angle,
                         const ZeroMeshParams& params) {
  ZeroMesh zero = BuildZeroMesh(piece, fields, params);
  SplitMesh mesh;
  mesh.vertices = std::move(zero.vertices);
  mesh.triangles.reserve(zero.triangles.size());
  Corners corners(piece, mesh.vertices);
  ProgressThrottle throttle;
  for (const ZeroTriangle& t : zero.triangles) {
    if (params.run != nullptr && params.run->Cancelled()) break;
    if (params.run != nullptr)
      throttle.ReportIfDue(*params.run, "areas", mesh.triangles.size(), zero.triangles.size());
    SplitTriangle triangle{t.vertex, LabelOf(t), t.sign[static_cast<std::size_t>(Field::kTurn)]};
    std::array<Vec2, 3> q;
    std::array<const Corner*, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      q[k] = PlaceOf(mesh.vertices[static_cast<std::size_t>(t.vertex[k])]);
      corner[k] = &corners.At(t.vertex[k]);
    }
    Measure(piece, q, corner, steep_angle, triangle);
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace patchmill
