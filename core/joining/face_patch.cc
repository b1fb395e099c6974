#include "core/joining/face_patch.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "core/base/index.h"

namespace patchmill {
namespace {

int HighestDegree(const FaceBoundary& face) {
  int degree = 3;
  for (int k = 0; k < face.sides; ++k) degree = std::max(degree, face.curve[At(k)].degree);
  return degree;
}

bool AllCubic(const FaceBoundary& face) {
  const auto first = face.curve.begin();
  return std::all_of(first, first + face.sides,
                     [](const BezierChain& c) { return c.degree == 3 && c.spans() == 1; });
}

BezierChain Turned(const BezierChain& chain, bool reversed) { return reversed ? Reversed(chain) : chain; }

// Edge and rail (edge + tangent/3) of one side, with the given degree and breaks.
struct Strip {
  std::vector<Vec3> edge, rail;
};
Strip StripOf(const FaceBoundary& face, int side, int degree, bool reversed,
              const std::vector<double>& breaks = {0.0, 1.0}) {
  const auto alike = [&](const BezierChain& chain) {
    return CutAt(Elevated(Turned(chain, reversed), degree), breaks).points;
  };
  Strip strip;
  strip.edge = strip.rail = alike(face.curve[At(side)]);
  const std::vector<Vec3> tangent = alike(face.tangent[At(side)]);
  for (std::size_t i = 0; i < strip.rail.size(); ++i) strip.rail[i] += tangent[i] / 3.0;
  return strip;
}

// Common breaks of two opposite sides, of which the second runs reversed.
std::vector<double> BreaksOf(const FaceBoundary& face, int side, int opposite) {
  const std::size_t a = At(side), b = At(opposite);
  return CommonBreaks({face.curve[a], face.tangent[a], Reversed(face.curve[b]), Reversed(face.tangent[b])});
}

std::vector<double> Inner(const std::vector<double>& breaks) {
  return {breaks.begin() + 1, breaks.end() - 1};
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
  patch.degree_u = std::max({3, face.curve[0].degree, face.curve[2].degree});
  patch.degree_v = std::max({3, face.curve[1].degree, face.curve[3].degree});
  const std::vector<double> u = BreaksOf(face, 0, 2), v = BreaksOf(face, 1, 3);
  const Strip v0 = StripOf(face, 0, patch.degree_u, false, u), v1 = StripOf(face, 2, patch.degree_u, true, u);
  const Strip u0 = StripOf(face, 3, patch.degree_v, true, v), u1 = StripOf(face, 1, patch.degree_v, false, v);
  patch.breaks_u = Inner(u);
  patch.breaks_v = Inner(v);
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

// [shapes (13), (14)]. The radial derivative on a side is 4 (R - C), so the cubic R is C + b/4.
PatchShape QuarticTriangle(const FaceBoundary& face) {
  GregoryTriangle patch;
  patch.blend = GregoryPatch::Blend::kEdge;
  for (int k = 0; k < 3; ++k) {
    const auto& c = face.curve[At(k)].points;
    const auto b = Elevated(face.tangent[At(k)], 3).points;
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

// Rows 1 and 2 beside every side of a bisextic net [joining (25)]. The middle point belongs to no side
// [joining (26)].
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

// [shapes (23)]: made of the four edges alone, with breaks where vertices lie on them.
PatchShape HosakaQuad(const FaceBoundary& face) {
  HosakaPatch patch;
  const int n = patch.degree = HighestDegree(face);
  const auto edge = [&](int side, bool reversed) {
    return Elevated(Turned(face.curve[At(side)], reversed), n).points;
  };
  patch.points = edge(0, false);
  const std::vector<Vec3> v1 = edge(2, true);
  patch.points.insert(patch.points.end(), v1.begin(), v1.end());
  AddInner(edge(3, true), patch.points);
  AddInner(edge(1, false), patch.points);
  constexpr std::array<int, 4> kFunction = {0, 3, 2, 1};  // f1..f4: v=0, u=0, v=1, u=1
  for (int side = 0; side < 4; ++side) {
    auto& breaks = patch.breaks[At(kFunction[At(side)])];
    for (const double at : face.breaks[At(side)]) {
      const double along = side < 2 ? at : 1.0 - at;
      breaks.push_back({along, along});
    }
    if (side >= 2) std::ranges::reverse(breaks);
  }
  return patch;
}

}  // namespace

std::optional<std::string> SchemeFault(const NetworkFace& face, const EdgeDemand& edges) {
  const auto& [degree, spans, breaks] = edges;
  const PatchScheme scheme = face.scheme;
  const int sides = static_cast<int>(face.vertices.size());
  const bool wants_quad = scheme == PatchScheme::kGregory || scheme == PatchScheme::kBrown ||
                          scheme == PatchScheme::kG2Gregory || scheme == PatchScheme::kHosaka;
  const bool wants_triangle = scheme == PatchScheme::kLoftTriangle || scheme == PatchScheme::kGregoryTriangle;
  if ((wants_quad && sides == 3) || (wants_triangle && sides == 4)) {
    return fmt::format("its scheme is for {} sides, the face has {}", wants_quad ? 4 : 3, sides);
  }
  const bool twisted = !face.pushes.empty() || !face.twists.empty();
  if (scheme == PatchScheme::kG2Gregory && twisted) {
    return "a G2-Gregory patch is not shaped by twists; give control vectors of its edges";
  }
  if (scheme == PatchScheme::kHosaka && twisted) {
    return "a Hosaka patch has no twists at its corners; shape its edges, or take a Brown quad";
  }
  if (scheme == PatchScheme::kHosaka && breaks > kMaxHosakaBreaks) {
    return fmt::format("{} vertices lie on one edge of it; at most {}", breaks, kMaxHosakaBreaks);
  }
  if (spans > 1 && (sides == 3 || (scheme != PatchScheme::kAuto && scheme != PatchScheme::kBrown))) {
    return fmt::format("an edge has {} spans, which only a Brown quad takes; {}", spans,
                       sides == 3
                           ? "insert vertices at its knots and an edge from each to the corner opposite"
                           : "take that scheme");
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
  if (scheme == PatchScheme::kHosaka) return HosakaQuad(face);
  return scheme == PatchScheme::kBrown || !AllCubic(face) ? BrownQuad(face) : GregoryQuad(face);
}

}  // namespace patchmill
