// The pictures of control points in patch.h say what Evaluate does: read from the header, each index is
// checked by what its point does to the surface. A patch without weights is linear in its points, so a patch
// whose points are all zero but one at (1,0,0) shows the influence of that one, derivatives included.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "core/network/control_points.h"
#include "core/patch/patch.h"
#include "tests/support/files.h"
#include "tests/support/net_picture.h"

namespace patchmill {
namespace {

using testing::NetLine;
using testing::NetPicture;

struct Drawn {
  const char* kind;
  PatchShape shape;  // with as many points as the picture has
};

std::vector<Drawn> AllKinds() {
  using Blend = GregoryPatch::Blend;
  std::vector<Drawn> kinds;
  kinds.push_back({"BezierPatch", BezierPatch{2, 3, std::vector<Vec3>(12), {}}});
  kinds.push_back({"BsplinePatch",
                   BsplinePatch{2, 2, {0, 0, 0, 1, 2, 2, 2}, {0, 0, 0, 1, 1, 1}, std::vector<Vec3>(12), {}}});
  kinds.push_back({"GregoryPatch", GregoryPatch{{}, Blend::kCorner}});
  kinds.push_back({"GregoryPatch", GregoryPatch{{}, Blend::kEdge}});
  kinds.push_back({"BezierTriangle", BezierTriangle{3, std::vector<Vec3>(10), {}}});
  kinds.push_back({"BrownPatch", BrownPatch{3, 4, std::vector<Vec3>(24)}});
  kinds.push_back({"GregoryTriangle", GregoryTriangle{{}, Blend::kCorner}});
  kinds.push_back({"GregoryTriangle", GregoryTriangle{{}, Blend::kEdge}});
  kinds.push_back({"LoftTriangle", LoftTriangle{3, false, std::vector<Vec3>(15)}});
  kinds.push_back({"LoftTriangle", LoftTriangle{3, true, std::vector<Vec3>(15)}});
  kinds.push_back({"G2GregoryPatch", G2GregoryPatch{5, std::vector<Vec3>(52)}});
  HosakaPatch hosaka;
  hosaka.inner_u = 1, hosaka.inner_v = 2, hosaka.inner_order = 2;
  hosaka.points.resize(18);
  kinds.push_back({"HosakaPatch", hosaka});
  return kinds;
}

const NetPicture& PictureOf(const std::string& kind) {
  static std::map<std::string, NetPicture> pictures;
  const auto [it, is_new] = pictures.try_emplace(kind);
  if (is_new) it->second = testing::ReadNetPicture(testing::ReadRepositoryFile("core/patch/patch.h"), kind);
  return it->second;
}

// What point k does to the surface.
SurfaceJet Influence(PatchShape shape, int k, const Vec2& at) {
  for (Vec3& p : ControlPoints(shape)) p.setZero();
  ControlPoints(shape)[static_cast<std::size_t>(k)] = Vec3::UnitX();
  return Evaluate(shape, at.x(), at.y());
}
double Value(const PatchShape& shape, int k, const Vec2& at) { return Influence(shape, k, at).p.x(); }
double Slope(const PatchShape& shape, int k, const Vec2& at, const Vec2& direction) {
  const SurfaceJet jet = Influence(shape, k, at);
  return direction.x() * jet.du.x() + direction.y() * jet.dv.x();
}

// The parameters along a side of the frame, sides as in NetPicture.
Vec2 OnSide(bool is_triangle, std::size_t side, double t) {
  if (is_triangle) return side == 0 ? Vec2(t, 0) : side == 1 ? Vec2(1 - t, t) : Vec2(0, t);
  return side == 0 ? Vec2(t, 0) : side == 1 ? Vec2(1, t) : side == 2 ? Vec2(t, 1) : Vec2(0, t);
}
// Into the patch from a side, as a line of the picture runs that begins on it.
Vec2 Inward(const Drawn& drawn, std::size_t side, const Vec2& at, bool is_vertical) {
  const bool is_triangle = IsTriangle(drawn.shape);
  if (std::holds_alternative<LoftTriangle>(drawn.shape)) {
    const Vec2 opposite[3] = {Vec2(0, 1), Vec2(0, 0), Vec2(1, 0)};
    return opposite[side] - at;
  }
  const bool is_far = is_triangle ? side == 1 : side == 1 || side == 2;
  return (is_far ? -1.0 : 1.0) * (is_vertical ? Vec2(0, 1) : Vec2(1, 0));
}
// Whether a line up and down (else: left and right) leads into the patch from the side.
bool LeadsInward(bool is_triangle, std::size_t side, bool is_vertical) {
  if (is_triangle) return side == 1 || is_vertical == (side == 0);
  return is_vertical == (side % 2 == 0);
}

bool Holds(const std::vector<int>& points, int k) { return std::ranges::find(points, k) != points.end(); }

std::set<int> FramePoints(const NetPicture& picture) {
  std::set<int> frame;
  for (const auto& side : picture.sides) frame.insert(side.begin(), side.end());
  return frame;
}

constexpr double kPlaces[] = {0.13, 0.3, 0.5, 0.62, 0.9};

class ControlNetPictures : public ::testing::TestWithParam<Drawn> {
 protected:
  const Drawn drawn_ = GetParam();
  const PatchShape& shape_ = drawn_.shape;
  const NetPicture& picture_ = PictureOf(drawn_.kind);
  const int count_ = static_cast<int>(ControlPoints(shape_).size());
};

TEST_P(ControlNetPictures, HaveEachPointOnce) {
  EXPECT_EQ(picture_.is_triangle, IsTriangle(shape_));
  std::multiset<int> drawn, expected;
  for (const auto& row : picture_.rows) {
    for (const auto& place : row) {
      drawn.insert(place.vertical);
      if (place.horizontal != place.vertical) drawn.insert(place.horizontal);
    }
  }
  for (int k = 0; k < count_; ++k) expected.insert(k);
  EXPECT_EQ(drawn, expected);
}

TEST_P(ControlNetPictures, CornersOfTheFrameAreTheCornersOfThePatch) {
  for (std::size_t side = 0; side < picture_.sides.size(); ++side) {
    for (const double end : {0.0, 1.0}) {
      const int corner = end == 0 ? picture_.sides[side].front() : picture_.sides[side].back();
      for (int k = 0; k < count_; ++k) {
        EXPECT_NEAR(Value(shape_, k, OnSide(picture_.is_triangle, side, end)), k == corner ? 1 : 0, 1e-12)
            << "point " << k << " at the corner drawn as " << corner;
      }
    }
  }
}

// Along a side only its own points count, with weights that add up to one, the one drawn later further on.
TEST_P(ControlNetPictures, EdgesAreMadeOfThePointsOnTheFrameInTheirOrder) {
  for (std::size_t side = 0; side < picture_.sides.size(); ++side) {
    const std::vector<int>& points = picture_.sides[side];
    std::map<int, double> sum, moment;
    for (const double t : kPlaces) {
      double all = 0;
      for (int k = 0; k < count_; ++k) {
        const double value = Value(shape_, k, OnSide(picture_.is_triangle, side, t));
        if (Holds(points, k)) {
          EXPECT_GE(value, -1e-12) << "point " << k << ", side " << side;
        } else {
          EXPECT_NEAR(value, 0, 1e-12) << "point " << k << " is not drawn on side " << side;
        }
        all += value, sum[k] += value, moment[k] += t * value;
      }
      EXPECT_NEAR(all, 1, 1e-12) << "side " << side;
    }
    for (std::size_t i = 1; i < points.size(); ++i) {
      EXPECT_LT(moment[points[i - 1]] / sum[points[i - 1]], moment[points[i]] / sum[points[i]])
          << "points " << points[i - 1] << " and " << points[i] << " of side " << side;
    }
  }
}

// A line from the frame inward joins the two points whose difference is the tangent across the side there, so
// their influences on that tangent are opposite; an inner point without such a line has none.
TEST_P(ControlNetPictures, LinesFromTheFrameInwardAreTheTangentsAcrossIt) {
  const std::set<int> frame = FramePoints(picture_);
  std::vector<std::set<int>> served(picture_.sides.size());
  for (const NetLine& line : picture_.lines) {
    if (frame.contains(line.from) == frame.contains(line.to)) continue;
    const int outer = frame.contains(line.from) ? line.from : line.to;
    const int inner = outer == line.from ? line.to : line.from;
    bool serves = false;
    for (std::size_t side = 0; side < picture_.sides.size(); ++side) {
      if (!Holds(picture_.sides[side], outer)) continue;
      if (!LeadsInward(picture_.is_triangle, side, line.is_vertical)) continue;
      serves = true;
      served[side].insert(inner);
      for (const double t : kPlaces) {
        const Vec2 at = OnSide(picture_.is_triangle, side, t);
        const Vec2 inward = Inward(drawn_, side, at, line.is_vertical);
        const double slope = Slope(shape_, inner, at, inward);
        EXPECT_GT(slope, 1e-3) << "points " << outer << " and " << inner << ", side " << side;
        EXPECT_NEAR(slope, -Slope(shape_, outer, at, inward), 1e-11)
            << "points " << outer << " and " << inner << ", side " << side;
      }
    }
    EXPECT_TRUE(serves) << "the line from " << outer << " to " << inner << " leads across no side";
  }
  for (std::size_t side = 0; side < picture_.sides.size(); ++side) {
    for (int k = 0; k < count_; ++k) {
      if (frame.contains(k) || served[side].contains(k)) continue;
      for (const double t : kPlaces) {
        const Vec2 at = OnSide(picture_.is_triangle, side, t);
        const Vec2 inward = Inward(drawn_, side, at, LeadsInward(picture_.is_triangle, side, true));
        EXPECT_NEAR(Slope(shape_, k, at, inward), 0, 1e-11)
            << "point " << k << " bends the tangents across side " << side << " without a line to it";
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, ControlNetPictures, ::testing::ValuesIn(AllKinds()), [](const auto& drawn) {
  return std::string(drawn.param.kind) + "_" + std::to_string(drawn.index);
});

// The second row of a G2-Gregory net serves curvature: at the edges v=0 and v=1 the first of a pair, at u=0
// and u=1 the second, with the weight of the point of the frame that it lies behind.
TEST(ControlNetPicture, SecondRowsOfG2GregoryPatchesServeTheCurvatureAcross) {
  const NetPicture& picture = PictureOf("G2GregoryPatch");
  const PatchShape shape = G2GregoryPatch{5, std::vector<Vec3>(52)};
  ASSERT_EQ(picture.rows.size(), 6u);
  for (std::size_t k = 1; k < 5; ++k) {
    for (const double t : kPlaces) {
      const auto across_v = [&](int point, double v) { return Influence(shape, point, {t, v}).dvv.x(); };
      const auto across_u = [&](int point, double u) { return Influence(shape, point, {u, t}).duu.x(); };
      const auto column = [&](std::size_t i) { return picture.rows[i][k]; };
      const auto row = [&](std::size_t i) { return picture.rows[k][i]; };
      EXPECT_NEAR(across_v(column(2).vertical, 0), across_v(column(0).vertical, 0), 1e-10);
      EXPECT_NEAR(across_v(column(3).vertical, 1), across_v(column(5).vertical, 1), 1e-10);
      EXPECT_NEAR(across_u(row(2).horizontal, 0), across_u(row(0).horizontal, 0), 1e-10);
      EXPECT_NEAR(across_u(row(3).horizontal, 1), across_u(row(5).horizontal, 1), 1e-10);
    }
  }
}

// The coefficients inside the picture of a Hosaka patch belong to u^i v^j times one common factor.
TEST(ControlNetPicture, InnerTermOfHosakaPatchesIsDrawnByItsPowers) {
  const NetPicture& picture = PictureOf("HosakaPatch");
  const std::set<int> frame = FramePoints(picture);
  HosakaPatch hosaka;
  hosaka.inner_u = 1, hosaka.inner_v = 2;
  hosaka.points.resize(18);
  std::vector<std::vector<int>> inner;  // [j][i]
  for (const auto& row : picture.rows) {
    std::vector<int> points;
    for (const auto& place : row) {
      if (!frame.contains(place.vertical)) points.push_back(place.vertical);
    }
    if (!points.empty()) inner.push_back(points);
  }
  ASSERT_EQ(inner.size(), 3u);
  for (const Vec2& at : {Vec2(0.3, 0.8), Vec2(0.6, 0.2)}) {
    for (std::size_t j = 0; j < 3; ++j) {
      ASSERT_EQ(inner[j].size(), 2u);
      for (std::size_t i = 0; i < 2; ++i) {
        const double power =
            std::pow(at.x(), static_cast<double>(i)) * std::pow(at.y(), static_cast<double>(j));
        EXPECT_NEAR(Value(hosaka, inner[j][i], at), power * Value(hosaka, inner[0][0], at), 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace patchmill
