#include "tests/support/shapes.h"

#include <cmath>

namespace patchmill::testing {
namespace {

const double kDiagonal = std::sqrt(0.5);  // weight of the middle point of a quarter circle

// Points and weights of the quarter circle k (from angle k 90 deg on) of the unit circle.
struct QuarterCircle {
  Vec2 points[3];
  double weights[3] = {1.0, kDiagonal, 1.0};
  explicit QuarterCircle(int k) {
    const Vec2 turn[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    const Vec2 a = turn[((k % 4) + 4) % 4], b = turn[(((k + 1) % 4) + 4) % 4];
    points[0] = a;
    points[1] = a + b;
    points[2] = b;
  }
};

// The profile (distance from the axis, height), a quarter circle of `radius` around (offset, 0), turned about
// z.
BezierPatch Revolved(int around, int profile, double offset, double radius) {
  const QuarterCircle turn(around), section(profile);
  BezierPatch patch;
  patch.degree_u = patch.degree_v = 2;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double r = offset + radius * section.points[j].x();
      patch.points.push_back(Lift(r * turn.points[i], radius * section.points[j].y()));
      patch.weights.push_back(turn.weights[i] * section.weights[j]);
    }
  }
  return patch;
}

void Add(PatchModel& model, PatchShape shape) { model.patches.push_back(Patch{"", std::move(shape)}); }

PatchModel MovedTo(PatchModel model, const Vec3& center) {
  return Transformed(std::move(model), Eigen::Affine3d(Eigen::Translation3d(center)));
}

}  // namespace

PatchModel Single(PatchShape shape) {
  PatchModel model;
  Add(model, std::move(shape));
  return model;
}

PatchModel Join(std::initializer_list<PatchModel> models) {
  PatchModel all;
  for (const PatchModel& model : models) {
    all.patches.insert(all.patches.end(), model.patches.begin(), model.patches.end());
  }
  return all;
}

PatchModel Transformed(PatchModel model, const Eigen::Affine3d& motion) {
  for (Patch& patch : model.patches) {
    std::visit(
        [&](auto& shape) {
          for (Vec3& p : shape.points) p = motion * p;
          if constexpr (requires { shape.bulges; }) {
            for (Bulge& b : shape.bulges) b.by = motion.linear() * b.by;
          }
        },
        patch.shape);
  }
  return model;
}

PatchShape Bilinear(const Vec3& p00, const Vec3& p10, const Vec3& p01, const Vec3& p11) {
  BezierPatch patch;
  patch.degree_u = patch.degree_v = 1;
  patch.points = {p00, p01, p10, p11};
  return patch;
}

PatchModel Plane(double half, double z0, double slope_x, double slope_y) {
  const auto at = [&](double x, double y) { return Vec3(x, y, z0 + slope_x * x + slope_y * y); };
  return Single(Bilinear(at(-half, -half), at(half, -half), at(-half, half), at(half, half)));
}

PatchModel TwoPlanes(double angle, double half) {
  const auto at = [&](double x, double y) { return Vec3(x, y, std::abs(x) * std::tan(angle)); };
  PatchModel model;
  Add(model, Bilinear(at(-half, -half), at(0, -half), at(-half, half), at(0, half)));
  Add(model, Bilinear(at(0, -half), at(half, -half), at(0, half), at(half, half)));
  return model;
}

PatchModel Block(double block_half, double height, double floor_half) {
  const double cut[4] = {-floor_half, -block_half, block_half, floor_half};
  PatchModel model;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double z = i == 1 && j == 1 ? height : 0.0;
      Add(model, Bilinear({cut[i], cut[j], z}, {cut[i + 1], cut[j], z}, {cut[i], cut[j + 1], z},
                          {cut[i + 1], cut[j + 1], z}));
    }
  }
  const Vec2 corner[4] = {{-block_half, -block_half},
                          {block_half, -block_half},
                          {block_half, block_half},
                          {-block_half, block_half}};
  for (int k = 0; k < 4; ++k) {
    const Vec2 &a = corner[k], &b = corner[(k + 1) % 4];
    Add(model, Bilinear(Lift(a, 0), Lift(b, 0), Lift(a, height), Lift(b, height)));
  }
  return model;
}

PatchModel Sphere(const Vec3& center, double radius, Half half) {
  PatchModel model;
  for (int profile = half == Half::kUpper ? 0 : -1; profile <= 0; ++profile) {
    for (int around = 0; around < 4; ++around) Add(model, Revolved(around, profile, 0.0, radius));
  }
  return MovedTo(std::move(model), center);
}

PatchModel Cylinder(const Vec3& center, double radius, double half_length, Half half) {
  PatchModel model;
  for (int k = 0; k < (half == Half::kUpper ? 2 : 4); ++k) {
    const QuarterCircle section(k);  // of the (z,x) plane from +x upwards: x = cos, z = sin
    BezierPatch patch;
    patch.degree_u = 1;
    patch.degree_v = 2;
    for (const double y : {-half_length, half_length}) {
      for (int j = 0; j < 3; ++j) {
        patch.points.emplace_back(radius * section.points[j].x(), y, radius * section.points[j].y());
        patch.weights.push_back(section.weights[j]);
      }
    }
    Add(model, std::move(patch));
  }
  return MovedTo(std::move(model), center);
}

PatchModel Torus(const Vec3& center, double major, double minor, Half half) {
  PatchModel model;
  for (int profile = 0; profile < (half == Half::kUpper ? 2 : 4); ++profile) {
    for (int around = 0; around < 4; ++around) Add(model, Revolved(around, profile, major, minor));
  }
  return MovedTo(std::move(model), center);
}

PatchModel TwoSpheres(double radius, double distance) {
  return Join({Sphere({-0.5 * distance, 0, 0}, radius, Half::kUpper),
               Sphere({0.5 * distance, 0, 0}, radius, Half::kUpper)});
}

PatchModel Quadratic(double a, double b, double half) {
  // x^2 over [-half,half] has the Bernstein coefficients half^2 (1, -1, 1).
  const double at[3] = {-half, 0, half}, square[3] = {half * half, -half * half, half * half};
  BezierPatch patch;
  patch.degree_u = patch.degree_v = 2;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) patch.points.emplace_back(at[i], at[j], a * square[i] + b * square[j]);
  }
  return Single(std::move(patch));
}

PatchModel Saddle(double a, double b, double half) { return Quadratic(a, -b, half); }
PatchModel Paraboloid(double a, double half) { return Quadratic(a, a, half); }
PatchModel ParabolicValley(double a, double half) { return Quadratic(a, 0.0, half); }

}  // namespace patchmill::testing
