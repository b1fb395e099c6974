// Random patches of every kind (shapes.h).
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill::testing {
namespace {

// A grid of count_u x count_v points over [0,size]^2, each moved by up to 0.3 of the larger step.
template <class Shape>
void FillGrid(Random& random, int count_u, int count_v, bool rational, double size, Shape& patch) {
  const double du = size / (count_u - 1), dv = size / (count_v - 1), move = 0.3 * std::max(du, dv);
  for (int i = 0; i < count_u; ++i) {
    for (int j = 0; j < count_v; ++j) {
      patch.points.push_back(Vec3(i * du, j * dv, 0.0) + random.Point(-move, move));
      if (rational) patch.weights.push_back(random.Uniform(0.5, 2.0));
    }
  }
}

std::vector<double> FiveSpans(Random& random, int degree, bool clamped) {
  std::vector<double> knots;
  double t = -3.0;
  for (int i = 0; i <= degree; ++i) knots.push_back(clamped ? t : t += random.Uniform(0.1, 1.1));
  for (int i = 0; i < 4; ++i) {
    t += random.Uniform(0.2, 1.2);
    for (int m = 0; m < (i == 1 ? degree : 1); ++m) knots.push_back(t);
  }
  t += 0.3;
  for (int i = 0; i <= degree; ++i) knots.push_back(clamped ? t : t += random.Uniform(0.1, 1.1));
  return knots;
}

}  // namespace

BezierPatch RandomBezier(std::uint64_t seed, int degree_u, int degree_v, bool rational, double size) {
  Random random(seed);
  BezierPatch patch;
  patch.degree_u = degree_u;
  patch.degree_v = degree_v;
  FillGrid(random, degree_u + 1, degree_v + 1, rational, size, patch);
  return patch;
}

BsplinePatch RandomKnots(std::uint64_t seed, int degree_u, int degree_v, bool rational, double size) {
  Random random(seed);
  BsplinePatch patch;
  patch.degree_u = degree_u;
  patch.degree_v = degree_v;
  patch.knots_u = FiveSpans(random, degree_u, true);
  patch.knots_v = FiveSpans(random, degree_v, false);
  FillGrid(random, static_cast<int>(patch.knots_u.size()) - degree_u - 1,
           static_cast<int>(patch.knots_v.size()) - degree_v - 1, rational, size, patch);
  return patch;
}

GregoryPatch RandomGregory(std::uint64_t seed, GregoryPatch::Blend blend, double size) {
  // Places in the plan, in thirds of the side, of the twenty points.
  constexpr int kPlan[20][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {1, 1}, {3, 0}, {3, 1},
                                {2, 0}, {2, 1}, {2, 1}, {3, 3}, {2, 3}, {3, 2}, {2, 2},
                                {2, 2}, {0, 3}, {0, 2}, {1, 3}, {1, 2}, {1, 2}};
  Random random(seed);
  GregoryPatch patch;
  patch.blend = blend;
  for (int k = 0; k < 20; ++k) {
    const Vec3 place(kPlan[k][0] * size / 3.0, kPlan[k][1] * size / 3.0, 0.0);
    patch.points[k] = place + random.Point(-0.08 * size, 0.08 * size);
  }
  return patch;
}

BezierTriangle RandomTriangle(std::uint64_t seed, int degree, bool rational, double size) {
  Random random(seed);
  BezierTriangle patch;
  patch.degree = degree;
  for (int r = 0; r <= degree; ++r) {
    for (int k = 0; k <= degree - r; ++k) {
      patch.points.push_back(Vec3(k * size / degree, r * size / degree, 0.0) +
                             random.Point(-0.1 * size, 0.1 * size) / degree);
      if (rational) patch.weights.push_back(random.Uniform(0.5, 2.0));
    }
  }
  return patch;
}

}  // namespace patchmill::testing
