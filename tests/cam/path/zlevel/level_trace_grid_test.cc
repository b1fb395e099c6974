// The sign of h - c on a 0.05 mm grid against the inside and outside of the contours, 20 levels a part.
//
// h is computed once a node, in lanes, and serves all levels. Every node of the grid is asked, under
// sanitizers one row in twenty.
#include <algorithm>
#include <utility>

#include <gtest/gtest.h>

#include "cam/location/simd/heights.h"
#include "cam/path/zlevel/level_trace.h"
#include "core/base/parallel.h"
#include "tests/cam/path/zlevel/level_checks.h"
#include "tests/support/files.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::MakeSurface;

constexpr double kR = 3.0;
constexpr double kStep = 0.05;
constexpr double kRowStep = testing::kSanitized ? 20.0 * kStep : kStep;
constexpr int kLevels = 20;

// Scaled so that its larger side in plan measures `size`, its own y axis up.
PatchModel Placed(const std::string& path, double size) {
  PatchModel model = testing::LoadModel(path);
  const Box3 box = ControlBox(model);
  const double side = std::max(box.max.x() - box.min.x(), box.max.z() - box.min.z());
  Eigen::Affine3d motion = Eigen::Affine3d::Identity();
  motion.linear() = (size / side) * Eigen::AngleAxisd(kPi / 2.0, Vec3::UnitX()).toRotationMatrix();
  return testing::Transformed(std::move(model), motion);
}

struct Grid {
  double x0 = 0.0, y0 = 0.0;
  std::size_t columns = 0, rows = 0;
  double Y(std::size_t row) const { return y0 + static_cast<double>(row) * kRowStep; }
  double X(std::size_t column) const { return x0 + static_cast<double>(column) * kStep; }
};

Grid Over(const Box3& box) {
  Grid grid;
  // Odd parts of a step: no row or column runs along a symmetry plane of the part.
  grid.x0 = box.min.x() - kR - 0.37 * kStep;
  grid.y0 = box.min.y() - kR - 0.31 * kStep;
  grid.columns = static_cast<std::size_t>((box.max.x() + kR - grid.x0) / kStep) + 2;
  grid.rows = static_cast<std::size_t>((box.max.y() + kR - grid.y0) / kRowStep) + 2;
  return grid;
}

// Where the loops of a level cross one row, and by how much the winding number grows there.
struct RowCrossing {
  double x;
  int turn;
  bool operator<(const RowCrossing& o) const { return x < o.x; }
};
using RowCrossings = std::vector<RowCrossing>;

std::vector<RowCrossings> CrossRows(const LevelContours& level, const Grid& grid) {
  std::vector<RowCrossings> rows(grid.rows);
  for (const CutterPath& loop : level.loops) {
    for (std::size_t i = 0; i < loop.points.size(); ++i) {
      const Vec3& a = loop.points[i].center;
      const Vec3& b = loop.points[(i + 1) % loop.points.size()].center;
      const double lo = std::min(a.y(), b.y()), hi = std::max(a.y(), b.y());
      auto row = static_cast<std::size_t>(std::max(0.0, std::floor((lo - grid.y0) / kRowStep)));
      for (; row < grid.rows && grid.Y(row) < hi; ++row) {
        const double y = grid.Y(row);
        if (y < lo) continue;
        rows[row].push_back(
            {a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()), b.y() > a.y() ? -1 : 1});
      }
    }
  }
  for (RowCrossings& row : rows) std::sort(row.begin(), row.end());
  return rows;
}

// Pairs of chords of a level that cross each other.
int CrossingChords(const LevelContours& level, Vec3* first) {
  struct Chord {
    Vec2 a, b;
    std::size_t loop, index, count;
    double lo, hi;
  };
  std::vector<Chord> chords;
  for (std::size_t l = 0; l < level.loops.size(); ++l) {
    const auto& points = level.loops[l].points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec2 a = Xy(points[i].center), b = Xy(points[(i + 1) % points.size()].center);
      chords.push_back({a, b, l, i, points.size(), std::min(a.y(), b.y()), std::max(a.y(), b.y())});
    }
  }
  std::sort(chords.begin(), chords.end(), [](const Chord& c, const Chord& d) { return c.lo < d.lo; });
  int crossing = 0;
  std::vector<const Chord*> open;
  for (const Chord& c : chords) {
    std::erase_if(open, [&](const Chord* d) { return d->hi < c.lo; });
    for (const Chord* d : open) {
      const std::size_t apart = c.index > d->index ? c.index - d->index : d->index - c.index;
      if (c.loop == d->loop && (apart <= 1 || apart == c.count - 1)) continue;  // they share an end
      const Vec2 along = c.b - c.a, other = d->b - d->a;
      if (Cross(along, d->a - c.a) * Cross(along, d->b - c.a) < 0.0 &&
          Cross(other, c.a - d->a) * Cross(other, c.b - d->a) < 0.0) {
        if (crossing++ == 0) *first = Lift(0.5 * (c.a + c.b), level.z);
      }
    }
    open.push_back(&c);
  }
  return crossing;
}

// What a node that says the opposite of the loops is excused by: the tolerance of the chords, normal to the
// surface. These parts have no holes below the resolution, which loops might pass over.
class Judge {
 public:
  Judge(const Surface& surface, const ContourParams& params)
      : smaller_(surface, kR - 1.001 * params.pass.chord_tolerance),
        larger_(surface, kR + 1.001 * params.pass.chord_tolerance) {}

  // Outside of the loops though h > c.
  bool MayCount(const Vec3& forbidden) const { return smaller_.Free(forbidden); }
  // Inside of the loops though h <= c.
  bool MayBlock(const Vec3& free) const { return !larger_.Free(free); }

 private:
  Locator smaller_, larger_;
};

struct Count {
  std::int64_t nodes = 0, excused = 0;
  int gouges = 0, blocked = 0, turns = 0;
  Vec3 first = Vec3::Zero();
};

class Check {
 public:
  explicit Check(PatchModel model)
      : surface_(MakeSurface(std::move(model))),
        locator_(surface_, kR),
        judge_(surface_, params_),
        grid_(Over(surface_.box)) {}

  void Run() {
    Trace();
    std::vector<Count> counts(grid_.rows);
    ASSERT_TRUE(ParallelFor(run_, nullptr, grid_.rows, [&](std::size_t r) { counts[r] = Row(r); }).ok());
    Count all;
    for (const Count& count : counts) {
      const bool first = all.gouges + all.blocked + all.turns == 0;
      if (first) all.first = count.first;
      all.nodes += count.nodes;
      all.excused += count.excused;
      all.gouges += count.gouges;
      all.blocked += count.blocked;
      all.turns += count.turns;
    }
    EXPECT_GT(all.nodes, 500000);
    // Chords leave the contour by the tolerance at most: no more nodes are excused by it than lie in a band
    // half as wide along one side of the loops.
    const double in_band = 0.5 * Length() * params_.pass.chord_tolerance / (kStep * kRowStep);
    EXPECT_LE(static_cast<double>(all.excused), in_band);
    EXPECT_EQ(all.gouges, 0) << "outside of the loops but forbidden, the first at " << all.first.transpose();
    EXPECT_EQ(all.blocked, 0) << "inside of the loops but free, the first at " << all.first.transpose();
    EXPECT_EQ(all.turns, 0) << "loops do not nest, the first at " << all.first.transpose();
    ::testing::Test::RecordProperty("nodes", std::to_string(all.nodes));
    ::testing::Test::RecordProperty("excused", std::to_string(all.excused));
  }

 private:
  void Trace() {
    const LevelContext context(locator_, run_);
    levels_.resize(kLevels);
    const double bottom = surface_.box.min.z() + kR, height = surface_.box.max.z() - surface_.box.min.z();
    ASSERT_TRUE(ParallelFor(run_, nullptr, levels_.size(), [&](std::size_t k) {
                  const double share = (static_cast<double>(k) + 0.37) / kLevels;
                  levels_[k] = TraceLevel(context, bottom + share * height, params_, run_);
                }).ok());
    for (const LevelContours& level : levels_) {
      for (const CutterPath& loop : level.loops) {
        EXPECT_TRUE(loop.closed);
        EXPECT_GE(loop.points.size(), 3u);
      }
      Vec3 first = Vec3::Zero();
      EXPECT_EQ(CrossingChords(level, &first), 0) << "the first at " << first.transpose();
      rims_.push_back(CrossRows(level, grid_));
    }
  }

  double Length() const {
    double sum = 0.0;
    for (const LevelContours& level : levels_) {
      for (const CutterPath& loop : level.loops) {
        for (std::size_t i = 0; i < loop.points.size(); ++i)
          sum += (loop.points[(i + 1) % loop.points.size()].center - loop.points[i].center).norm();
      }
    }
    return sum;
  }

  Count Row(std::size_t r) const {
    std::vector<Vec2> q(grid_.columns);
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = Vec2(grid_.X(i), grid_.Y(r));
    std::vector<std::optional<CenterPoint>> h(q.size());
    Heights(locator_, q, h);
    Count count;
    for (std::size_t k = 0; k < levels_.size(); ++k) {
      const double z = levels_[k].z;
      const RowCrossings& rim = rims_[k][r];
      std::size_t next = 0;
      int winding = 0;
      for (std::size_t i = 0; i < q.size(); ++i) {
        for (; next < rim.size() && rim[next].x <= q[i].x(); ++next) winding += rim[next].turn;
        const bool forbidden = h[i] && h[i]->z > z;
        ++count.nodes;
        if (winding == (forbidden ? -1 : 0)) continue;
        const Vec3 c = Lift(q[i], z);
        if (winding == 0 || winding == -1) {
          if (forbidden ? judge_.MayCount(c) : judge_.MayBlock(c)) {
            ++count.excused;
            continue;
          }
          ++(forbidden ? count.gouges : count.blocked);
        } else {
          ++count.turns;
        }
        if (count.first == Vec3::Zero()) count.first = c;
      }
      count.turns += winding != 0 || next < rim.size();
    }
    return count;
  }

  Surface surface_;
  Locator locator_;
  ContourParams params_;
  Judge judge_;
  Grid grid_;
  RunContext run_;
  std::vector<LevelContours> levels_;
  std::vector<std::vector<RowCrossings>> rims_;  // by level, by row
};

TEST(ContourGrid, Bumpy) { Check(testing::Bumpy()).Run(); }
TEST(ContourGrid, Teapot) { Check(Placed("examples/teapot.bpt", 160.0)).Run(); }
TEST(ContourGrid, Teacup) { Check(Placed("tests/models/teacup.bpt", 100.0)).Run(); }
TEST(ContourGrid, Torus) { Check(Placed("tests/models/torus_bicubic.patches", 100.0)).Run(); }

}  // namespace
}  // namespace patchmill
