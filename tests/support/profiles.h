// Parts as machines cut them every day: profiles turned around z or drawn along y. Exact.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "core/network/patch_model.h"

namespace patchmill::testing {

// Points (r, z) or (x, z) of one Bezier curve, with weights.
struct Profile {
  std::vector<Vec2> points;
  std::vector<double> weights;
};

inline Profile Line(const Vec2& a, const Vec2& b) { return {{a, b}, {1.0, 1.0}}; }
// A quarter of a circle.
inline Profile Round(const Vec2& a, const Vec2& corner, const Vec2& b) {
  return {{a, corner, b}, {1.0, std::sqrt(0.5), 1.0}};
}

// Four quarters of each.
inline PatchModel Turned(const std::vector<Profile>& profiles) {
  PatchModel model;
  const double w = std::sqrt(0.5);
  for (const Profile& profile : profiles) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      const double from = 0.5 * kPi * quarter;
      const Vec2 a(std::cos(from), std::sin(from)), b(-a.y(), a.x());
      BezierPatch patch;
      patch.degree_u = 2;
      patch.degree_v = static_cast<int>(profile.points.size()) - 1;
      for (const auto& [place, weight] : {std::pair{a, 1.0}, {Vec2(a + b), w}, {b, 1.0}}) {
        for (std::size_t k = 0; k < profile.points.size(); ++k) {
          patch.points.push_back(Lift(profile.points[k].x() * place, profile.points[k].y()));
          patch.weights.push_back(weight * profile.weights[k]);
        }
      }
      model.patches.push_back({"", std::move(patch)});
    }
  }
  return model;
}

// From y = 0 to `length`.
inline PatchModel Drawn(const std::vector<Profile>& profiles, double length) {
  PatchModel model;
  for (const Profile& profile : profiles) {
    BezierPatch patch;
    patch.degree_u = static_cast<int>(profile.points.size()) - 1;
    patch.degree_v = 1;
    for (std::size_t k = 0; k < profile.points.size(); ++k) {
      for (const double y : {0.0, length}) {
        patch.points.emplace_back(profile.points[k].x(), y, profile.points[k].y());
        patch.weights.push_back(profile.weights[k]);
      }
    }
    model.patches.push_back({"", std::move(patch)});
  }
  return model;
}

}  // namespace patchmill::testing
