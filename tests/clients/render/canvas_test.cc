// Pictures of pixels: what is drawn where, against areas and places in closed form.
#include "clients/render/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "clients/render/label.h"
#include "tests/support/png.h"

namespace patchmill::render {
namespace {

constexpr Rgb kWhite{255, 255, 255}, kRed{200, 0, 0}, kBlue{0, 0, 200};

int Count(const Image& image, Rgb color) {
  return static_cast<int>(std::count(image.pixels.begin(), image.pixels.end(), color));
}

// The drawing at its full size: each pixel of the half image stands for four.
Image Whole(const Canvas& canvas) { return canvas.Halved(); }

const auto kPaintRed = [](double, double, double) { return kRed; };
const auto kPaintBlue = [](double, double, double) { return kBlue; };

TEST(Canvas, ATriangleHasItsArea) {
  Canvas canvas({400, 400}, kWhite);
  canvas.FillTriangle({{{20, 20, 0}, {380, 60, 0}, {100, 300, 0}}}, kPaintRed);
  const double area = 0.5 * std::abs((380.0 - 20) * (300 - 20) - (100.0 - 20) * (60 - 20)) / 4.0;
  EXPECT_NEAR(Count(Whole(canvas), kRed), area, 0.03 * area);
}

// Triangles that share a side leave no gap and do not overlap, whichever way they turn.
TEST(Canvas, NeighboursShareNoPixelAndLeaveNone) {
  for (const bool turned : {false, true}) {
    Canvas canvas({100, 100}, kWhite);
    const Seen a{0, 0, 0}, b{100, 0, 0}, c{100, 100, 0}, d{0, 100, 0};
    const auto blend = [&](const Triangle& t) {
      canvas.BlendTriangle(turned ? Triangle{t[0], t[2], t[1]} : t, kRed, 0.5);
    };
    blend({a, b, c});
    blend({a, c, d});
    const Rgb once = Mixed(kWhite, kRed, 0.5);
    EXPECT_EQ(Count(canvas.Halved(), once), 50 * 50);
  }
}

TEST(Canvas, TheNearerSurfaceHidesTheOther) {
  for (const bool nearer_first : {false, true}) {
    Canvas canvas({100, 100}, kWhite);
    const Triangle far{{{0, 0, 0}, {200, 0, 0}, {0, 200, 0}}}, near{{{0, 0, 1}, {200, 0, 1}, {0, 200, 1}}};
    if (nearer_first) canvas.FillTriangle(near, kPaintBlue);
    canvas.FillTriangle(far, kPaintRed);
    if (!nearer_first) canvas.FillTriangle(near, kPaintBlue);
    EXPECT_EQ(Count(canvas.Halved(), kBlue), 50 * 50);
  }
}

// Two planes that cross in the middle of the picture: each is seen on its side.
TEST(Canvas, CrossingPlanesChangeWhereTheyCross) {
  Canvas canvas({200, 200}, kWhite);
  const auto fill = [&](double left, double right, const auto& paint) {
    const Seen a{0, 0, left}, b{200, 0, right}, c{200, 200, right}, d{0, 200, left};
    canvas.FillTriangle({a, b, c}, paint);
    canvas.FillTriangle({a, c, d}, paint);
  };
  fill(0, 10, kPaintRed);
  fill(10, 0, kPaintBlue);
  const Image image = canvas.Halved();
  EXPECT_EQ(image.At(20, 50), kBlue);
  EXPECT_EQ(image.At(80, 50), kRed);
  EXPECT_NEAR(Count(image, kRed), Count(image, kBlue), 200);
}

TEST(Canvas, PaintsByTheSharesOfTheCorners) {
  Canvas canvas({200, 200}, kWhite);
  const Triangle triangle{{{0, 0, 0}, {200, 0, 0}, {0, 200, 0}}};
  for (const bool turned : {false, true}) {
    const Triangle t = turned ? Triangle{triangle[0], triangle[2], triangle[1]} : triangle;
    Canvas fresh({200, 200}, kWhite);
    fresh.FillTriangle(t, [&](double a, double b, double c) {
      EXPECT_NEAR(a + b + c, 1.0, 1e-12);
      return Rgb{static_cast<std::uint8_t>(200 * a), static_cast<std::uint8_t>(200 * (turned ? c : b)), 0};
    });
    const Image image = fresh.Halved();
    EXPECT_NEAR(image.At(2, 2).red, 190, 2);
    EXPECT_NEAR(image.At(90, 2).green, 181, 4);
    EXPECT_NEAR(image.At(2, 90).green, 5, 4);
  }
}

// A polygon that is not convex, and one with its depth across it.
TEST(Canvas, PolygonsOfAnyShape) {
  Canvas canvas({200, 200}, kWhite);
  canvas.DrawPolygon({{20, 20, 0}, {180, 20, 0}, {180, 180, 0}, {100, 60, 0}, {20, 180, 0}}, kRed);
  const Image image = canvas.Halved();
  EXPECT_EQ(image.At(50, 20), kRed);
  EXPECT_EQ(image.At(50, 60), kWhite);  // in the notch
  EXPECT_EQ(image.At(15, 60), kRed);
  const double area = (160.0 * 160.0 - 0.5 * 160.0 * 120.0) / 4.0;
  EXPECT_NEAR(Count(image, kRed), area, 0.03 * area);
}

TEST(Canvas, APolygonIsAsDeepAsItsPlane) {
  Canvas canvas({200, 200}, kWhite);
  canvas.DrawPolygon({{0, 0, -10}, {200, 0, 10}, {200, 200, 10}, {0, 200, -10}}, kRed);
  canvas.DrawPolygon({{0, 0, 0}, {200, 0, 0}, {200, 200, 0}, {0, 200, 0}}, kBlue);
  const Image image = canvas.Halved();
  EXPECT_EQ(image.At(20, 50), kBlue);
  EXPECT_EQ(image.At(80, 50), kRed);
}

TEST(Canvas, LinesAreAsLongAndWideAsTheyShouldBe) {
  for (const auto& [to, length] :
       {std::pair(Seen{180, 20, 0}, 80), std::pair(Seen{20, 180, 0}, 80), std::pair(Seen{180, 180, 0}, 80)}) {
    Canvas canvas({200, 200}, kWhite);
    canvas.DrawLine({20, 20, 0}, to, {kRed, 2, 0.0});
    const Image image = canvas.Halved();
    double ink = 0.0;
    for (const Rgb& pixel : image.pixels) ink += (255.0 - pixel.green) / 255.0;
    EXPECT_NEAR(ink, length, 2.0);
  }
}

TEST(Canvas, LinesAreHiddenUnlessTheyAreNearer) {
  Canvas canvas({100, 100}, kWhite);
  canvas.FillTriangle({{{0, 0, 5}, {200, 0, 5}, {0, 200, 5}}}, kPaintBlue);
  canvas.DrawLine({10, 50, 0}, {90, 50, 0}, {kRed, 2, 4.9});
  EXPECT_EQ(Count(canvas.Halved(), kBlue), 50 * 50);
  canvas.DrawLine({10, 50, 0}, {90, 50, 0}, {kRed, 2, 5.1});
  EXPECT_LT(Count(canvas.Halved(), kBlue), 50 * 50 - 30);
}

// What lies partly or wholly beyond the picture, at places that are no numbers, or far away, is left out.
TEST(Canvas, NothingIsDrawnBeyondThePicture) {
  Canvas canvas({100, 100}, kWhite);
  const double far = 1e12, nan = std::nan("");
  canvas.DrawLine({-far, -far, 0}, {-1, far, 0}, {kRed, 2, 0.0});
  canvas.DrawLine({nan, 0, 0}, {50, nan, 0}, {kRed, 2, 0.0});
  canvas.FillTriangle({{{-far, 0, 0}, {-10, 0, 0}, {-10, far, 0}}}, kPaintRed);
  canvas.FillTriangle({{{nan, 0, 0}, {10, 0, 0}, {10, 10, 0}}}, kPaintRed);
  canvas.DrawPolygon({{nan, 0, 0}, {10, 0, 0}, {10, 10, 0}}, kRed);
  canvas.DrawPolygon({{-far, -far, 0}, {-1, -far, 0}, {-1, far, 0}}, kRed);
  EXPECT_EQ(Count(canvas.Halved(), kWhite), 50 * 50);
  canvas.FillTriangle({{{-far, -far, 0}, {far, -far, 0}, {0, far, 0}}}, kPaintRed);
  EXPECT_EQ(Count(canvas.Halved(), kRed), 50 * 50);
}

std::vector<Point> CornersOf(const Box& box) {
  std::vector<Point> corners;
  for (int k = 0; k < 8; ++k) {
    corners.push_back({(k & 1) != 0 ? box.max[0] : box.min[0], (k & 2) != 0 ? box.max[1] : box.min[1],
                       (k & 4) != 0 ? box.max[2] : box.min[2]});
  }
  return corners;
}

TEST(Camera, ShowsAllPointsInEachView) {
  const std::vector<Point> corners = CornersOf({{-10, 20, 5}, {50, 40, 15}});
  for (const std::string& name : ViewNames()) {
    const Camera camera = FitPoints(*ViewOf(name), corners, {300, 200});
    double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
    for (const Point& corner : corners) {
      const Seen seen = Project(camera, corner);
      left = std::min(left, seen.x);
      right = std::max(right, seen.x);
      top = std::min(top, seen.y);
      bottom = std::max(bottom, seen.y);
    }
    EXPECT_NEAR(left + right, 300.0, 1e-6) << name;
    EXPECT_NEAR(top + bottom, 200.0, 1e-6) << name;
    EXPECT_NEAR(std::max((right - left) / 300.0, (bottom - top) / 200.0), 1.0 / 1.08, 1e-6) << name;
  }
  EXPECT_FALSE(ViewOf("below").has_value());
}

// From the top X runs to the right and Y up, from the front X to the right and Z up, from the right Y to
// the right.
TEST(Camera, StandsWhereItsNameSays) {
  const std::vector<Point> corners = CornersOf({{-10, -10, -10}, {10, 10, 10}});
  const auto at = [&](StandardView view, const Point& p) {
    return Project(FitPoints(view, corners, {100, 100}), p);
  };
  EXPECT_GT(at(StandardView::kTop, {5, 0, 0}).x, 55);
  EXPECT_LT(at(StandardView::kTop, {0, 5, 0}).y, 45);
  EXPECT_GT(at(StandardView::kTop, {0, 0, 5}).depth, 4.9);
  EXPECT_GT(at(StandardView::kFront, {5, 0, 0}).x, 55);
  EXPECT_LT(at(StandardView::kFront, {0, 0, 5}).y, 45);
  EXPECT_GT(at(StandardView::kFront, {0, -5, 0}).depth, 4.9);
  EXPECT_GT(at(StandardView::kRight, {0, 5, 0}).x, 55);
  EXPECT_GT(at(StandardView::kRight, {5, 0, 0}).depth, 4.9);
  EXPECT_GT(at(StandardView::kIso, {0, 0, 5}).depth, 0.0);
  EXPECT_LT(at(StandardView::kIso, {0, 0, 5}).y, 45);
}

TEST(Camera, APointHasASizeToo) {
  const Camera camera = FitPoints(StandardView::kIso, {{1, 2, 3}}, {100, 100});
  EXPECT_NEAR(Project(camera, {1, 2, 3}).x, 50.0, 1e-9);
  EXPECT_GT(camera.pixel_mm, 0.0);
}

TEST(ColorScale, HasItsStopsAndItsEnds) {
  const ColorScale scale{-1.0, 3.0, {{0, 0, 0}, {100, 0, 0}, {100, 200, 0}}, kBlue, kRed, kWhite};
  EXPECT_EQ(ColorAt(scale, -1.0), (Rgb{0, 0, 0}));
  EXPECT_EQ(ColorAt(scale, 0.0), (Rgb{50, 0, 0}));
  EXPECT_EQ(ColorAt(scale, 1.0), (Rgb{100, 0, 0}));
  EXPECT_EQ(ColorAt(scale, 2.0), (Rgb{100, 100, 0}));
  EXPECT_EQ(ColorAt(scale, 3.0), (Rgb{100, 200, 0}));
  EXPECT_EQ(ColorAt(scale, -1.001), kBlue);
  EXPECT_EQ(ColorAt(scale, 3.001), kRed);
  EXPECT_EQ(ColorAt(scale, std::nan("")), kWhite);
  EXPECT_EQ(FromHex("#d7191c"), (Rgb{0xd7, 0x19, 0x1c}));
  EXPECT_EQ(FromHex("d7191c"), (Rgb{}));
}

TEST(Png, IsReadBackByAnotherReader) {
  Image image = MakeImage({37, 11}, kWhite);
  for (int y = 0; y < 11; ++y)
    for (int x = 0; x < 37; ++x)
      image.At(x, y) = {static_cast<std::uint8_t>(7 * x), static_cast<std::uint8_t>(23 * y), 9};
  const std::string file = WritePng(image);
  const patchmill::testing::DecodedPng read = patchmill::testing::DecodePng(file);
  EXPECT_EQ(read.width, 37);
  EXPECT_EQ(read.height, 11);
  EXPECT_EQ(read.channels, 3);
  ASSERT_EQ(read.pixels.size(), image.pixels.size());
  EXPECT_EQ(std::memcmp(read.pixels.data(), image.pixels.data(), 3 * read.pixels.size()), 0);
  EXPECT_EQ(WritePng(image), file);
}

TEST(Label, IsAsWideAsItSays) {
  const std::string text = "Leftover 0.012 mm";
  const double width = TextWidth(text, 20);
  EXPECT_GT(width, 120);
  EXPECT_NEAR(TextWidth(text, 40), 2 * width, 1.0);
  Image image = MakeImage({300, 60}, kWhite);
  DrawText(image, 10, 10, text, {20, {0, 0, 0}});
  int left = 300, right = 0, top = 60, bottom = 0;
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 300; ++x) {
      if (image.At(x, y) == kWhite) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  EXPECT_NEAR(left, 10, 4);
  EXPECT_NEAR(right, 10 + width, 4);
  EXPECT_GE(top, 10);
  EXPECT_LE(bottom, 31);
}

TEST(Label, TakesAnyBytes) {
  Image image = MakeImage({80, 20}, kWhite);
  for (const std::string text :
       {"", "\xff\xfe", "\xe2\x82", "a\nb\t\x01", "\xc3\xa4\xe2\x82\xac\xf0\x9f\x94\xa7", "\xed\xa0\x80"}) {
    DrawText(image, 0, 0, text, {16, {0, 0, 0}});
    EXPECT_GE(TextWidth(text, 16), 0.0);
  }
  EXPECT_EQ(TextWidth("\xff", 16), TextWidth("?", 16));
  DrawText(image, -1000, 1e6, "beyond", {16, {0, 0, 0}});
}

TEST(Label, IsShortenedToItsRoom) {
  const std::string text = "a very long name of a part with \xc3\xa4\xc3\xb6\xc3\xbc";
  EXPECT_EQ(Shortened(text, 16, 1e4), text);
  for (const double room : {200.0, 100.0, 40.0}) {
    const std::string shorter = Shortened(text, 16, room);
    EXPECT_LE(TextWidth(shorter, 16), room);
    EXPECT_EQ(shorter.substr(shorter.size() - 3), "...");
  }
  EXPECT_EQ(Shortened(text, 16, 0.0), "...");
}

}  // namespace
}  // namespace patchmill::render
