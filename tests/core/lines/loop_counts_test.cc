// How many lines of each kind the torus and the teapot have: the tracer against a dense grid of signs, which
// knows the fields from METHODS 5 alone, and uses nothing of core/lines.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/lines/line_fields.h"
#include "core/lines/zero_curves.h"
#include "tests/support/files.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

// --- The fields, as METHODS 5 and 1.9 write them; only their signs count ---

using Sign = std::function<double(const SurfaceJet&)>;

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
// (8): chi = n_s . S.
Sign Highlight(const Vec3& f, const Vec3& n_s) {
  return [=](const SurfaceJet& s) { return n_s.dot(s.du) * f.dot(s.dv) - n_s.dot(s.dv) * f.dot(s.du); };
}
// L du^2 + 2 M du dv + N dv^2 along (2).
Sign Inflection(const Vec3& f) {
  return [=](const SurfaceJet& s) {
    const Vec3 n = Normal(s);
    const double a = -f.dot(s.dv), b = f.dot(s.du);
    return n.dot(s.duu) * a * a + 2 * n.dot(s.duv) * a * b + n.dot(s.dvv) * b * b;
  };
}
// (10).
Sign SlopeExtremum(const Vec3& f) {
  return [=](const SurfaceJet& s) {
    const Vec3 n = Normal(s);
    const double E = s.du.dot(s.du), F = s.du.dot(s.dv), G = s.dv.dot(s.dv);
    const double L = n.dot(s.duu), M = n.dot(s.duv), N = n.dot(s.dvv);
    const double a = f.dot(s.du), b = f.dot(s.dv);
    return (M * G - N * F) * a * a - (G * L - N * E) * a * b + (L * F - M * E) * b * b;
  };
}

// --- What is counted ---

// mm: shorter sets are left out. The tracer's cells end at 1/128 of a patch, half a millimetre on the teapot,
// whose knob has lines that run around a hole of 0.03 mm.
constexpr double kSmallest = 1.0;

struct Counts {
  int lines = 0;  // connected sets
  int loops = 0;  // those of them without a free end
  bool operator==(const Counts&) const = default;
};
void PrintTo(const Counts& c, std::ostream* out) { *out << c.lines << " lines, " << c.loops << " closed"; }

// Sets of members with a place each, which grow together.
class Sets {
 public:
  int Add(const Box3& box) {
    parent_.push_back(static_cast<int>(parent_.size()));
    box_.push_back(box);
    return parent_.back();
  }
  int Root(int i) {
    while (parent_[At(i)] != i) i = parent_[At(i)] = parent_[At(parent_[At(i)])];
    return i;
  }
  void Unite(int i, int j) {
    i = Root(i), j = Root(j);
    if (i == j) return;
    parent_[At(i)] = j;
    box_[At(j)].Add(box_[At(i)]);
  }
  // An end at a border or a node: one with others there.
  void AddEnd(int member, const Vec3& p) { ends_.push_back({p, member}); }

  // Ends within `weld` of each other are one; who has an end of its own is open.
  Counts Count(double weld) {
    std::sort(ends_.begin(), ends_.end(), [](const End& a, const End& b) { return a.p.x() < b.p.x(); });
    std::vector<bool> alone(ends_.size(), true);
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      for (std::size_t j = i + 1; j < ends_.size() && ends_[j].p.x() - ends_[i].p.x() <= weld; ++j) {
        if ((ends_[i].p - ends_[j].p).norm() > weld) continue;
        Unite(ends_[i].member, ends_[j].member);
        alone[i] = alone[j] = false;
      }
    }
    std::vector<bool> open(parent_.size(), false);
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      if (alone[i]) open[At(Root(ends_[i].member))] = true;
    }
    Counts counts;
    for (std::size_t k = 0; k < parent_.size(); ++k) {
      if (parent_[k] != static_cast<int>(k) || box_[k].Diagonal() < kSmallest) continue;
      ++counts.lines;
      counts.loops += !open[k];
    }
    return counts;
  }

 private:
  struct End {
    Vec3 p;
    int member;
  };
  static std::size_t At(int i) { return static_cast<std::size_t>(i); }
  std::vector<int> parent_;
  std::vector<Box3> box_;
  std::vector<End> ends_;
};

Box3 BoxOf(const Vec3& p) {
  Box3 box;
  box.Add(p);
  return box;
}

// Where lines of a kind cross each other: nowhere in general, at saddles of the height, or wherever its
// gradient vanishes.
enum class Nodes { kNone, kSaddles, kFlat };

struct Kind {
  std::string name;
  ZeroField traced;
  Sign sign;
  Nodes nodes = Nodes::kNone;
};

// Marching squares over cells x cells of each patch. What passes one cell is one, and so is what passes the
// cells around a node: finer grids tell those apart that do not meet.
class SignGrid {
 public:
  SignGrid(const PatchModel& model, const Vec3& axis, int cells, double weld)
      : model_(model), axis_(axis), cells_(cells), side_(static_cast<std::size_t>(cells) + 1), weld_(weld) {}

  std::vector<Counts> Count(const std::vector<Kind>& kinds) {
    std::vector<Sets> sets(kinds.size());
    jets_.resize(side_ * side_);
    for (const Patch& patch : model_.patches) {
      for (std::size_t i = 0; i < side_; ++i) {
        for (std::size_t j = 0; j < side_; ++j)
          jets_[i * side_ + j] = Evaluate(patch.shape, Parameter(i), Parameter(j));
      }
      FindFlatCells();
      for (std::size_t k = 0; k < kinds.size(); ++k) March(patch.shape, kinds[k], sets[k]);
    }
    std::vector<Counts> counts;
    for (Sets& s : sets) counts.push_back(s.Count(weld_));
    return counts;
  }

 private:
  // Not quite to the border, where edges may be collapsed and derivatives vanish.
  double Parameter(std::size_t i) const {
    constexpr double kInside = 1e-9;
    return std::clamp(static_cast<double>(i) / cells_, kInside, 1.0 - kInside);
  }
  std::array<std::size_t, 4> Corners(std::size_t i, std::size_t j) const {
    return {i * side_ + j, i * side_ + j + 1, (i + 1) * side_ + j, (i + 1) * side_ + j + 1};
  }

  // Cells where both derivatives of the height change sign.
  void FindFlatCells() {
    flat_.clear();
    for (std::size_t i = 0; i + 1 < side_; ++i) {
      for (std::size_t j = 0; j + 1 < side_; ++j) {
        int up_u = 0, up_v = 0, saddles = 0;
        for (const std::size_t k : Corners(i, j)) {
          const SurfaceJet& s = jets_[k];
          up_u += axis_.dot(s.du) > 0.0;
          up_v += axis_.dot(s.dv) > 0.0;
          saddles += axis_.dot(s.duu) * axis_.dot(s.dvv) < std::pow(axis_.dot(s.duv), 2);
        }
        if (up_u % 4 != 0 && up_v % 4 != 0) flat_.push_back({i, j, saddles == 4});
      }
    }
  }

  void March(const PatchShape& shape, const Kind& kind, Sets& sets) {
    const Sign& field = kind.sign;
    std::vector<bool> positive(jets_.size());
    for (std::size_t k = 0; k < jets_.size(); ++k) positive[k] = field(jets_[k]) > 0.0;
    // The crossing on the edge from (i,j) along u, along v, or -1.
    std::array<std::vector<int>, 2> at = {std::vector<int>(jets_.size(), -1),
                                          std::vector<int>(jets_.size(), -1)};
    for (std::size_t i = 0; i < side_; ++i) {
      for (std::size_t j = 0; j < side_; ++j) {
        for (const std::size_t along : {0u, 1u}) {
          const std::size_t ni = along == 0 ? i + 1 : i, nj = along == 0 ? j : j + 1;
          const std::size_t from = i * side_ + j, to = ni * side_ + nj;
          if (ni == side_ || nj == side_ || positive[from] == positive[to]) continue;
          at[along][from] = sets.Add(BoxOf(jets_[from].p));
          const std::size_t border = along == 0 ? j : i;
          if (border != 0 && border + 1 != side_) continue;
          const Vec2 a(Parameter(i), Parameter(j)), b(Parameter(ni), Parameter(nj));
          sets.AddEnd(at[along][from], Crossing(shape, field, a, b, positive[from]));
        }
      }
    }
    const auto unite = [&](std::size_t i, std::size_t j, int first) {
      for (const int id : {at[0][i * side_ + j], at[0][i * side_ + j + 1], at[1][i * side_ + j],
                           at[1][(i + 1) * side_ + j]}) {
        if (id >= 0 && first >= 0) sets.Unite(id, first);
        if (id >= 0) first = id;
      }
      return first;
    };
    for (std::size_t i = 0; i + 1 < side_; ++i) {
      for (std::size_t j = 0; j + 1 < side_; ++j) unite(i, j, -1);
    }
    for (const auto& [i, j, saddle] : flat_) {
      if (kind.nodes == Nodes::kNone || (kind.nodes == Nodes::kSaddles && !saddle)) continue;
      int first = -1;
      for (std::size_t k = i - std::min<std::size_t>(i, 1); k < std::min(i + 2, side_ - 1); ++k) {
        for (std::size_t l = j - std::min<std::size_t>(j, 1); l < std::min(j + 2, side_ - 1); ++l)
          first = unite(k, l, first);
      }
    }
  }

  static Vec3 Crossing(const PatchShape& shape, const Sign& field, Vec2 a, Vec2 b, bool positive_at_a) {
    for (int step = 0; step < 50; ++step) {
      const Vec2 m = 0.5 * (a + b);
      ((field(Evaluate(shape, m.x(), m.y())) > 0.0) == positive_at_a ? a : b) = m;
    }
    return Evaluate(shape, a.x(), a.y()).p;
  }

  const PatchModel& model_;
  const Vec3 axis_;
  const int cells_;
  const std::size_t side_;
  const double weld_;
  std::vector<SurfaceJet> jets_;
  struct FlatCell {
    std::size_t i, j;
    bool saddle;
  };
  std::vector<FlatCell> flat_;
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
void ExpectCountsOfSignGrid(PatchModel model, const Vec3& axis, bool symmetric = false) {
  auto network = BuildNetwork(std::move(model));
  ASSERT_TRUE(network.ok()) << network.status();
  auto surface = BuildSurface(*std::move(network), SurfaceParams(), RunContext());
  ASSERT_TRUE(surface.ok()) << surface.status();
  const double weld = std::max(1e-5, 2 * surface->network.join_tolerance);
  double low = kInfinity, high = -kInfinity;
  for (const SurfaceLeaf& leaf : surface->leaves) {
    low = std::min(low, axis.dot(leaf.center));
    high = std::max(high, axis.dot(leaf.center));
  }
  const Vec3 f = axis.normalized();
  std::vector<Kind> kinds = Kinds(f, f.unitOrthogonal(), low, high);
  if (symmetric) {
    std::erase_if(kinds, [](const Kind& kind) {
      return kind.nodes != Nodes::kNone || kind.name == "silhouette" || kind.name.starts_with("highlight");
    });
  }
  std::vector<ZeroField> fields;
  for (const Kind& kind : kinds) fields.push_back(kind.traced);
  // Until two grids agree.
  std::vector<Counts> counts, before;
  int cells = 50;
  do {
    before = std::exchange(counts, SignGrid(surface->network.model, f, cells, weld).Count(kinds));
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
