// h against a drop cutter on triangles (CGAL): 2 microns over whole parts, 0.2 microns in windows of 5 x 5
// mm.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "cam/location/simd/heights.h"
#include "tests/support/files.h"
#include "tests/support/fuzz.h"
#include "tests/support/mesh/mesh_oracle.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using testing::MeshOracle;
using testing::MeshParams;
using testing::Random;
using testing::SurfaceOf;

struct Area {
  Vec2 min, max;
};

// All of it by the sandwich of mesh_oracle.h; what it leaves open by the width of the sandwich.
class Judge {
 public:
  Judge(const PatchModel& model, double radius, double error, std::optional<Area> window)
      : surface_(SurfaceOf(model)),
        error_(error),
        radius_(radius),
        smaller_(surface_, radius - error),
        exact_(surface_, radius),
        larger_(surface_, radius + error),
        mesh_(model, ParamsFor(radius, error, window)),
        area_(window.value_or(Area{Xy(surface_.box.min) - Vec2::Constant(0.9 * radius),
                                   Xy(surface_.box.max) + Vec2::Constant(0.9 * radius)})) {}

  void Compare(int queries, std::uint64_t seed) {
    Random random(seed);
    const double within = 0.1 * error_;
    int touched = 0, close = 0;
    for (int k = 0; k < queries; ++k) {
      const Vec2 q(random.Uniform(area_.min.x(), area_.max.x()),
                   random.Uniform(area_.min.y(), area_.max.y()));
      const auto low = smaller_.Height(q), h = exact_.Height(q), high = larger_.Height(q);
      const auto mesh = mesh_.Height(q, radius_, within);
      const auto where = [&] {
        return ::testing::Message() << "seed " << seed << " query " << k << " at " << q.transpose();
      };
      ASSERT_TRUE(!low || (mesh && h)) << where();
      ASSERT_TRUE(high || !mesh || mesh->low == -kInfinity) << where();
      if (!mesh || !low || !high || mesh->low == -kInfinity) continue;
      ++touched;
      EXPECT_LE(low->z, mesh->high + kRounding) << where();
      EXPECT_GE(high->z, mesh->low - kRounding) << where();
      EXPECT_LE(std::max(mesh->low - h->z, h->z - mesh->high), high->z - low->z + kRounding) << where();
      close += std::max(mesh->high - h->z, h->z - mesh->low) <= 5.0 * error_;
    }
    // Apart from contacts near the equator triangles come as near as they are fine.
    EXPECT_GT(touched, queries / 3);
    EXPECT_GE(close, 0.8 * touched) << "of " << touched << ", " << mesh_.triangle_count() << " triangles";
  }

 private:
  static constexpr double kRounding = 1e-7;  // mm; a forced step of the falling ball near its equator
  static MeshParams ParamsFor(double radius, double error, const std::optional<Area>& window) {
    MeshParams params;
    params.error = error;
    params.reach = radius;
    if (window) params.window = {window->min, window->max};
    return params;
  }

  Surface surface_;
  double error_, radius_;
  Locator smaller_, exact_, larger_;
  MeshOracle mesh_;
  Area area_;
};

PatchModel Placed(const std::string& file, double scale, UpAxis up) {
  Placement placement;
  placement.scale = scale;
  placement.up = up;
  return Place(placement, testing::LoadModel(file));
}

void CompareWhole(const PatchModel& model, double radius) {
  Judge(model, radius, 0.002, std::nullopt).Compare(1500, 1);
}

constexpr double kFine = 0.0002;  // mm: 0.2 microns

Area WindowAt(const Vec2& middle) { return {middle - Vec2::Constant(2.5), middle + Vec2::Constant(2.5)}; }

// Windows about random places of the part.
void CompareWindows(const PatchModel& model, double radius, int windows) {
  const Surface surface = SurfaceOf(model);
  Random random(7);
  for (int k = 0; k < windows; ++k) {
    const Vec2 middle(random.Uniform(surface.box.min.x(), surface.box.max.x()),
                      random.Uniform(surface.box.min.y(), surface.box.max.y()));
    Judge(model, radius, kFine, WindowAt(middle)).Compare(500, 100 + k);
  }
}

// A place worth a window, in the plan of the file's own units.
struct Place2 {
  const char* what;
  Vec2 at;
};

void CompareAt(const PatchModel& model, double scale, double radius, std::initializer_list<Place2> places) {
  std::uint64_t seed = 200;
  for (const Place2& place : places) {
    if (seed % 2 != 0 && !testing::LongTests()) {
      ++seed;
      continue;
    }
    SCOPED_TRACE(place.what);
    Judge(model, radius, kFine, WindowAt(scale * place.at)).Compare(500, seed++);
  }
}

TEST(MeshHeight, TwoHills) { CompareWhole(testing::TwoHills(), 3.0); }
TEST(MeshHeight, TwoHillsInWindows) { CompareWindows(testing::TwoHills(), 3.0, 3); }
// A quarter of its length and width: all of it would be four million triangles.
TEST(MeshHeight, Bumpy) {
  Judge(testing::Bumpy(), 3.0, 0.002, Area{Vec2(30, 40), Vec2(55, 65)}).Compare(1500, 1);
}
TEST(MeshHeight, BumpyInWindows) { CompareWindows(testing::Bumpy(), 3.0, 1); }
TEST(MeshHeight, Teapot) { CompareWhole(Placed("examples/teapot.bpt", 20.0, UpAxis::kY), 3.0); }
TEST(MeshHeight, TeapotLying) { CompareWhole(Placed("examples/teapot.bpt", 20.0, UpAxis::kZ), 1.5); }
TEST(MeshHeight, GregoryPatches) {
  CompareWhole(Placed("tests/models/toroidal_tet.patches", 25.0, UpAxis::kY), 3.0);
}
TEST(MeshHeight, Teacup) { CompareWhole(Placed("tests/models/teacup.bpt", 15.0, UpAxis::kY), 2.0); }
TEST(MeshHeight, TeapotInWindows) {
  CompareAt(Placed("examples/teapot.bpt", 30.0, UpAxis::kY), 30.0, 2.0,
            {{"handle where it leaves the body", {-0.46, 0.0}},
             {"bend of the handle", {-0.83, 0.06}},
             {"spout where it leaves the body", {0.58, 0.08}},
             {"open mouth of the spout", {0.92, 0.0}},
             {"gap between lid and rim", {0.28, 0.28}},
             {"knob with its singular top", {0.0, 0.0}}});
}
TEST(MeshHeight, TeacupInWindows) {
  CompareAt(Placed("tests/models/teacup.bpt", 25.0, UpAxis::kY), 25.0, 1.5,
            {{"handle where it leaves the rim", {-0.45, 0.0}},
             {"bend of the handle", {-0.85, 0.03}},
             {"rim", {0.3, 0.3}},
             {"open bottom inside", {0.2, 0.19}},
             {"edge of the saucer", {0.69, 0.69}}});
}
// Gregory patches and what they join, where four and six of them meet, and in the hollow below.
TEST(MeshHeight, GregoryPatchesInWindows) {
  CompareAt(Placed("tests/models/toroidal_tet.patches", 25.0, UpAxis::kY), 25.0, 2.0,
            {{"four on the top", {0.0, 0.0}},
             {"six on the upper corner", {-0.5636, 0.5636}},
             {"beside an arm", {0.1705, -0.5608}},
             {"six in the hollow", {0.2727, 0.2727}}});
}
TEST(MeshHeight, FoldedSplines) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    if (seed == 2 && !testing::LongTests()) continue;
    testing::RandomBsplineParams params;
    params.folds = true;
    params.rational = seed % 2 == 1;
    Judge(testing::RandomBspline(seed, params), 2.5, 0.002, std::nullopt).Compare(500, seed);
  }
}

}  // namespace
}  // namespace patchmill
