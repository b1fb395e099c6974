#include "tests/support/drawn_nets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include "core/base/index.h"
#include "core/base/vec.h"
#include "core/math/bernstein.h"
#include "tests/support/json.h"

namespace patchmill::testing {
namespace {

std::vector<BezierCurve> Pieces(const Json& from, double scale) {
  std::vector<BezierCurve> pieces;
  for (const Json& piece : from.Items()) {
    BezierCurve& curve = pieces.emplace_back();
    for (const Json& p : piece.Items()) curve.points.push_back(scale * p.Vector());
  }
  return pieces;
}

// One polynomial for a chain of cubics: ends kept, least squares at equal steps of the chain in between.
BezierCurve OneSpan(const std::vector<BezierCurve>& pieces, int degree) {
  if (pieces.size() == 1) return Elevated(pieces[0], 3);
  std::vector<Vec3> samples;
  for (const BezierCurve& curve : pieces) {
    for (int k = samples.empty() ? 0 : 1; k <= 40; ++k) samples.push_back(Evaluate(curve, k / 40.0).p);
  }
  std::vector<double> t = {0.0};
  for (std::size_t k = 1; k < samples.size(); ++k)
    t.push_back(t.back() + (samples[k] - samples[k - 1]).norm());
  const auto rows = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd basis(rows, degree - 1), right(rows, 3);
  for (Eigen::Index k = 0; k < rows; ++k) {
    double b[kMaxBasisDegree + 1];
    AllBernstein(degree, t[At(static_cast<int>(k))] / t.back(), b);
    for (int i = 1; i < degree; ++i) basis(k, i - 1) = b[i];
    right.row(k) =
        (samples[At(static_cast<int>(k))] - b[0] * samples.front() - b[degree] * samples.back()).transpose();
  }
  const Eigen::MatrixXd inner = basis.colPivHouseholderQr().solve(right);
  BezierCurve curve;
  curve.points.push_back(samples.front());
  for (int i = 1; i < degree; ++i) curve.points.push_back(inner.row(i - 1).transpose());
  curve.points.push_back(samples.back());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    EXPECT_LE((Evaluate(curve, t[k] / t.back()).p - samples[k]).norm(), 0.01 * t.back());
  }
  return curve;
}

bool HasSide(const NetworkFace& face, int a, int b) {
  const auto& loop = face.vertices;
  for (std::size_t s = 0; s < loop.size(); ++s) {
    if (std::minmax(loop[s], loop[(s + 1) % loop.size()]) == std::minmax(a, b)) return true;
  }
  return false;
}

// Normals of the faces beside an edge at one of its vertices, each once.
std::vector<Vec3> NormalsBeside(const CurveNetwork& network, int vertex, int a, int b) {
  std::vector<Vec3> normals;
  for (const NetworkVertex::Normal& n : network.vertices[At(vertex)].normals) {
    const bool beside = n.faces.empty() || std::ranges::any_of(n.faces, [&](int f) {
                          return HasSide(network.faces[At(f)], a, b);
                        });
    if (beside) normals.push_back(n.direction);
  }
  return normals;
}

struct Drawing {
  std::string file;
  double scale = 1.0;
  std::vector<std::vector<int>> faces;
  std::vector<std::tuple<int, Vec3, std::vector<int>>> normals;  // vertex, outward, faces (none: all)
  std::function<bool(int, int)> crease;
  // Strokes in two parts: the vertex between them is a T-junction, or no vertex where no face has it.
  std::vector<std::array<int, 3>> through = {};
  double largest_turn = 0.0;  // rad, by which a drawn end is laid into its tangent plane
};

struct Stroke {
  int start = 0, end = 0;
  std::vector<BezierCurve> pieces;
};

// The stroke between two vertices, from the first.
std::vector<BezierCurve> From(const std::vector<Stroke>& strokes, int start, int end) {
  for (const Stroke& s : strokes) {
    if (s.start == start && s.end == end) return s.pieces;
    if (s.start != end || s.end != start) continue;
    std::vector<BezierCurve> back;
    for (auto piece = s.pieces.rbegin(); piece != s.pieces.rend(); ++piece) back.push_back(Reversed(*piece));
    return back;
  }
  ADD_FAILURE() << "no stroke " << start << "-" << end;
  return {};
}

double Length(const std::vector<BezierCurve>& pieces) {
  double length = 0.0;
  for (const BezierCurve& curve : pieces) {
    for (int k = 0; k < 40; ++k)
      length += (Evaluate(curve, (k + 1) / 40.0).p - Evaluate(curve, k / 40.0).p).norm();
  }
  return length;
}

// Vertices of no face are dropped, the others move up.
CurveNetwork WithoutUnused(CurveNetwork network) {
  std::vector<int> renamed(network.vertices.size(), -1);
  for (const NetworkFace& face : network.faces) {
    for (const int v : face.vertices) renamed[At(v)] = 0;
  }
  std::vector<NetworkVertex> kept;
  for (std::size_t v = 0; v < renamed.size(); ++v) {
    if (renamed[v] < 0) continue;
    renamed[v] = static_cast<int>(kept.size());
    kept.push_back(std::move(network.vertices[v]));
  }
  const auto rename = [&](int& v) { v = renamed[At(v)]; };
  network.vertices = std::move(kept);
  for (NetworkFace& face : network.faces) std::ranges::for_each(face.vertices, rename);
  for (NetworkEdge& edge : network.edges) rename(edge.start), rename(edge.end);
  for (NetworkVertex& vertex : network.vertices) {
    if (vertex.on_edge) rename(vertex.on_edge->start), rename(vertex.on_edge->end);
  }
  return network;
}

// Strokes beside no face are left out, and those that end at a T-junction: their ends follow from its place.
CurveNetwork Net(const Drawing& drawing) {
  const Json data = LoadJson(drawing.file);
  CurveNetwork network;
  int last = 0;
  for (const auto& loop : drawing.faces) {
    network.faces.push_back({"", loop, PatchScheme::kAuto, {}});
    last = std::max(last, std::ranges::max(loop));
  }
  for (int v = 0; v <= last; ++v) {
    network.vertices.emplace_back().position = drawing.scale * data["nodes"][v]["position"].Vector();
  }
  for (const auto& [vertex, n, faces] : drawing.normals) {
    network.vertices[At(vertex)].normals.push_back({n.normalized(), faces});
  }
  std::vector<Stroke> strokes;
  for (const Json& segment : data["segments"].Items()) {
    strokes.push_back({static_cast<int>(segment["nodes"][0].Number()),
                       static_cast<int>(segment["nodes"][1].Number()),
                       Pieces(segment["ctrl_pts"], drawing.scale)});
  }
  for (const auto& [start, middle, end] : drawing.through) {
    Stroke whole{start, end, From(strokes, start, middle)};
    const double before = Length(whole.pieces);
    const std::vector<BezierCurve> rest = From(strokes, middle, end);
    if (std::ranges::any_of(network.faces, [&, v = middle](const NetworkFace& f) {
          return std::ranges::count(f.vertices, v) > 0;
        })) {
      network.vertices[At(middle)].on_edge = {start, end, before / (before + Length(rest))};
    }
    whole.pieces.insert(whole.pieces.end(), rest.begin(), rest.end());
    std::erase_if(strokes, [v = middle](const Stroke& s) { return s.start == v || s.end == v; });
    strokes.push_back(std::move(whole));
  }
  for (const auto& [start, end, pieces] : strokes) {
    bool used = false, beside_triangle = false;
    for (const NetworkFace& face : network.faces) {
      if (!HasSide(face, start, end)) continue;
      used = true;
      beside_triangle = beside_triangle || face.vertices.size() == 3;
    }
    if (!used) continue;
    BezierCurve curve = OneSpan(pieces, beside_triangle ? 4 : 7);
    curve.points.front() = network.vertices[At(start)].position;
    curve.points.back() = network.vertices[At(end)].position;
    // Drawn ends are laid into the tangent planes of the faces that meet smoothly there.
    for (const bool first : {true, false}) {
      const int vertex = first ? start : end;
      const std::vector<Vec3> normals = NormalsBeside(network, vertex, start, end);
      if (normals.empty()) continue;
      Vec3& q = first ? curve.points[1] : curve.points[curve.points.size() - 2];
      const Vec3 p = network.vertices[At(vertex)].position, d = q - p;
      const Vec3 line = normals.size() == 2 ? Vec3(normals[0].cross(normals[1]).normalized()) : Vec3::Zero();
      const Vec3 laid =
          normals.size() == 2 ? Vec3(line * line.dot(d)) : Vec3(d - normals[0] * normals[0].dot(d));
      EXPECT_GE(laid.dot(d), std::cos(drawing.largest_turn) * laid.norm() * d.norm())
          << start << "-" << end << " at " << vertex;
      q = p + laid;
    }
    network.edges.push_back({"", start, end, CurveEdge{curve}, drawing.crease(start, end)});
  }
  return WithoutUnused(std::move(network));
}

}  // namespace

CurveNetwork DrawnWedge(const std::string& folder) {
  Drawing wedge;
  wedge.file = folder + "/11-2-2.graph.json";
  wedge.scale = 100;
  // Hexagons at the back and below the back are cut in two by the plain edges 3-8 and 8-9.
  wedge.faces = {{2, 3, 0, 1}, {2, 1, 6, 4}, {0, 5, 7, 1}, {4, 6, 9, 8}, {5, 8, 9, 7},
                 {6, 1, 9},    {7, 9, 1},    {2, 4, 8, 3}, {0, 3, 8, 5}};
  wedge.normals = {{3, Vec3(0, 0, 1), {7, 8}},           {8, Vec3(0, 0, 1), {7, 8}},
                   {8, Vec3(0, -1, -0.16), {3, 4}},      {9, Vec3(0, -1, -0.16), {3, 4}},
                   {9, Vec3(0, -0.942, -0.336), {5, 6}}, {1, Vec3(0, -0.92, -0.40), {5, 6}}};
  wedge.crease = [](int a, int b) {
    const std::pair<int, int> ends = std::minmax(a, b);
    return ends != std::pair(1, 9);
  };
  wedge.largest_turn = Radians(30);  // the back's border rises to its middle: drawn with a kink of 27 degrees
  return Net(wedge);
}

CurveNetwork DrawnMouse(const std::string& folder) {
  Drawing mouse;
  mouse.file = folder + "/computer-mouse.graph.json";
  mouse.scale = 75;
  mouse.faces = {{6, 7, 24, 13},   {7, 8, 25, 24},   {8, 9, 14, 25},                      // left, below
                 {13, 24, 20, 12}, {24, 25, 21, 20}, {25, 14, 15, 21},                    // left, above
                 {9, 10, 27, 14},  {14, 27, 23, 15}, {10, 1, 26, 27},  {27, 26, 22, 23},  // back
                 {1, 2, 19, 22},   {2, 3, 19},                                            // right
                 {3, 4, 11, 19},   {4, 5, 12, 11},   {5, 6, 12},                          // front
                 {12, 20, 17, 11}, {20, 21, 16, 17}, {21, 15, 16},     {16, 15, 23},
                 {17, 16, 23, 22},  // top
                 {11, 17, 22, 19}};
  mouse.normals = {{1, Vec3(0.77, 0.63, 0.11), {}},         {2, Vec3(0.83, 0.29, -0.48), {}},
                   {3, Vec3(0.57, 0.24, -0.79), {}},        {4, Vec3(0.02, 0.48, -0.88), {}},
                   {5, Vec3(-0.89, 0.44, -0.11), {}},       {6, Vec3(-0.91, 0.36, 0.22), {}},
                   {7, Vec3(-0.38, 0.88, -0.29), {}},       {8, Vec3(-0.34, 0.93, 0.17), {}},
                   {9, Vec3(-0.42, 0.52, 0.75), {}},        {10, Vec3(0.18, 0.72, 0.66), {}},
                   {11, Vec3(-0.03, 0.96, -0.29), {}},      {12, Vec3(-0.80, 0.53, 0.28), {}},
                   {14, Vec3(-0.29, 0.69, 0.66), {}},       {15, Vec3(-0.17, 0.82, 0.54), {}},
                   {16, Vec3(-0.02, 0.88, 0.47), {}},       {17, Vec3(0.11, 0.95, 0.28), {}},
                   {19, Vec3(0.70, 0.63, -0.33), {}},       {20, Vec3(-0.72, 0.66, -0.24), {15, 16}},
                   {20, Vec3(-0.91, -0.13, -0.39), {3, 4}}, {21, Vec3(-0.49, 0.83, 0.28), {16, 17}},
                   {21, Vec3(-0.87, -0.11, 0.49), {4, 5}},  {22, Vec3(0.46, 0.86, 0.22), {}},
                   {23, Vec3(0.14, 0.85, 0.51), {}},        {24, Vec3(-0.83, 0.36, -0.42), {}},
                   {25, Vec3(-0.76, 0.62, 0.21), {}},       {27, Vec3(0.15, 0.82, 0.56), {}}};
  mouse.crease = [](int a, int b) {
    const std::pair<int, int> ends = std::minmax(a, b);
    return ends == std::pair(12, 20) || ends == std::pair(20, 21) || ends == std::pair(15, 21);
  };
  // Strokes from 24 and 27 end on two of them; nothing does on the others, at their joints with the rim.
  mouse.through = {{12, 13, 6}, {22, 26, 1}, {11, 18, 4}, {10, 0, 1}};
  mouse.largest_turn = Radians(13);
  return Net(mouse);
}

std::vector<DrawnCurve> DrawnStrokes(const std::string& file, double scale) {
  const Json data = LoadJson(file);
  std::vector<DrawnCurve> curves;
  for (const Json& stroke : data["strokes"].Items()) {
    BezierChain chain;
    chain.degree = 3;
    for (const Json& segment : stroke["segments"].Items()) {
      for (const BezierCurve& piece :
           Pieces(data["segments"][static_cast<int>(segment.Number())]["ctrl_pts"], scale)) {
        const std::vector<Vec3> points = Elevated(piece, 3).points;
        chain.points.insert(chain.points.end(), points.begin() + (chain.points.empty() ? 0 : 1),
                            points.end());
      }
    }
    const std::size_t spans = (chain.points.size() - 1) / 3;
    for (std::size_t k = 0; k <= spans; ++k) chain.breaks.push_back(double(k) / double(spans));
    curves.push_back({std::to_string(static_cast<int>(stroke["id"].Number())), std::move(chain)});
  }
  return curves;
}

}  // namespace patchmill::testing
