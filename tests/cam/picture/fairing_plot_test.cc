// The plot of fairing: what it shows, how long the teeth are, how large it may get.
#include "cam/picture/fairing_plot.h"

#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patchmill {
namespace {

using ::testing::HasSubstr;

std::size_t Count(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

// Lengths of the <line> elements, in order.
std::vector<double> TeethLengths(const std::string& svg) {
  std::vector<double> lengths;
  for (std::size_t at = svg.find("<line"); at != std::string::npos; at = svg.find("<line", at + 1)) {
    double x1 = 0, y1 = 0, x2 = 0, y2 = 0;
    EXPECT_EQ(std::sscanf(svg.c_str() + at, "<line x1=\"%lf\" y1=\"%lf\" x2=\"%lf\" y2=\"%lf\"", &x1, &y1,
                          &x2, &y2),
              4);
    lengths.push_back(std::hypot(x2 - x1, y2 - y1));
  }
  return lengths;
}

std::vector<Vec3> Arc(double radius, int n) {
  std::vector<Vec3> points;
  for (int i = 0; i <= n; ++i) {
    const double a = kPi / 3 * i / n;
    points.emplace_back(radius * std::cos(a), 0, radius * std::sin(a));
  }
  return points;
}

TEST(FairingPlot, TeethAreAsLongAsTheCurvatureInOneScaleForBoth) {
  const Beam before = FitBeam(Arc(50, 60), {}, {}), after = FitBeam(Arc(100, 60), {}, {});
  const std::string svg = DrawFairing({&before, &after, "arcs <of> two & sizes", {"a note"}});
  EXPECT_THAT(svg, HasSubstr("arcs &lt;of&gt; two &amp; sizes"));
  EXPECT_THAT(svg, HasSubstr("a note"));
  EXPECT_THAT(svg, HasSubstr(">before<"));
  EXPECT_THAT(svg, HasSubstr(">after<"));
  const std::vector<double> lengths = TeethLengths(svg);
  ASSERT_EQ(lengths.size(), 2u * 60 * 8);
  for (std::size_t k = 50; k < 430; ++k) {  // away from the ends
    EXPECT_NEAR(lengths[480 + k] / lengths[k], 0.5, 0.01);
  }
}

TEST(FairingPlot, AStraightLineHasNoTeethToSpeakOf) {
  const Beam line = FitBeam({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, {}, {});
  for (const double length : TeethLengths(DrawFairing({&line, &line, "", {}}))) EXPECT_EQ(length, 0.0);
}

TEST(FairingPlot, ManyPointsAreThinned) {
  std::vector<Vec3> points;
  for (int i = 0; i < 20'000; ++i) points.emplace_back(0.01 * i, std::sin(0.001 * i), 0);
  const Beam beam = FitBeam(points, {}, {});
  const std::string svg = DrawFairing({&beam, &beam, "", {}});
  EXPECT_LE(Count(svg, "<line"), 2u * kMaxCombTeeth);
  EXPECT_GT(Count(svg, "<line"), 4000u);
  EXPECT_LT(svg.size(), 2'000'000u);
}

}  // namespace
}  // namespace patchmill
