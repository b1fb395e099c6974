// Contours as passes: where levels lie, what is clipped, and that nothing steep is left over.
#include "cam/path/contour/contour_paths.h"

#include <array>
#include <chrono>
#include <map>

#include <gtest/gtest.h>

#include "core/diffgeo/forms.h"
#include "tests/cam/path/zlevel/level_checks.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::MakeSurface;

constexpr double kR = 3.0;
constexpr double kSteep = Radians(45.0);

struct Job {
  explicit Job(PatchModel model) : surface(MakeSurface(std::move(model))), locator(surface, kR) {
    params.pass.window.min = kSteep;
  }
  std::vector<CutterPath> Paths(int threads = 2) const {
    const RunContext run(threads);
    const auto result = ContourPaths(locator, params, run);
    if (!result.ok()) {
      ADD_FAILURE() << result.status();
      return {};
    }
    Check(result->paths);
    return result->paths;
  }
  // What holds for every job: contours are free and level, ordered from the top of each group of levels, and
  // above the floor. Their contacts are in the window or within half a step of it.
  void Check(const std::vector<CutterPath>& paths) const {
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const CutterPath& path = paths[i];
      ASSERT_GE(path.points.size(), 2u);
      EXPECT_EQ(path.kind, PassKind::kContour);
      const double z = path.points.front().center.z();
      EXPECT_GE(z, params.pass.floor_z + kR - 1e-9);
      if (i > 0) {
        EXPECT_LE(paths[i - 1].order_key, path.order_key);
        const double before = paths[i - 1].points.front().center.z();
        // In one group of levels only a few may be without a pass. Beyond them another group begins.
        const int farther = path.order_key - paths[i - 1].order_key;
        EXPECT_TRUE(farther == 0 ? before == z : before > z || farther > 4);
      }
      for (const CutterPoint& p : path.points) {
        EXPECT_EQ(p.center.z(), z);
        EXPECT_TRUE(locator.Free(p.center, 2e-9)) << p.center.transpose();
        ASSERT_TRUE(p.contact.has_value());
      }
    }
  }
  ContourParams params;
  Surface surface;
  Locator locator;
};

// Distance from surface points to the passes, by brute force over a grid of segments.
class Leftover {
 public:
  explicit Leftover(const std::vector<CutterPath>& paths) {
    for (const CutterPath& path : paths) {
      const std::size_t n = path.points.size();
      for (std::size_t i = 0; i + (path.closed ? 0 : 1) < n; ++i) {
        const Vec3 a = path.points[i].center, b = path.points[(i + 1) % n].center;
        grid_[Cell(0.5 * (a + b))].push_back({a, b});
      }
    }
  }
  // For a ball resting on p with its centre at c.
  double At(const Vec3& p, const Vec3& c) const {
    double best = 1.0;
    const auto cell = Cell(c);
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        for (int k = -1; k <= 1; ++k) {
          const auto found = grid_.find({cell[0] + i, cell[1] + j, cell[2] + k});
          if (found == grid_.end()) continue;
          for (const auto& [a, b] : found->second) {
            const Vec3 d = b - a;
            const double t =
                d.squaredNorm() > 0.0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
            best = std::min(best, (p - a - t * d).norm() - kR);
          }
        }
      }
    }
    return best;
  }

 private:
  static std::array<int, 3> Cell(const Vec3& p) {
    return {static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())),
            static_cast<int>(std::floor(p.z()))};
  }
  std::map<std::array<int, 3>, std::vector<std::pair<Vec3, Vec3>>> grid_;
};

struct Coverage {
  int points = 0, above = 0;
  double worst = -kInfinity;
};
// Steep reachable points of an n x n grid on every piece whose leftover exceeds `limit`.
Coverage Cover(const Job& job, const std::vector<CutterPath>& paths, int n, double limit) {
  const Leftover leftover(paths);
  Coverage cover;
  for (std::size_t i = 0; i < job.surface.pieces.size(); ++i) {
    for (int k = 0; k < n * n; ++k) {
      const SurfaceJet jet = Evaluate(job.surface, PieceId(i), (k / n + 0.5) / n, (k % n + 0.5) / n);
      const auto normal = UpwardNormal(jet);
      if (!normal || std::acos(normal->z()) < job.params.pass.window.min) continue;
      const Vec3 c = jet.p + kR * *normal;
      if (c.z() < job.params.pass.floor_z + kR || !job.locator.Free(c, 1e-9)) continue;
      const double e = leftover.At(jet.p, c);
      ++cover.points;
      cover.above += e > limit;
      cover.worst = std::max(cover.worst, e);
    }
  }
  return cover;
}

double Slope(const CutterPoint& p) {
  return std::acos(std::clamp((p.center.z() - p.contact->p.z()) / kR, 0.0, 1.0));
}

double Bottom(const std::vector<CutterPath>& paths) { return paths.back().points.front().center.z(); }

PatchModel DomeOnAPlane() {
  return testing::Join({testing::Sphere(Vec3::Zero(), 10.0, testing::Half::kUpper), testing::Plane(25.0)});
}

TEST(ContourPaths, DomeOnAPlane) {
  Job job(DomeOnAPlane());
  job.params.pass.floor_z = 0.0;
  const std::vector<CutterPath> paths = job.Paths();
  ASSERT_FALSE(paths.empty());
  for (const CutterPath& path : paths) {
    EXPECT_TRUE(path.closed);
    EXPECT_LT(testing::SignedArea(path), 0.0);  // climb: material on the right
    const double z = path.points.front().center.z();
    for (const CutterPoint& p : path.points) EXPECT_NEAR(Xy(p.center).norm(), std::sqrt(169.0 - z * z), 1e-6);
  }
  // The lowest one touches plane and dome.
  EXPECT_GE(Bottom(paths), 3.0);
  EXPECT_LE(Bottom(paths), 3.00001);
  const Coverage cover = Cover(job, paths, 40, job.params.pass.scallop + 0.0075);
  EXPECT_GT(cover.points, 500);
  EXPECT_EQ(cover.above, 0) << cover.worst;
}

TEST(ContourPaths, VerticalWallsDownToTheFloor) {
  Job job(testing::Block(8.0, 5.0, 20.0));
  job.params.pass.floor_z = 0.0;
  const std::vector<CutterPath> paths = job.Paths();
  ASSERT_FALSE(paths.empty());
  for (const CutterPath& path : paths) EXPECT_TRUE(path.closed);
  EXPECT_GE(Bottom(paths), 3.0);
  EXPECT_LE(Bottom(paths), 3.00001);
  const Coverage cover = Cover(job, paths, 40, job.params.pass.scallop + 0.0075);
  EXPECT_GT(cover.points, 500);
  EXPECT_EQ(cover.above, 0) << cover.worst;
}

// A sheet at 60 degrees: passes on its upper side only, from border to border, not around the borders.
TEST(ContourPaths, PassesStopAtTheBordersOfASheet) {
  const double slope = std::tan(Radians(60.0)), a = 10.0;
  const Job job(testing::Plane(a, 0.0, slope, 0.0));
  const std::vector<CutterPath> paths = job.Paths();
  ASSERT_GT(paths.size(), 20u);
  for (const CutterPath& path : paths) {
    EXPECT_FALSE(path.closed);
    double lo = kInfinity, hi = -kInfinity;
    for (const CutterPoint& p : path.points) {
      lo = std::min(lo, p.center.y());
      hi = std::max(hi, p.center.y());
      EXPECT_NEAR(p.center.z(), slope * p.center.x() + kR * std::hypot(1.0, slope), 1e-6);
    }
    EXPECT_NEAR(lo, -a, 1e-4);
    EXPECT_NEAR(hi, a, 1e-4);
    // Material on the right: uphill is +x, so the motion runs towards +y.
    EXPECT_LT(path.points.front().center.y(), path.points.back().center.y());
  }
  const Coverage cover = Cover(job, paths, 40, job.params.pass.scallop + 0.0075);
  EXPECT_EQ(cover.above, 0) << cover.worst;
  EXPECT_EQ(cover.points, 1600);
}

TEST(ContourPaths, BothSidesOfAVerticalSheet) {
  const Job job(testing::Single(testing::Bilinear({0, -10, 0}, {0, 10, 0}, {0, -10, 8}, {0, 10, 8})));
  const std::vector<CutterPath> paths = job.Paths();
  bool left = false, right = false;
  for (const CutterPath& path : paths) {
    for (const CutterPoint& p : path.points) {
      left |= p.center.x() < -kR + 1e-6;
      right |= p.center.x() > kR - 1e-6;
    }
  }
  EXPECT_TRUE(left && right);
}

// Slopes outside the window only within half a step of it.
TEST(ContourPaths, ClippedToTheWindow) {
  const Job job(testing::RandomBspline(11));
  const std::vector<CutterPath> paths = job.Paths();
  ASSERT_FALSE(paths.empty());
  for (const CutterPath& path : paths) {
    if (path.closed) continue;
    double length = 0.0;  // since the last contact inside
    for (const CutterPoint& p : path.points) length = Slope(p) >= kSteep - 1e-6 ? -1.0 : length;
    EXPECT_LT(length, 0.0) << "a pass that never enters the window";
  }
  const Coverage cover = Cover(job, paths, 12, job.params.pass.scallop + 0.0075);
  EXPECT_GT(cover.points, 100);
  EXPECT_LE(cover.above, cover.points / 200) << cover.worst;  // creases are the rest passes' work
}

TEST(ContourPaths, TorusInsideAndOutside) {
  const Job job(testing::Torus(Vec3::Zero(), 20.0, 6.0));
  const std::vector<CutterPath> paths = job.Paths();
  const Coverage cover = Cover(job, paths, 20, job.params.pass.scallop + 0.0075);
  EXPECT_GT(cover.points, 500);
  EXPECT_EQ(cover.above, 0) << cover.worst;
}

// A ball beside an upright round wall touches it along a line. Nothing but a proof in plan ends there:
// contours took milliseconds a point, and those that could not be proven were lifted onto the wall.
TEST(ContourPaths, UprightRoundWallsAreNoWorkAndNothingIsLifted) {
  Eigen::Affine3d up = Eigen::Affine3d::Identity();
  up.translate(Vec3(1.0, 2.0, 5.0)).rotate(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()));
  const PatchModel tube = testing::Transformed(testing::Cylinder(Vec3::Zero(), 9.0, 5.0), up);
  Job job(testing::Join({testing::Plane(25), tube}));
  job.params.pass = WithFineChords(job.params.pass);
  const auto start = std::chrono::steady_clock::now();
  const std::vector<CutterPath> paths = job.Paths();
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  std::size_t points = 0;
  for (const CutterPath& path : paths) points += path.points.size();
  EXPECT_GT(points, 1000u);
  EXPECT_EQ(job.locator.defect_count(), 0u);
  EXPECT_LT(time.count(), 1e-3 * static_cast<double>(points) * (testing::kSanitized ? 20.0 : 1.0));
}

TEST(ContourPaths, ForcedContoursKeepWholeLoops) {
  Job job(testing::Torus(Vec3::Zero(), 20.0, 6.0, testing::Half::kUpper));
  job.params.pass.window.min = 0.0;
  for (const CutterPath& path : job.Paths()) EXPECT_TRUE(path.closed);
}

TEST(ContourPaths, FloorHoldsTheTip) {
  Job job(testing::Sphere(Vec3::Zero(), 10.0));
  job.params.pass.floor_z = 1.5;
  const std::vector<CutterPath> paths = job.Paths();
  ASSERT_FALSE(paths.empty());
  EXPECT_NEAR(Bottom(paths), 4.5, 1e-5);  // exactly at the floor
}

TEST(ContourPaths, NothingSteepNothingToDo) {
  EXPECT_TRUE(Job(testing::Plane(20.0, 0.0, 0.3, 0.0)).Paths().empty());
}

TEST(ContourPaths, SameForAnyNumberOfThreads) {
  const Job job(testing::RandomBspline(3));
  const std::vector<CutterPath> one = job.Paths(1), four = job.Paths(4);
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].points.size(), four[i].points.size());
    for (std::size_t k = 0; k < one[i].points.size(); ++k)
      EXPECT_EQ(one[i].points[k].center, four[i].points[k].center);
  }
}

TEST(ContourPaths, CancelIsObeyed) {
  const Job job(testing::RandomBspline(3));
  RunContext run(2);
  run.Cancel();
  EXPECT_EQ(ContourPaths(job.locator, job.params, run).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
