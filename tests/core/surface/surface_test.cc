#include "core/surface/surface.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <span>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/network/control_points.h"
#include "tests/core/surface/surface_models.h"
#include "tests/support/clock.h"
#include "tests/support/peak_memory.h"
#include "tests/support/random.h"
#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;
using testing::MakeSurface;
using testing::Random;

bool InsideOriented(const RectBounds& bounds, const Vec3& p, double slack) {
  const Vec3 d = p - bounds.center;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(d.dot(bounds.axis.col(k))) > bounds.half[k] + slack) return false;
  }
  return true;
}

bool Inside(const Box3& box, const Vec3& p, double slack) {
  return (p.array() >= box.min.array() - slack).all() && (p.array() <= box.max.array() + slack).all();
}

// The box of the node that holds each leaf.
std::vector<Box3> BoxesOfLeaves(const Surface& s) {
  std::vector<Box3> boxes(s.leaves.size());
  for (const SurfaceNode& node : s.nodes) {
    if (node.leaf >= 0) boxes[static_cast<std::size_t>(node.leaf)] = node.box;
  }
  return boxes;
}

class EverySurface : public ::testing::TestWithParam<testing::NamedModel> {};

TEST_P(EverySurface, LeavesTileTheirPiecesAndHoldThem) {
  for (const double thickness : {1.0, 0.05}) {
    const Surface s = MakeSurface(GetParam().model, thickness);
    const double slack = 1e-12 * s.scale;
    const std::vector<Box3> boxes = BoxesOfLeaves(s);
    std::vector<double> area(s.pieces.size(), 0.0);
    for (std::size_t i = 0; i < s.leaves.size(); ++i) {
      const SurfaceLeaf& leaf = s.leaves[i];
      ASSERT_LT(leaf.u0, leaf.u1);
      ASSERT_LT(leaf.v0, leaf.v1);
      area[leaf.piece.index()] +=
          (static_cast<double>(leaf.u1) - leaf.u0) * (static_cast<double>(leaf.v1) - leaf.v0);
      const RectBounds bounds = leaf.Bounds(boxes[i]);
      EXPECT_LT((bounds.axis.transpose() * bounds.axis - Eigen::Matrix3d::Identity()).norm(), 1e-14);
      EXPECT_GT(bounds.axis.determinant(), 0.0);
      EXPECT_LE(bounds.half.z(), thickness + 2e-7 * bounds.half.norm());
      // No worse than what is measured afresh, but for rounding.
      const RectBounds afresh = BoundNet(SubNet(s.piece(leaf.piece).net, leaf.u0, leaf.u1, leaf.v0, leaf.v1));
      for (int k = 0; k < 3; ++k) {
        EXPECT_LE(bounds.half[k], afresh.half[k] + 2e-7 * afresh.half.norm() + slack);
        EXPECT_GT(bounds.axis.col(k).dot(afresh.axis.col(k)), 1.0 - 1e-12);
      }
      for (int k = 0; k <= 6; ++k) {
        for (int l = 0; l <= 6; ++l) {
          const double u = leaf.u0 + (leaf.u1 - leaf.u0) * k / 6.0,
                       v = leaf.v0 + (leaf.v1 - leaf.v0) * l / 6.0;
          const Vec3 p = Evaluate(s, leaf.piece, u, v).p;
          EXPECT_TRUE(InsideOriented(bounds, p, slack)) << i << " at " << u << ' ' << v;
          EXPECT_TRUE(Inside(boxes[i], p, slack)) << i << " at " << u << ' ' << v;
        }
      }
    }
    for (const double a : area) EXPECT_EQ(a, 1.0);  // dyadic sums are exact
    // Leaves do not overlap: a random place lies in exactly one.
    Random random(1);
    for (int i = 0; i < 100; ++i) {
      const PieceId piece(random.Int(static_cast<int>(s.pieces.size())));
      const double u = random.Unit(), v = random.Unit();
      EXPECT_EQ(std::count_if(s.leaves.begin(), s.leaves.end(),
                              [&](const SurfaceLeaf& leaf) {
                                return leaf.piece == piece && u >= leaf.u0 && u < leaf.u1 && v >= leaf.v0 &&
                                       v < leaf.v1;
                              }),
                1);
    }
  }
}

TEST_P(EverySurface, NetBoundsHoldTheirRectangles) {
  const Surface s = MakeSurface(GetParam().model);
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Piece& piece = s.pieces[static_cast<std::size_t>(random.Int(static_cast<int>(s.pieces.size())))];
    const double size = std::pow(2.0, -random.Int(12));
    const double u0 = (1.0 - size) * random.Unit(), v0 = (1.0 - size) * random.Unit();
    const RectBounds bounds = BoundNet(SubNet(piece.net, u0, u0 + size, v0, v0 + size));
    for (int k = 0; k < 20; ++k) {
      const Vec3 p = Position(piece, u0 + size * random.Unit(), v0 + size * random.Unit());
      EXPECT_TRUE(InsideOriented(bounds, p, 1e-12 * s.scale));
      EXPECT_TRUE(Inside(bounds.box, p, 1e-12 * s.scale));
    }
  }
}

// Walks the tree in depth-first order; returns the index after the subtree.
std::size_t WalkTree(const Surface& s, std::size_t index, int depth, std::vector<int>& seen) {
  EXPECT_LT(depth, 60);
  const SurfaceNode& node = s.nodes[index];
  if (node.leaf >= 0) {
    ++seen[static_cast<std::size_t>(node.leaf)];
    return index + 1;
  }
  const auto right = static_cast<std::size_t>(node.right);
  Box3 both = s.nodes[index + 1].box;
  both.Add(s.nodes[right].box);
  EXPECT_EQ(both.min, node.box.min);
  EXPECT_EQ(both.max, node.box.max);
  EXPECT_EQ(WalkTree(s, index + 1, depth + 1, seen), right);
  return WalkTree(s, right, depth + 1, seen);
}

TEST_P(EverySurface, TreeHoldsEveryLeafOnce) {
  const Surface s = MakeSurface(GetParam().model);
  std::vector<int> seen(s.leaves.size(), 0);
  EXPECT_EQ(WalkTree(s, 0, 0, seen), s.nodes.size());
  EXPECT_THAT(seen, ::testing::Each(1));
  EXPECT_EQ(s.box.min, s.nodes.front().box.min);
  EXPECT_EQ(s.scale, std::max(s.box.min.cwiseAbs().maxCoeff(), s.box.max.cwiseAbs().maxCoeff()));
}

TEST_P(EverySurface, DoesNotDependOnThreads) {
  const Surface a = MakeSurface(GetParam().model, 0.01, 1), b = MakeSurface(GetParam().model, 0.01, 4);
  ASSERT_EQ(a.leaves.size(), b.leaves.size());
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.leaves.size(); ++i) {
    const SurfaceLeaf &x = a.leaves[i], &y = b.leaves[i];
    ASSERT_TRUE(x.piece == y.piece && x.u0 == y.u0 && x.u1 == y.u1 && x.v0 == y.v0 && x.v1 == y.v1);
    ASSERT_TRUE(x.center() == y.center() && x.axis() == y.axis() && x.half() == y.half());
  }
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    const SurfaceNode &x = a.nodes[i], &y = b.nodes[i];
    ASSERT_TRUE(x.box.min == y.box.min && x.box.max == y.box.max && x.right == y.right && x.leaf == y.leaf);
  }
}

// What takes a patch as a whole finds it as it was given, though its points may be with its piece alone.
TEST_P(EverySurface, GivesEveryPatchBack) {
  const PatchModel& given = GetParam().model;
  const Surface s = MakeSurface(given);
  Random random(5);
  const double slack = 1e-13 * (1.0 + s.scale);
  for (std::size_t i = 0; i < given.patches.size(); ++i) {
    const PatchShape& shape = given.patches[i].shape;
    const PatchShape back = ShapeOf(s, PatchId(i));
    EXPECT_EQ(IsTriangle(back), IsTriangle(shape));
    if (const auto* bezier = std::get_if<BezierPatch>(&shape); bezier != nullptr && bezier->weights.empty()) {
      const auto& same = std::get<BezierPatch>(back);
      EXPECT_EQ(std::pair(same.degree_u, same.degree_v), std::pair(bezier->degree_u, bezier->degree_v));
      EXPECT_EQ(same.points, bezier->points);
      EXPECT_TRUE(same.weights.empty());
    }
    for (int k = 0; k < 20; ++k) {
      const double u = random.Unit(), v = IsTriangle(shape) ? (1.0 - u) * random.Unit() : random.Unit();
      const SurfaceJet at = Evaluate(shape, u, v);
      for (const SurfaceJet& jet : {Evaluate(s, PatchId(i), u, v), Evaluate(back, u, v)}) {
        EXPECT_LE((jet.p - at.p).norm(), slack);
        EXPECT_LE((jet.du - at.du).norm() + (jet.dv - at.dv).norm(), 100.0 * slack);
        EXPECT_LE((jet.duu - at.duu).norm() + (jet.duv - at.duv).norm() + (jet.dvv - at.dvv).norm(),
                  1e4 * slack);
      }
    }
  }
}

TEST_P(EverySurface, KeepsNoNetTwice) {
  const Surface s = MakeSurface(GetParam().model);
  for (const Piece& piece : s.pieces) {
    const std::span<const Vec3> kept = ControlPoints(s.network.model.patches[piece.patch.index()].shape);
    if (kept.empty()) continue;
    const auto& net = piece.net.points;
    const bool same =
        kept.size() == net.size() && std::ranges::equal(kept, net, [](const Vec3& p, const Vec4& q) {
          return (p * q.w() - q.head<3>()).norm() <= 1e-12 * (1.0 + p.norm());
        });
    EXPECT_FALSE(same) << "patch " << piece.patch.index();
  }
}

INSTANTIATE_TEST_SUITE_P(Surface, EverySurface, ::testing::ValuesIn(testing::EveryKindOfPatch()),
                         [](const auto& model) { return model.param.name; });

TEST(Surface, PiecesFollowThePatches) {
  const Surface s = MakeSurface(testing::Join({testing::Plane(5.0), testing::RandomBspline(1, {.spans = 3}),
                                               testing::Single(testing::RandomTriangle(2, 3, false))}));
  ASSERT_EQ(s.first_piece.size(), 3u);
  EXPECT_EQ(s.first_piece[0].index(), 0u);
  EXPECT_EQ(s.first_piece[1].index(), 1u);
  EXPECT_EQ(s.first_piece[2].index(), 10u);
  EXPECT_EQ(s.pieces.size(), 13u);
  for (std::size_t i = 0; i < s.pieces.size(); ++i) {
    EXPECT_EQ(s.pieces[i].patch.index(), i < 1 ? 0u : i < 10 ? 1u : 2u);
  }
}

TEST(Surface, APlaneIsOneLeafAndACylinderIsCutInStrips) {
  EXPECT_EQ(MakeSurface(testing::Plane(500.0, 0.0, 0.3, 0.1)).leaves.size(), 1u);
  const Surface cylinder = MakeSurface(testing::Cylinder(Vec3::Zero(), 10.0, 100.0));
  for (const SurfaceLeaf& leaf : cylinder.leaves) {
    EXPECT_NEAR(leaf.half().maxCoeff(), 100.0, 1e-5);
    EXPECT_LT(leaf.half().y(), 1.5);
  }
}

TEST(Surface, BoxesOfACurledFlatPatchHoldLittleAir) {
  // Half a ring between radius 8 and 10, area 18 pi, in a box of 200: thickness alone would never cut it.
  for (const testing::NamedModel& m : testing::EveryKindOfPatch()) {
    if (m.name != "FlatRing") continue;
    double area = 0.0;
    for (const SurfaceLeaf& leaf : MakeSurface(m.model).leaves)
      area += 4.0 * leaf.half().x() * leaf.half().y();
    EXPECT_LT(area, 2.0 * 18.0 * kPi);
    EXPECT_GT(area, 9.0 * kPi);
    return;
  }
  FAIL() << "no FlatRing";
}

TEST(Surface, LeafBudgetIsKeptByCoarserLeaves) {
  PatchNetwork network;
  network.model = testing::RandomBspline(3);
  const auto s = BuildSurface(network, {.leaf_thickness = 1e-5, .max_leaves = 500}, RunContext(2));
  ASSERT_TRUE(s.ok()) << s.status();
  EXPECT_LE(s->leaves.size(), 500u);
  EXPECT_GE(s->leaves.size(), s->pieces.size());
  const auto fewest = BuildSurface(network, {.leaf_thickness = 1e-5, .max_leaves = 1}, RunContext(2));
  ASSERT_TRUE(fewest.ok());
  EXPECT_EQ(fewest->leaves.size(), fewest->pieces.size());
}

TEST(Surface, HugeAndTinyModelsEnd) {
  for (const double scale : {1e-6, 1e6}) {
    PatchNetwork network;
    network.model = testing::Transformed(testing::RandomBspline(4), Eigen::Affine3d(Eigen::Scaling(scale)));
    const auto s = BuildSurface(network, {.max_leaves = 20'000}, RunContext(2));
    ASSERT_TRUE(s.ok());
    EXPECT_LE(s->leaves.size(), 20'000u);
    EXPECT_GE(s->leaves.size(), scale > 1.0 ? 2'000u : s->pieces.size());
  }
}

TEST(Surface, BadParametersAreNamed) {
  PatchNetwork network;
  const auto empty = BuildSurface(network, {}, RunContext(1));
  EXPECT_EQ(empty.status().code(), absl::StatusCode::kInvalidArgument);
  network.model = testing::Plane(1.0);
  for (const double bad : {0.0, -1.0, std::nan("")}) {
    const auto s = BuildSurface(network, {.leaf_thickness = bad}, RunContext(1));
    EXPECT_EQ(s.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(s.status().message()), HasSubstr("leaf_thickness"));
  }
  for (const int bad : {-1, 21}) {
    const auto s = BuildSurface(network, {.max_depth = bad}, RunContext(1));
    EXPECT_THAT(std::string(s.status().message()), HasSubstr("max_depth"));
  }
}

TEST(Surface, CancelIsObeyedWithin200ms) {
  PatchNetwork network;
  network.model = testing::Bumpy();
  RunContext run(2);
  std::chrono::steady_clock::time_point cancelled;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    cancelled = std::chrono::steady_clock::now();
    run.Cancel();
  });
  const auto s = BuildSurface(network, {.leaf_thickness = 1e-4, .max_leaves = 20'000'000}, run);
  const auto end = std::chrono::steady_clock::now();
  canceller.join();
  EXPECT_EQ(s.status().code(), absl::StatusCode::kCancelled);
  EXPECT_LT(std::chrono::duration<double>(end - cancelled).count(), testing::kSanitized ? 3.0 : 0.2);
}

TEST(Surface, AHundredThousandPatches) {
  PatchNetwork network;
  const testing::HeightFunction f = testing::BumpyHeight;
  const double step = 0.3;
  for (int i = 0; i < 320; ++i) {
    for (int j = 0; j < 320; ++j) {
      BezierPatch patch{3, 3, {}, {}};
      for (int k = 0; k < 16; ++k) {
        const double x = step * (i + (k / 4) / 3.0), y = step * (j + (k % 4) / 3.0);
        patch.points.emplace_back(x, y, f(x, y));
      }
      network.model.patches.push_back({"", patch});
    }
  }
  [[maybe_unused]] const double before = testing::PeakMemory();
  const double start = testing::ClockSeconds(CLOCK_PROCESS_CPUTIME_ID);
  const auto s = BuildSurface(std::move(network), {}, RunContext(2));
  const double seconds = testing::ClockSeconds(CLOCK_PROCESS_CPUTIME_ID) - start;
  ASSERT_TRUE(s.ok());
  EXPECT_GE(s->leaves.size(), 320u * 320u);
  EXPECT_LT(seconds, testing::kSanitized ? 200.0 : 10.0);  // of all threads; 0.8 s
#if !defined(__SANITIZE_THREAD__)                          // which keeps several shadows of all memory
  EXPECT_LT(testing::PeakMemory() - before, 500.0);
#endif
}

}  // namespace
}  // namespace patchmill
