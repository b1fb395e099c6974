#include "cam/picture/paint.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace patchmill {
namespace {

using Rgb = std::array<double, 3>;

constexpr const char* kGrey = "#bbbbbb";
constexpr Rgb kLevel{247, 250, 240}, kBelow{122, 178, 90}, kAbove{253, 202, 130}, kUpright{178, 20, 20};
constexpr Rgb kOutward{178, 34, 30}, kNeither{248, 248, 244}, kInward{30, 80, 178};

std::string Mix(const Rgb& a, const Rgb& b, double share) {
  int rgb[3];
  for (std::size_t k = 0; k < 3; ++k) rgb[k] = static_cast<int>(std::lround(a[k] + share * (b[k] - a[k])));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

}  // namespace

std::string Lit(const std::string& color, const SurfaceJet& jet) {
  const Vec3 light = Vec3(-0.4, -0.3, 0.87).normalized();
  const auto normal = UpwardNormal(jet);
  const double shade = normal ? std::clamp(0.35 + 0.65 * std::abs(normal->dot(light)), 0.0, 1.0) : 0.5;
  Rgb rgb{200, 200, 200};
  if (color.size() == 7 && color[0] == '#') {
    for (std::size_t k = 0; k < 3; ++k) rgb[k] = std::stoi(color.substr(1 + 2 * k, 2), nullptr, 16);
  }
  return fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(rgb[0] * shade),
                     static_cast<int>(rgb[1] * shade), static_cast<int>(rgb[2] * shade));
}

std::string SlopeColor(double slope, const PaintScales& scales) {
  const double steep = std::clamp(scales.steep_angle, 1e-3, 0.5 * kPi - 1e-3);
  if (slope < steep) return Mix(kLevel, kBelow, std::max(0.0, slope) / steep);
  return Mix(kAbove, kUpright, std::min(1.0, (slope - steep) / (0.5 * kPi - steep)));
}

std::string CurvatureColor(double curvature, const PaintScales& scales) {
  // The square root makes small curvatures visible, too.
  const double share = std::sqrt(std::min(1.0, std::abs(curvature) * scales.radius));
  return Mix(kNeither, curvature < 0.0 ? kOutward : kInward, share);
}

std::string PaintedColor(Paint paint, const SurfaceJet& jet, const PaintScales& scales) {
  const auto normal = UpwardNormal(jet);
  if (!normal) return kGrey;
  if (paint == Paint::kSlope) return SlopeColor(std::acos(std::clamp(normal->z(), 0.0, 1.0)), scales);
  const double curvature = ContourCurvature(jet, Forms(jet, *normal));
  return std::isfinite(curvature) ? CurvatureColor(curvature, scales) : kGrey;
}

}  // namespace patchmill
