#include "cam/picture/leftover_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace patchmill {
namespace {

constexpr int kSide = 900;           // dots of the longer side
constexpr std::uint8_t kBeside = 0;  // indices into the palette; the larger one wins
constexpr std::uint8_t kUnreached = 1;
constexpr std::uint8_t kBelowZero = 2;
constexpr std::uint8_t kFirst = 3;  // leftover 0
constexpr int kShades = 64;         // up to the limit
constexpr std::uint8_t kAbove = kFirst + kShades;
constexpr std::uint8_t kFarAbove = kAbove + 1;

std::uint8_t ColorOf(const LeftoverCell& cell, double limit) {
  if (!cell.leftover) return kUnreached;
  const double share = *cell.leftover / limit;
  if (share < 0.0) return kBelowZero;
  if (share > 2.0) return kFarAbove;
  if (share > 1.0) return kAbove;
  return static_cast<std::uint8_t>(kFirst + std::min(kShades - 1, static_cast<int>(share * kShades)));
}

std::vector<std::array<std::uint8_t, 3>> Palette() {
  std::vector<std::array<std::uint8_t, 3>> palette = {{255, 255, 255}, {170, 170, 170}, {40, 90, 200}};
  for (int k = 0; k < kShades; ++k) {
    const double share = static_cast<double>(k) / (kShades - 1);
    palette.push_back({static_cast<std::uint8_t>(60 + 190 * share),
                       static_cast<std::uint8_t>(160 + 50 * share), static_cast<std::uint8_t>(60)});
  }
  palette.push_back({220, 40, 30});
  palette.push_back({110, 0, 0});
  return palette;
}

// The frame of the picture, and its dots.
class Dots {
 public:
  Dots(const Box3& box, PalettePicture& picture) : picture_(picture) {
    const Vec2 size = Xy(box.max - box.min).cwiseMax(1e-9);
    scale_ = (kSide - 1) / size.maxCoeff();
    corner_ = Vec2(box.min.x(), box.max.y());
    picture.width = static_cast<int>(std::ceil(size.x() * scale_)) + 1;
    picture.height = static_cast<int>(std::ceil(size.y() * scale_)) + 1;
    picture.pixels.assign(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height),
                          kBeside);
  }

  void Fill(const LeftoverCell& cell, std::uint8_t color) {
    std::array<Vec2, 4> q;
    Vec2 least = Vec2::Constant(kInfinity), most = Vec2::Constant(-kInfinity);
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec2 d = Xy(cell.corners[k]) - corner_;
      q[k] = Vec2(d.x() * scale_, -d.y() * scale_);
      least = least.cwiseMin(q[k]);
      most = most.cwiseMax(q[k]);
      Mark(q[k], color);  // a wall has no area from above, but its dots are shown
    }
    for (int y = Clamp(std::ceil(least.y()), picture_.height); y <= std::floor(most.y()); ++y) {
      for (int x = Clamp(std::ceil(least.x()), picture_.width); x <= std::floor(most.x()); ++x) {
        if (Inside(q, Vec2(x, y))) Mark(Vec2(x, y), color);
      }
    }
  }

 private:
  static int Clamp(double value, int size) { return std::clamp(static_cast<int>(value), 0, size - 1); }

  void Mark(const Vec2& at, std::uint8_t color) {
    const int x = Clamp(std::round(at.x()), picture_.width), y = Clamp(std::round(at.y()), picture_.height);
    std::uint8_t& dot =
        picture_.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width) +
                        static_cast<std::size_t>(x)];
    dot = std::max(dot, color);
  }

  // On one side of all edges, whichever way round they go.
  static bool Inside(const std::array<Vec2, 4>& q, const Vec2& p) {
    bool left = true, right = true;
    for (std::size_t k = 0; k < 4; ++k) {
      const double side = Cross(Vec2(q[(k + 1) % 4] - q[k]), Vec2(p - q[k]));
      left = left && side >= 0.0;
      right = right && side <= 0.0;
    }
    return left || right;
  }

  PalettePicture& picture_;
  Vec2 corner_ = Vec2::Zero();
  double scale_ = 1.0;  // dots per mm
};

}  // namespace

PalettePicture DrawLeftover(const std::vector<LeftoverCell>& cells, double limit) {
  PalettePicture picture;
  picture.palette = Palette();
  Box3 box;
  for (const LeftoverCell& cell : cells) {
    for (const Vec3& corner : cell.corners) box.Add(corner);
  }
  if (box.Empty()) {
    picture.width = picture.height = 1;
    picture.pixels = {kBeside};
    return picture;
  }
  Dots dots(box, picture);
  for (const LeftoverCell& cell : cells) dots.Fill(cell, ColorOf(cell, limit));
  return picture;
}

}  // namespace patchmill
