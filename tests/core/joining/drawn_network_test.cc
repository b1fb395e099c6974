// A net drawn by hand in three dimensions (curves only) becomes a joined surface: faces and normals are
// written here once.
#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include "core/joining/continuity.h"
#include "core/joining/join_network.h"
#include "tests/support/json.h"

namespace patchmill {
namespace {

using testing::Json;

std::size_t At(int i) { return static_cast<std::size_t>(i); }

// One polynomial for a chain of cubics: ends kept, least squares at equal steps of the chain in between.
BezierCurve OneSpan(const Json& pieces, int degree) {
  std::vector<Vec3> samples;
  for (const Json& piece : pieces.Items()) {
    BezierCurve curve;
    for (const Json& p : piece.Items()) curve.points.push_back(100 * p.Vector());
    if (pieces.Items().size() == 1) return Elevated(curve, 3);
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

// `11-2-2`: a wedge, mirrored in x = 0. Its strokes are edges to be seen, creases; the two halves meet
// smoothly.
CurveNetwork Wedge() {
  const Json data = testing::LoadJson(PATCHMILL_SOURCE_DIR "/tests/models/networks/11-2-2.graph.json");
  CurveNetwork network;
  for (const Json& node : data["nodes"].Items()) {
    network.vertices.emplace_back().position = 100 * node["position"].Vector();
  }
  // Hexagons at the back and below the back are cut in two by the plain edges 3-8 and 8-9.
  for (const std::vector<int>& loop : std::vector<std::vector<int>>{{2, 3, 0, 1},
                                                                    {2, 1, 6, 4},
                                                                    {0, 5, 7, 1},
                                                                    {4, 6, 9, 8},
                                                                    {5, 8, 9, 7},
                                                                    {6, 1, 9},
                                                                    {7, 9, 1},
                                                                    {2, 4, 8, 3},
                                                                    {0, 3, 8, 5}}) {
    network.faces.push_back({"", loop, PatchScheme::kAuto, {}});
  }
  // Where the halves meet: vertex, normal, its two faces.
  const auto normal = [&](int vertex, const Vec3& n, std::vector<int> faces) {
    network.vertices[At(vertex)].normals.push_back({n.normalized(), std::move(faces)});
  };
  normal(3, Vec3(0, 0, 1), {7, 8});
  normal(8, Vec3(0, 0, 1), {7, 8});
  normal(8, Vec3(0, -1, -0.16), {3, 4});
  normal(9, Vec3(0, -1, -0.16), {3, 4});
  normal(9, Vec3(0, -0.942, -0.336), {5, 6});
  normal(1, Vec3(0, -0.92, -0.40), {5, 6});

  for (const Json& segment : data["segments"].Items()) {
    const int start = static_cast<int>(segment["nodes"][0].Number()),
              end = static_cast<int>(segment["nodes"][1].Number());
    const bool middle = std::minmax(start, end) == std::minmax(9, 1);
    const bool beside_triangle = middle || start == 6 || start == 7;
    BezierCurve curve = OneSpan(segment["ctrl_pts"], beside_triangle ? 4 : 7);
    curve.points.front() = network.vertices[At(start)].position;
    curve.points.back() = network.vertices[At(end)].position;
    // Drawn ends are laid into the tangent planes of the faces that meet smoothly there.
    for (const bool first : {true, false}) {
      const int vertex = first ? start : end;
      std::vector<Vec3> normals;
      for (const NetworkVertex::Normal& n : network.vertices[At(vertex)].normals) {
        const bool bounds = std::ranges::any_of(n.faces, [&](int f) {
          const auto& loop = network.faces[At(f)].vertices;
          for (std::size_t s = 0; s < loop.size(); ++s) {
            if (std::minmax(loop[s], loop[(s + 1) % loop.size()]) == std::minmax(start, end)) return true;
          }
          return false;
        });
        if (bounds) normals.push_back(n.direction);
      }
      if (normals.empty()) continue;
      Vec3& q = first ? curve.points[1] : curve.points[curve.points.size() - 2];
      const Vec3 p = network.vertices[At(vertex)].position, d = q - p;
      const Vec3 line = normals.size() == 2 ? normals[0].cross(normals[1]).normalized() : Vec3::Zero();
      const Vec3 laid =
          normals.size() == 2 ? Vec3(line * line.dot(d)) : Vec3(d - normals[0] * normals[0].dot(d));
      // The back's border rises to its middle: drawn with a kink of 27 degrees there.
      EXPECT_GE(laid.dot(d), std::cos(Radians(30)) * laid.norm() * d.norm());
      q = p + laid;
    }
    network.edges.push_back({"", start, end, CurveEdge{curve}, !middle});
  }
  return network;
}

TEST(DrawnNetwork, BecomesAClosedJoinedSurface) {
  const CurveNetwork network = Wedge();
  const JoinedNetwork joined = JoinNetwork(network);
  for (const Diagnostic& d : joined.findings) ADD_FAILURE() << d.code << ": " << d.message;
  ASSERT_EQ(joined.model.patches.size(), 9u);
  auto checked = BuildNetwork(joined.model);
  ASSERT_TRUE(checked.ok());
  EXPECT_EQ(checked->open_edge_count, 0);
  EXPECT_EQ(checked->euler_characteristic, 2);
  const auto report = MeasureContinuity(*checked, 300, RunContext(1));
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->edges.size(), 17u);
  std::set<std::pair<int, int>> smooth;
  for (const EdgeContinuity& joint : report->edges) {
    EXPECT_LE(joint.max_gap, 1e-10);
    if (joint.max_angle <= 1e-6) {
      smooth.emplace(joint.a.patch.value, joint.b.patch.value);
      EXPECT_LE(joint.max_angle, 1e-10);
    }
  }
  EXPECT_EQ(smooth, (std::set<std::pair<int, int>>{{3, 4}, {5, 6}, {7, 8}}));
}

}  // namespace
}  // namespace patchmill
