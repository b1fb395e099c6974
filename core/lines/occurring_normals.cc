#include "core/lines/occurring_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>

#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

void Add(const SurfaceJet& jet, OccurringNormals& normals) {
  if (const std::optional<Vec3> normal = UnitNormal(jet))
    normals.push_back({*normal, jet.du.cross(jet.dv).norm()});
}

// Axes of the normals, whichever way they look: [0] the one nearest to all of them, [2] the one with the
// least of them. The first looks to the side of most normals.
std::array<Vec3, 3> AxesOf(const OccurringNormals& normals) {
  Mat3 spread = Mat3::Zero();
  Vec3 sum = Vec3::Zero();
  for (const OccurringNormal& n : normals) {
    spread += n.area * n.normal * n.normal.transpose();
    sum += n.area * n.normal;
  }
  const Mat3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors();  // ascending
  std::array<Vec3, 3> sorted = {axes.col(2), axes.col(1), axes.col(0)};
  for (Vec3& axis : sorted) {  // the solver may turn any of them over
    int largest = 0;
    axis.cwiseAbs().maxCoeff(&largest);
    if (axis[largest] < 0.0) axis = -axis;
  }
  if (sorted[0].dot(sum) < 0.0) sorted[0] = -sorted[0];
  return sorted;
}

// Levels between the values but for a hundredth of the area at either end.
std::vector<double> Between(std::vector<std::pair<double, double>> values, int count) {
  constexpr double kEnd = 0.01, kOneLevel = 1e-9;
  std::sort(values.begin(), values.end());
  double all = 0.0;
  for (const auto& [value, area] : values) all += area;
  const auto quantile = [&](double share) {
    double below = 0.0;
    for (const auto& [value, area] : values) {
      below += area;
      if (below >= share * all) return value;
    }
    return values.back().first;
  };
  if (values.empty()) return {};
  const double low = quantile(kEnd), high = quantile(1.0 - kEnd);
  std::vector<double> levels;
  if (!(high - low > kOneLevel)) return levels;
  for (int k = 0; k < count; ++k) levels.push_back(low + (high - low) * (k + 0.5) / count);
  return levels;
}

std::vector<double> HighlightLevels(const OccurringNormals& normals, const HighlightLines& family,
                                    int count) {
  const Vec3 beside = family.plane.cross(family.across);
  const auto angle = [&](const Vec3& n) { return std::atan2(n.dot(beside), n.dot(family.across)); };
  // The middle of angles that count modulo half a turn is that of their doubles. A normal along the axis
  // has no angle.
  double sine = 0.0, cosine = 0.0;
  const auto weight = [&](const OccurringNormal& n) {
    return n.area * family.plane.cross(n.normal).squaredNorm();
  };
  for (const OccurringNormal& n : normals) {
    sine += weight(n) * std::sin(2.0 * angle(n.normal));
    cosine += weight(n) * std::cos(2.0 * angle(n.normal));
  }
  const double middle = 0.5 * std::atan2(sine, cosine);
  std::vector<std::pair<double, double>> values;
  for (const OccurringNormal& n : normals)
    values.emplace_back(std::remainder(angle(n.normal) - middle, kPi), weight(n));
  std::vector<double> levels = Between(std::move(values), count);
  for (double& level : levels) {
    level = std::fmod(level + middle, kPi);
    if (level < 0.0) level += kPi;
    if (level >= kPi) level = 0.0;  // rounding
  }
  return levels;
}

}  // namespace

OccurringNormals NormalsOf(const Surface& surface) {
  OccurringNormals normals;
  for (const Piece& piece : surface.pieces) {
    for (const double u : {1.0 / 6.0, 0.5, 5.0 / 6.0}) {
      for (const double v : {1.0 / 6.0, 0.5, 5.0 / 6.0}) Add(Evaluate(piece, u, v), normals);
    }
  }
  return normals;
}

OccurringNormals NormalsOf(const std::vector<Patch>& patches) {
  OccurringNormals normals;
  for (const Patch& patch : patches) {
    for (const double u : {1.0 / 6.0, 0.5, 5.0 / 6.0}) {
      for (const double v : {1.0 / 6.0, 0.5, 5.0 / 6.0}) {
        if (IsTriangle(patch.shape) && u + v > 1.0) continue;
        Add(Evaluate(patch.shape, u, v), normals);
      }
    }
  }
  return normals;
}

HighlightLines ChooseHighlights(const OccurringNormals& normals) {
  if (normals.empty()) return {};
  const std::array<Vec3, 3> axes = AxesOf(normals);
  return {axes[2], axes[0]};
}

BrightnessLines ChooseBrightness(const OccurringNormals& normals) {
  if (normals.empty()) return {};
  const std::array<Vec3, 3> axes = AxesOf(normals);
  return {(axes[0] + axes[1]).normalized()};
}

std::vector<double> LevelsOfNormals(const OccurringNormals& normals, const LineFamily& family, int count) {
  if (const auto* highlights = std::get_if<HighlightLines>(&family))
    return HighlightLevels(normals, *highlights, count);
  const auto* brightness = std::get_if<BrightnessLines>(&family);
  if (brightness == nullptr) return {};
  std::vector<std::pair<double, double>> values;
  for (const OccurringNormal& n : normals) values.emplace_back(brightness->light.dot(n.normal), n.area);
  return Between(std::move(values), count);
}

}  // namespace patchmill
