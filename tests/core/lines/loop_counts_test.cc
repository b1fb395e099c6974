// How many lines of each kind the torus and the teapot have: the tracer against a dense grid of signs, which
// knows the fields from [lines, section 1] alone, and uses nothing of core/lines.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/lines/line_fields.h"
#include "core/lines/zero_curves.h"
#include "tests/core/lines/sign_grid.h"
#include "tests/support/files.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

// --- The fields, as [lines, section 1] writes them; only their signs count ---

Vec3 Normal(const SurfaceJet& s) { return s.du.cross(s.dv); }

Sign Contour(const Vec3& f, double level) {
  return [=](const SurfaceJet& s) { return f.dot(s.p) - level; };
}
Sign EquiSlope(const Vec3& f, double angle) {
  return [=](const SurfaceJet& s) { return std::abs(f.dot(Normal(s))) - std::cos(angle) * Normal(s).norm(); };
}
Sign Brightness(const Vec3& f, double b) {
  return [=](const SurfaceJet& s) { return f.dot(Normal(s)) - b * Normal(s).norm(); };
}
Sign Silhouette(const Vec3& f) {
  return [=](const SurfaceJet& s) { return f.dot(Normal(s)); };
}
Sign Eye(const Vec3& eye) {
  return [=](const SurfaceJet& s) { return (s.p - eye).dot(Normal(s)); };
}
// [lines (8)]: chi = n_s . S.
Sign Highlight(const Vec3& f, const Vec3& n_s) {
  return [=](const SurfaceJet& s) { return n_s.dot(s.du) * f.dot(s.dv) - n_s.dot(s.dv) * f.dot(s.du); };
}
// L du^2 + 2 M du dv + N dv^2 along [lines (2)].
Sign Inflection(const Vec3& f) {
  return [=](const SurfaceJet& s) {
    const Vec3 n = Normal(s);
    const double a = -f.dot(s.dv), b = f.dot(s.du);
    return n.dot(s.duu) * a * a + 2 * n.dot(s.duv) * a * b + n.dot(s.dvv) * b * b;
  };
}
// [lines (10)].
Sign SlopeExtremum(const Vec3& f) {
  return [=](const SurfaceJet& s) {
    const Vec3 n = Normal(s);
    const double E = s.du.dot(s.du), F = s.du.dot(s.dv), G = s.dv.dot(s.dv);
    const double L = n.dot(s.duu), M = n.dot(s.duv), N = n.dot(s.dvv);
    const double a = f.dot(s.du), b = f.dot(s.dv);
    return (M * G - N * F) * a * a - (G * L - N * E) * a * b + (L * F - M * E) * b * b;
  };
}

struct Kind {
  std::string name;
  ZeroField traced;
  Sign sign;
  Nodes nodes = Nodes::kNone;
};

Counts CountTraced(const std::vector<ZeroCurve>& curves, double weld) {
  Sets sets;
  for (const ZeroCurve& curve : curves) {
    Box3 box;
    for (const SurfacePoint& p : curve.points) box.Add(p.p);
    const int id = sets.Add(box);
    if (curve.closed) continue;
    sets.AddEnd(id, curve.points.front().p);
    sets.AddEnd(id, curve.points.back().p);
  }
  return sets.Count(weld);
}

// All kinds, for the axis f with some levels; `across` is square to f. `low` and `high`: the part's extent
// along f.
std::vector<Kind> Kinds(const Vec3& f, const Vec3& across, double low, double high) {
  std::vector<Kind> kinds;
  for (const double share : {0.07, 0.23, 0.41, 0.59, 0.83, 0.97}) {
    const double level = low + share * (high - low);
    kinds.push_back({"contour " + std::to_string(share), ContourField(level, f), Contour(f, level)});
  }
  for (const double angle : {13.0, 41.0, 77.0})
    kinds.push_back(
        {"slope " + std::to_string(angle), SlopeField(Radians(angle), f), EquiSlope(f, Radians(angle))});
  for (const double b : {-0.71, -0.13, 0.37, 0.91})
    kinds.push_back({"brightness " + std::to_string(b), BrightnessField(b, f), Brightness(f, b)});
  kinds.push_back({"silhouette", SilhouetteField(f), Silhouette(f)});
  const Vec3 eye = 2.5 * high * f + 0.4 * high * across;
  kinds.push_back({"eye", EyeSilhouetteField(eye), Eye(eye)});
  for (const double turn : {0.3, 1.1, 2.3}) {
    const Vec3 n_s = Eigen::AngleAxisd(turn, f) * across;
    kinds.push_back({"highlight " + std::to_string(turn), HighlightField(f, n_s), Highlight(f, n_s)});
  }
  kinds.push_back({"inflection", ContourCurvatureField(f), Inflection(f), Nodes::kSaddles});
  kinds.push_back({"slope extremum", SlopeExtremumField(f), SlopeExtremum(f), Nodes::kFlat});
  return kinds;
}

// `symmetric`: without the kinds whose lines then run along borders of patches, where a grid inside them sees
// one sign only.
void ExpectCountsOfSignGrid(const PatchModel& model, const Vec3& axis, bool symmetric = false) {
  auto network = BuildNetwork(model);
  ASSERT_TRUE(network.ok()) << network.status();
  auto surface = BuildSurface(*std::move(network), SurfaceParams(), RunContext());
  ASSERT_TRUE(surface.ok()) << surface.status();
  const double weld = std::max(1e-5, 2 * surface->network.join_tolerance);
  double low = kInfinity, high = -kInfinity;
  for (const SurfaceLeaf& leaf : surface->leaves) {
    low = std::min(low, axis.dot(leaf.center()));
    high = std::max(high, axis.dot(leaf.center()));
  }
  const Vec3 f = axis.normalized();
  std::vector<Kind> kinds = Kinds(f, f.unitOrthogonal(), low, high);
  if (symmetric) {
    std::erase_if(kinds, [](const Kind& kind) {
      return kind.nodes != Nodes::kNone || kind.name == "silhouette" || kind.name.starts_with("highlight");
    });
  }
  std::vector<ZeroField> fields;
  std::vector<SignKind> seen;
  for (const Kind& kind : kinds) {
    fields.push_back(kind.traced);
    seen.push_back({kind.sign, kind.nodes});
  }
  // Until two grids agree.
  std::vector<Counts> counts, before;
  int cells = 50;
  do {
    before = std::exchange(counts, SignGrid(model, f, cells, weld).Count(seen));
    cells *= 2;
  } while (counts != before && cells <= 1600);
  EXPECT_EQ(counts, before) << "the grid does not settle";

  const auto traced = TraceZeroCurves(*surface, fields, ZeroMeshParams(), 0.01, RunContext());
  ASSERT_TRUE(traced.ok()) << traced.status();
  for (std::size_t k = 0; k < kinds.size(); ++k)
    EXPECT_EQ(CountTraced((*traced)[k], weld), counts[k]) << kinds[k].name;
}

const Vec3 kTilted(0.28, 0.36, 0.89);

TEST(LoopCounts, OfATorus) {
  ExpectCountsOfSignGrid(Torus(Vec3::Zero(), 20, 6), kTilted);
  ExpectCountsOfSignGrid(Torus(Vec3::Zero(), 20, 6), Vec3(0.8, 0.55, 0.2));
}

TEST(LoopCounts, OfATorusOfBicubicPatches) {
  ExpectCountsOfSignGrid(
      Transformed(LoadModel("tests/models/torus_bicubic.patches"), Eigen::Affine3d(Eigen::Scaling(20.0))),
      kTilted);
}

TEST(LoopCounts, OfAnEllipsoid) {
  Eigen::Affine3d stretch(Eigen::Scaling(30.0, 20.0, 10.0));
  stretch.rotate(Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()));  // borders off the planes of symmetry
  ExpectCountsOfSignGrid(Transformed(Sphere(Vec3::Zero(), 1), stretch), kTilted);
}

TEST(LoopCounts, OfTheTeapot) {
  Eigen::Affine3d up(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()));
  up.scale(54.8);
  const PatchModel teapot = Transformed(LoadModel("examples/teapot.bpt"), up);
  for (const Vec3& axis : {kTilted, Vec3(0.11, -0.07, 1.0), Vec3(0.9, 0.3, 0.2), Vec3(-0.5, 0.7, 0.4)}) {
    SCOPED_TRACE(axis.transpose());
    ExpectCountsOfSignGrid(teapot, axis);
  }
  ExpectCountsOfSignGrid(teapot, Vec3::UnitZ(), true);
}

}  // namespace
}  // namespace patchmill
