// Patches of every kind as B-spline surfaces: the same points exactly, or within the stated distance.
#include "core/exchange/spline_surfaces.h"

#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/exchange/iges.h"
#include "core/exchange/step.h"
#include "core/patch/piece.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using Blend = GregoryPatch::Blend;

SplineSurfaces Exported(PatchShape shape) {
  const auto made = SplineSurfacesOf(testing::Single(std::move(shape)), RunContext(1));
  EXPECT_TRUE(made.ok()) << made.status();
  return made.ok() ? *made : SplineSurfaces{};
}

BsplinePatch Nurbs() {
  BsplinePatch patch{3, 2, {0, 0, 0, 0, 0.3, 0.7, 0.7, 1, 1, 1, 1}, {2, 2, 2, 3, 5, 5, 5}, {}, {}};
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < 4; ++j) {
      patch.points.emplace_back(9.0 * i + j, 8.0 * j - i, 5 * std::sin(2.0 * i + 3.0 * j * j));
      patch.weights.push_back(1.0 + 0.4 * std::cos(i + 2.0 * j));
    }
  }
  return patch;
}

// Largest distance of the surfaces from `shape`, found from the nearest of its own points by Gauss-Newton.
double DistanceFrom(const PatchShape& shape, const SplineSurfaces& surfaces) {
  const std::vector<Piece> pieces = SplitIntoPieces(PatchId{0}, shape);
  constexpr int kGrid = 12;
  double most = 0.0;
  for (const SplineSurface& s : surfaces.surfaces) {
    for (int i = 0; i <= 4; ++i) {
      for (int j = 0; j <= 4; ++j) {
        const Vec3 p = Position(PatchShape(s.surface), i / 4.0, j / 4.0);
        double best = kInfinity;
        const Piece* on = nullptr;
        Vec2 at = Vec2::Zero();
        for (const Piece& piece : pieces) {
          for (int a = 0; a <= kGrid; ++a) {
            for (int b = 0; b <= kGrid; ++b) {
              const double d = (Position(piece, a / double(kGrid), b / double(kGrid)) - p).norm();
              if (d < best) best = d, on = &piece, at = Vec2(a, b) / kGrid;
            }
          }
        }
        for (int round = 0; round < 60; ++round) {
          const SurfaceJet jet = Evaluate(*on, at.x(), at.y());
          const Vec3 r = p - jet.p;
          best = std::min(best, r.norm());
          const double e = jet.du.squaredNorm(), f = jet.du.dot(jet.dv), g = jet.dv.squaredNorm(),
                       w = e * g - f * f;
          if (!(w > 0)) break;
          const double x = jet.du.dot(r), y = jet.dv.dot(r);
          at = (at + Vec2((g * x - f * y) / w, (e * y - f * x) / w)).cwiseMax(0.0).cwiseMin(1.0);
        }
        most = std::max(most, best);
      }
    }
  }
  return most;
}

TEST(SplineSurfaces, KindsOfOtherSystemsAreExact) {
  for (const PatchShape& shape : {PatchShape(testing::RandomBezier(1, 3, 4, false)),
                                  PatchShape(testing::RandomBezier(2, 4, 3, true)), PatchShape(Nurbs())}) {
    const SplineSurfaces made = Exported(shape);
    EXPECT_TRUE(made.findings.empty());
    ASSERT_EQ(made.surfaces.size(), 1u);
    for (const double u : {0.0, 0.21, 0.5, 0.83, 1.0}) {
      for (const double v : {0.0, 0.37, 0.66, 1.0}) {
        EXPECT_LE((Position(PatchShape(made.surfaces[0].surface), u, v) - Position(shape, u, v)).norm(),
                  1e-12);
      }
    }
  }
}

TEST(SplineSurfaces, TrianglesBlendedBordersAndOpenKnotsAreExact) {
  for (const PatchShape& shape :
       {PatchShape(testing::RandomKnots(3, 3, 2, false)), PatchShape(testing::RandomKnots(4, 3, 3, true)),
        PatchShape(testing::RandomTriangle(5, 4, false)), PatchShape(testing::RandomTriangle(6, 3, true)),
        PatchShape(testing::RandomHosaka(15, 3, false, true)),
        PatchShape(testing::RandomHosaka(16, 4, true, true))}) {
    const SplineSurfaces made = Exported(shape);
    EXPECT_TRUE(made.findings.empty());
    EXPECT_LE(DistanceFrom(shape, made), 1e-9);
  }
}

TEST(SplineSurfaces, OtherKindsAreFittedAndNamedOnce) {
  for (const PatchShape& shape :
       {PatchShape(testing::RandomGregory(7, Blend::kCorner)),
        PatchShape(testing::RandomGregory(8, Blend::kEdge)), PatchShape(testing::RandomBrown(9, 4, 5)),
        PatchShape(testing::RandomGregoryTriangle(10, Blend::kCorner)),
        PatchShape(testing::RandomLoftTriangle(12, 3, false)), PatchShape(testing::RandomG2Gregory(14, 6))}) {
    const SplineSurfaces made = Exported(shape);
    ASSERT_EQ(made.findings.size(), 1u);
    EXPECT_EQ(made.findings[0].code, "EXPORT_FITTED");
    EXPECT_LE(DistanceFrom(shape, made), kSplineFit);
    EXPECT_LE(made.surfaces.size(), 2000u);
  }
}

TEST(SplineSurfaces, AClosedSurfaceIsDivided) {
  // A tube whose section is one closed Bezier curve.
  BezierPatch tube{4, 1, {}, {}};
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(9, 0, 4), Vec3(0, 0, 12), Vec3(-9, 0, 4), Vec3(0, 0, 0)}) {
    tube.points.push_back(p);
    tube.points.push_back(p + Vec3(0, 20, 0));
  }
  const SplineSurfaces made = Exported(tube);
  EXPECT_EQ(made.surfaces.size(), 4u);
  EXPECT_LE(DistanceFrom(tube, made), 1e-9);
}

TEST(SplineSurfaces, NamesCarryNoSignsOfTheFormats) {
  PatchModel model = testing::Plane(10);
  model.patches[0].id = "lid'; \\X2\\ \n" + std::string(100, 'x');
  const auto made = SplineSurfacesOf(model, RunContext(1));
  ASSERT_TRUE(made.ok());
  EXPECT_THAT(made->surfaces[0].name, ::testing::StartsWith("lid; X2 x"));
  EXPECT_EQ(made->surfaces[0].name.size(), kMaxSplineName);
}

TEST(SplineSurfaces, EndWhenCancelled) {
  RunContext run(1);
  run.Cancel();
  EXPECT_EQ(SplineSurfacesOf(testing::Plane(10), run).status().code(), absl::StatusCode::kCancelled);
}

// Every line of an IGES file has 80 columns, its sections are numbered, and the last line counts them.
TEST(IgesText, HasTheLinesOfTheStandard) {
  const std::string text = IgesText(Exported(Nurbs()));
  std::map<char, int> lines;
  std::size_t at = 0;
  for (std::size_t end; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    ASSERT_EQ(end - at, 80u);
    EXPECT_EQ(std::stoi(text.substr(at + 73, 7)), ++lines[text[at + 72]]);
  }
  EXPECT_EQ(at, text.size());
  EXPECT_EQ(lines['D'], 2);
  const std::string counts = text.substr(text.size() - 81, 32);
  EXPECT_EQ(counts, fmt::format("S{:7}G{:7}D{:7}P{:7}", lines['S'], lines['G'], lines['D'], lines['P']));
}

TEST(StepText, RefersToWhatIsThere) {
  const std::string text = StepText(Exported(Nurbs()));
  int last = 0;
  std::size_t at = 0;
  for (std::size_t end; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    const std::string line = text.substr(at, end - at);
    if (line.empty() || line[0] != '#') continue;
    EXPECT_EQ(std::stoi(line.substr(1)), ++last);
    for (std::size_t k = line.find('#', 1); k != std::string::npos; k = line.find('#', k + 1))
      EXPECT_LT(std::stoi(line.substr(k + 1)), last) << line;
    EXPECT_EQ(line.back(), ';');
  }
  EXPECT_GT(last, 60);
}

}  // namespace
}  // namespace patchmill
