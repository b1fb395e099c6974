#include "core/joining/face_patch.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

namespace patchmill {
namespace {

std::size_t At(int i) { return static_cast<std::size_t>(i); }

int HighestDegree(const FaceBoundary& face) {
  int degree = 3;
  for (int k = 0; k < face.sides; ++k) degree = std::max(degree, face.curve[At(k)].degree());
  return degree;
}

// Edge and rail (edge + tangent/3) of one side with the given degree.
struct Strip {
  std::vector<Vec3> edge, rail;
};
Strip StripOf(const FaceBoundary& face, int side, int degree, bool reversed) {
  BezierCurve curve = Elevated(face.curve[At(side)], degree),
              tangent = Elevated(face.tangent[At(side)], degree);
  if (reversed) curve = Reversed(std::move(curve)), tangent = Reversed(std::move(tangent));
  Strip strip{curve.points, curve.points};
  for (std::size_t i = 0; i < strip.rail.size(); ++i) strip.rail[i] += tangent.points[i] / 3.0;
  return strip;
}

void AddInner(const std::vector<Vec3>& from, std::vector<Vec3>& to) {
  to.insert(to.end(), from.begin() + 1, from.end() - 1);
}

PatchShape GregoryQuad(const FaceBoundary& face) {
  const Strip v0 = StripOf(face, 0, 3, false), u1 = StripOf(face, 1, 3, false),
              v1 = StripOf(face, 2, 3, true), u0 = StripOf(face, 3, 3, true);
  GregoryPatch patch;
  patch.blend = GregoryPatch::Blend::kEdge;
  const auto& [p0, p1, p2, p3] = std::tie(v0.edge[0], v0.edge[3], v1.edge[3], v1.edge[0]);
  patch.points = {p0, v0.edge[1], u0.edge[1], v0.rail[1], u0.rail[1],  //
                  p1, u1.edge[1], v0.edge[2], u1.rail[1], v0.rail[2],  //
                  p2, v1.edge[2], u1.edge[2], v1.rail[2], u1.rail[2],  //
                  p3, u0.edge[2], v1.edge[1], u0.rail[2], v1.rail[1]};
  return patch;
}

PatchShape BrownQuad(const FaceBoundary& face) {
  BrownPatch patch;
  patch.degree_u = std::max({3, face.curve[0].degree(), face.curve[2].degree()});
  patch.degree_v = std::max({3, face.curve[1].degree(), face.curve[3].degree()});
  const Strip v0 = StripOf(face, 0, patch.degree_u, false), v1 = StripOf(face, 2, patch.degree_u, true);
  const Strip u0 = StripOf(face, 3, patch.degree_v, true), u1 = StripOf(face, 1, patch.degree_v, false);
  patch.points = v0.edge;
  patch.points.insert(patch.points.end(), v1.edge.begin(), v1.edge.end());
  AddInner(u0.edge, patch.points);
  AddInner(u1.edge, patch.points);
  for (const Strip* strip : {&v0, &v1, &u0, &u1}) AddInner(strip->rail, patch.points);
  return patch;
}

PatchShape LoftedTriangle(const FaceBoundary& face) {
  LoftTriangle patch;
  patch.degree = HighestDegree(face);
  patch.squared = patch.degree > 3;
  std::array<Strip, 3> strips;
  for (int k = 0; k < 3; ++k) {
    strips[At(k)] = StripOf(face, k, patch.degree, false);
    patch.points.insert(patch.points.end(), strips[At(k)].edge.begin(), strips[At(k)].edge.end() - 1);
  }
  for (const Strip& strip : strips) AddInner(strip.rail, patch.points);
  return patch;
}

// (16), (17). The radial derivative on a side is 4 (R - C), so R, a cubic, is C + b/4.
PatchShape QuarticTriangle(const FaceBoundary& face) {
  GregoryTriangle patch;
  patch.blend = GregoryPatch::Blend::kEdge;
  for (int k = 0; k < 3; ++k) {
    const auto& c = face.curve[At(k)].points;
    const auto& b = Elevated(face.tangent[At(k)], 3).points;
    const std::size_t here = At(5 * k), next = At(5 * ((k + 1) % 3));
    patch.points[here] = c[0];
    patch.points[here + 1] = c[0] + 0.75 * (c[1] - c[0]);
    patch.points[next + 2] = c[3] + 0.75 * (c[2] - c[3]);
    patch.points[At(15 + k)] = 0.5 * (c[1] + c[2]);
    patch.points[here + 3] = c[1] + b[1] / 4.0;
    patch.points[next + 4] = c[2] + b[2] / 4.0;
  }
  return patch;
}

// Rows 1 and 2 beside every side of a bisextic net; METHODS 2.2, 2.5. The middle point is no side's (2.6).
PatchShape G2GregoryQuad(const FaceBoundary& face) {
  constexpr int n = kG2Degree;
  G2GregoryPatch patch;
  patch.degree = n;
  patch.points.resize((n + 1) * (n + 1) + 16);
  const auto at = [&patch](int i, int j) -> Vec3& { return patch.points[At(i * (n + 1) + j)]; };
  const auto block = [](int i) { return i < 3 ? i - 1 : i - 2; };  // 1, 2, n-2, n-1 -> 0..3
  const auto second = [&patch, &block](int i, int j) -> Vec3& {
    return patch.points[At((n + 1) * (n + 1) + 4 * block(i) + block(j))];
  };
  for (int side = 0; side < 4; ++side) {
    const std::vector<Vec3> edge = Elevated(face.curve[At(side)], n).points;
    const CrossRows& rows = face.rows[At(side)];
    for (int k = 0; k <= n; ++k) {
      const Vec3 row[3] = {edge[At(k)], edge[At(k)] + rows.first[At(k)],
                           edge[At(k)] + 2.0 * rows.first[At(k)] + rows.second[At(k)]};
      const int along = side < 2 ? k : n - k;
      for (int depth = 0; depth < 3; ++depth) {
        if (depth > 0 && (k == 0 || k == n)) continue;  // points of the edges that cross there
        const int across = side == 0 || side == 3 ? depth : n - depth;
        const bool along_u = side % 2 == 0;
        const int i = along_u ? along : across, j = along_u ? across : along;
        const bool twice = depth > 0 && k != n / 2;
        (twice && !along_u ? second(i, j) : at(i, j)) = row[depth];
      }
    }
  }
  const auto middle = [](const Vec3& p1, const Vec3& p2, const Vec3& p4, const Vec3& p5) {
    return Vec3((4.0 * (p2 + p4) - p1 - p5) / 6.0);
  };
  at(3, 3) =
      0.5 * (middle(at(1, 3), at(2, 3), at(4, 3), at(5, 3)) + middle(at(3, 1), at(3, 2), at(3, 4), at(3, 5)));
  return patch;
}

}  // namespace

std::optional<std::string> SchemeFault(const NetworkFace& face, int degree) {
  const PatchScheme scheme = face.scheme;
  const int sides = static_cast<int>(face.vertices.size());
  const bool wants_quad =
      scheme == PatchScheme::kGregory || scheme == PatchScheme::kBrown || scheme == PatchScheme::kG2Gregory;
  const bool wants_triangle = scheme == PatchScheme::kLoftTriangle || scheme == PatchScheme::kGregoryTriangle;
  if ((wants_quad && sides == 3) || (wants_triangle && sides == 4)) {
    return fmt::format("its scheme is for {} sides, the face has {}", wants_quad ? 4 : 3, sides);
  }
  if (scheme == PatchScheme::kG2Gregory && !face.pushes.empty()) {
    return "a G2-Gregory patch is not pushed by twists; give control vectors of its edges";
  }
  const bool cubic_only = scheme == PatchScheme::kGregory || scheme == PatchScheme::kGregoryTriangle ||
                          scheme == PatchScheme::kG2Gregory;
  if (cubic_only && degree > 3) {
    return fmt::format("its scheme needs cubic edges, one has degree {}; take Brown quads or loft triangles",
                       degree);
  }
  const int most = sides == 4 ? kMaxBrownDegree : 4;
  if (degree > most) {
    return fmt::format("an edge has degree {}; at most {} beside a face of {} sides", degree, most, sides);
  }
  return std::nullopt;
}

PatchShape MakeFacePatch(const FaceBoundary& face, PatchScheme scheme) {
  if (face.sides == 3) {
    return scheme == PatchScheme::kGregoryTriangle ? QuarticTriangle(face) : LoftedTriangle(face);
  }
  if (scheme == PatchScheme::kG2Gregory) return G2GregoryQuad(face);
  const bool cubic = HighestDegree(face) == 3;
  return scheme == PatchScheme::kBrown || !cubic ? BrownQuad(face) : GregoryQuad(face);
}

}  // namespace patchmill
