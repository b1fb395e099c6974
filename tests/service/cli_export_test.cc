// `patchmill convert` to files of other systems: what goes out comes back with the same heights.
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "cam/plan/plan.h"
#include "patchmill/v1/model.pb.h"
#include "server/convert/model.h"
#include "tests/service/patchmill.h"
#include "tests/service/process.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Finished;
using ::testing::HasSubstr;
using testing::Patchmill;
using testing::Slurp;
using testing::TempDir;

constexpr const char* kRoot = PATCHMILL_SOURCE_DIR;

Surface SurfaceIn(const std::string& json) {
  v1::PatchModel message;
  EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(Slurp(json), &message).ok());
  return *BuildPlacedSurface(FromProto(message, "m")->model, Setup(), RunContext(1));
}

void ExpectSameHeights(const Surface& a, const Surface& b, double most) {
  const double radius = 0.05 * a.box.Diagonal();
  const Locator first(a, radius), second(b, radius);
  testing::Random random(7);
  for (int k = 0; k < 150; ++k) {
    // Inside of the box: at the rim both have it or not by rounding.
    const Vec2 at(random.Uniform(a.box.min.x(), a.box.max.x()), random.Uniform(a.box.min.y(), a.box.max.y()));
    const auto x = first.Height(at), y = second.Height(at);
    ASSERT_EQ(x.has_value(), y.has_value()) << at.transpose();
    if (x) {
      EXPECT_NEAR(x->z, y->z, most) << at.transpose();
    }
  }
}

struct Case {
  const char* model;
  double most = 1e-6;  // mm
  bool both = true;    // IGES, too; large models go one way
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.model; }

class Export : public ::testing::TestWithParam<Case> {};

TEST_P(Export, ComesBackWithTheSameHeights) {
  const TempDir out;
  const std::string model = std::string(kRoot) + "/" + GetParam().model;
  std::vector<const char*> names = {"part.step"};
  if (GetParam().both) names.push_back("part.igs");
  for (const char* name : names) {
    const Finished there = Patchmill({"convert", model, out / name});
    ASSERT_EQ(there.status, 0) << there.err;
    const bool fitted = there.err.find("EXPORT_FITTED") != std::string::npos;
    EXPECT_EQ(fitted, GetParam().most > 1e-6) << there.err;
    const Finished back = Patchmill({"convert", out / name, out / "back.json"});
    ASSERT_EQ(back.status, 0) << back.err;
    const Finished same = Patchmill({"convert", model, out / "same.json"});
    ASSERT_EQ(same.status, 0) << same.err;
    ExpectSameHeights(SurfaceIn(out / "same.json"), SurfaceIn(out / "back.json"), GetParam().most);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Models, Export,
    ::testing::Values(Case{"examples/teapot.bpt"}, Case{"examples/two_hills.bv", 1e-6, false},
                      Case{"tests/models/sphere.bv"}, Case{"tests/models/triangle_fan.bv"},
                      Case{"examples/mouse.json", 2e-5, false}, Case{"examples/bonnet.json", 2e-5}));

// The part [from, to] x [0, 30] of the parabolic cylinder z = x^2 / 40 as a patch of degrees 2 and 1.
std::string Strip(double from, double to) {
  std::string points;
  const auto add = [&](double x, double z) { points += fmt::format("{0},0,{1},{0},30,{1},", x, z); };
  add(from, from * from / 40.0);
  add(0.5 * (from + to), from * to / 40.0);
  add(to, to * to / 40.0);
  points.pop_back();
  return fmt::format(R"({{"bezier":{{"degree_u":2,"degree_v":1,"points":[{}]}}}})", points);
}

// Strips of all widths between wide ones. Readers join edges that are close to each other, and leave out
// sides that are shorter than the accuracy of the file: no strip may get the edges of its neighbours, or
// lose its own.
TEST(ExportNarrow, StripsOfAllWidthsComeBack) {
  std::string strips;
  double x = -12.0;
  const auto add = [&](double width) {
    strips += (strips.empty() ? "" : ",") + Strip(x, x + width);
    x += width;
  };
  for (const double width : {2e-2, 3e-3, 5e-4, 6e-5, 8e-6, 9e-7}) {
    add(3.0);
    add(width);
    add(0.7 * width);
  }
  add(3.0);
  // The quarter of a disc in z = 10 whose corner at (x, 0) has no direction: an arc and the radius that
  // begins there like t^2.
  const double r = 8.0, c = x + 2.0 * r;
  strips += fmt::format(
      R"(,{{"bezier":{{"degree_u":2,"degree_v":1,"points":[{0},0,10,{0},0,10,{0},{1},10,{0},0,10,{2},{1},10,{2},0,10],)"
      R"("weights":[1,1,{3},{3},1,1]}}}})",
      c, r, c - r, std::sqrt(0.5));
  const TempDir out;
  std::ofstream(out / "strips.json") << R"({"length_unit":"LENGTH_UNIT_MILLIMETER","patches":[)" << strips
                                     << "]}";
  ASSERT_EQ(Patchmill({"convert", out / "strips.json", out / "same.json"}).status, 0);
  for (const char* name : {"strips.step", "strips.igs"}) {
    ASSERT_EQ(Patchmill({"convert", out / "strips.json", out / name}).status, 0);
    const Finished back = Patchmill({"convert", out / name, out / "back.json"});
    ASSERT_EQ(back.status, 0) << name << ": " << back.err;
    EXPECT_EQ(back.err.find("ERROR"), std::string::npos) << back.err;
    ExpectSameHeights(SurfaceIn(out / "same.json"), SurfaceIn(out / "back.json"), 1e-6);
  }
}

TEST(ExportMesh, StlHasItsTrianglesOnTheSurface) {
  const TempDir out;
  const std::string sphere = std::string(kRoot) + "/tests/models/sphere.bv";
  for (const double chord : {1e-2, 1e-3}) {
    ASSERT_EQ(Patchmill({"convert", sphere, out / "s.stl", "--chord", fmt::format("{}", chord)}).status, 0);
    const std::string bytes = Slurp(out / "s.stl");
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, 4);
    ASSERT_EQ(bytes.size(), 84u + 50u * count);
    const auto number = [&](std::size_t triangle, std::size_t k) {
      float x = 0;
      std::memcpy(&x, bytes.data() + 84 + 50 * triangle + 4 * k, 4);
      return static_cast<double>(x);
    };
    Vec3 sum = Vec3::Zero();
    double radius = 0.0, least = 1e9;
    for (std::size_t t = 0; t < count; ++t) {
      std::array<Vec3, 3> p;
      for (std::size_t c = 0; c < 3; ++c)
        p[c] = Vec3(number(t, 3 + 3 * c), number(t, 4 + 3 * c), number(t, 5 + 3 * c));
      radius = std::max(radius, p[0].norm());
      least = std::min(least, ((p[0] + p[1] + p[2]) / 3).norm());
      const Vec3 n = (p[1] - p[0]).cross(p[2] - p[0]);
      sum += n;
      // Normals are unit and agree with the corners' order.
      EXPECT_NEAR(Vec3(number(t, 0), number(t, 1), number(t, 2)).dot(n.normalized()), 1.0, 1e-4);
    }
    EXPECT_GE(least, radius - 2 * chord);
  }
}

TEST(ExportMesh, ObjReadsBackAsAMesh) {
  const TempDir out;
  ASSERT_EQ(
      Patchmill({"convert", std::string(kRoot) + "/examples/teapot.bpt", out / "t.obj", "--chord", "0.05"})
          .status,
      0);
  EXPECT_THAT(Slurp(out / "t.obj"), ::testing::StartsWith("# Patchmill, mm\no piece_0\nv "));
}

TEST(ExportMesh, RefusesWhatItDoesNotKnow) {
  const TempDir out;
  const std::string teapot = std::string(kRoot) + "/examples/teapot.bpt";
  const Finished ending = Patchmill({"convert", teapot, out / "t.xyz"});
  EXPECT_EQ(ending.status, 2);
  EXPECT_THAT(ending.err, HasSubstr(".step"));
  const Finished chord = Patchmill({"convert", teapot, out / "t.step", "--chord", "0.01"});
  EXPECT_NE(chord.status, 0);
  EXPECT_THAT(chord.err, HasSubstr("chord"));
}

}  // namespace
}  // namespace patchmill
