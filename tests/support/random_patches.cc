// Random patches of every kind (shapes.h).
#include <algorithm>

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

namespace {

// Parameters of the points of a chain: at equal steps between breaks.
std::vector<double> ChainPlaces(int degree, const std::vector<double>& breaks) {
  std::vector<double> places = {0.0};
  for (std::size_t k = 0; k <= breaks.size(); ++k) {
    const double from = k > 0 ? breaks[k - 1] : 0.0, to = k < breaks.size() ? breaks[k] : 1.0;
    for (int i = 1; i <= degree; ++i) places.push_back(from + (to - from) * i / degree);
  }
  return places;
}

}  // namespace

BrownPatch RandomBrown(std::uint64_t seed, int degree_u, int degree_v, double size,
                       const std::vector<double>& breaks_u, const std::vector<double>& breaks_v) {
  Random random(seed);
  BrownPatch patch{degree_u, degree_v, {}, breaks_u, breaks_v};
  const std::vector<double> u = ChainPlaces(degree_u, breaks_u), v = ChainPlaces(degree_v, breaks_v);
  const double move = 0.2 * size / static_cast<double>(std::max(u.size(), v.size()) - 1);
  // A chain from first to last, the points at its breaks such that its derivative runs on.
  const auto chain = [&](const std::vector<double>& t, int degree, bool along_u, double across, bool ends) {
    std::vector<Vec3> row;
    for (std::size_t k = ends ? 0 : 1; k + (ends ? 0 : 1) < t.size(); ++k) {
      row.push_back((along_u ? Vec3(t[k], across, 0.0) : Vec3(across, t[k], 0.0)) * size +
                    random.Point(-move, move));
    }
    for (std::size_t k = static_cast<std::size_t>(degree); k + 1 < t.size();
         k += static_cast<std::size_t>(degree)) {
      const std::size_t i = ends ? k : k - 1;
      const double before = t[k] - t[k - 1], after = t[k + 1] - t[k];
      row[i] = (after * row[i - 1] + before * row[i + 1]) / (before + after);
    }
    patch.points.insert(patch.points.end(), row.begin(), row.end());
  };
  chain(u, degree_u, true, 0, true), chain(u, degree_u, true, 1, true);
  chain(v, degree_v, false, 0, false), chain(v, degree_v, false, 1, false);
  chain(u, degree_u, true, 1 / 3.0, false), chain(u, degree_u, true, 2 / 3.0, false);
  chain(v, degree_v, false, 1 / 3.0, false), chain(v, degree_v, false, 2 / 3.0, false);
  return patch;
}

GregoryTriangle RandomGregoryTriangle(std::uint64_t seed, GregoryPatch::Blend blend, double size) {
  // Places (s, t), in quarters of the side, of the eighteen points.
  constexpr int kPlan[18][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {1, 1}, {4, 0}, {3, 1}, {3, 0}, {2, 1},
                                {2, 1}, {0, 4}, {0, 3}, {1, 3}, {1, 2}, {1, 2}, {2, 0}, {2, 2}, {0, 2}};
  Random random(seed);
  GregoryTriangle patch;
  patch.blend = blend;
  for (std::size_t k = 0; k < 18; ++k) {
    patch.points[k] = size / 4 * Vec3(kPlan[k][0], kPlan[k][1], 0) + random.Point(-0.06 * size, 0.06 * size);
  }
  return patch;
}

LoftTriangle RandomLoftTriangle(std::uint64_t seed, int degree, bool squared, double size) {
  Random random(seed);
  LoftTriangle patch;
  patch.degree = degree;
  patch.squared = squared;
  const Vec3 corner[3] = {Vec3::Zero(), Vec3(size, 0, 0), Vec3(0, size, 0)};
  const double move = 0.2 * size / degree;
  for (const bool rail : {false, true}) {
    for (int e = 0; e < 3; ++e) {
      for (int k = rail ? 1 : 0; k < degree; ++k) {
        const Vec3 p = corner[e] + static_cast<double>(k) / degree * (corner[(e + 1) % 3] - corner[e]);
        patch.points.push_back(p + (rail ? Vec3((corner[(e + 2) % 3] - p) / 3.0) : Vec3(Vec3::Zero())) +
                               random.Point(-move, move));
      }
    }
  }
  return patch;
}

G2GregoryPatch RandomG2Gregory(std::uint64_t seed, int degree, double size) {
  Random random(seed);
  G2GregoryPatch patch;
  patch.degree = degree;
  BezierPatch grid;
  FillGrid(random, degree + 1, degree + 1, false, size, grid);
  patch.points = std::move(grid.points);
  for (const int i : {1, 2, degree - 2, degree - 1}) {
    for (const int j : {1, 2, degree - 2, degree - 1}) {
      patch.points.push_back(patch.points[static_cast<std::size_t>(i * (degree + 1) + j)] +
                             random.Point(-0.1 * size, 0.1 * size));
    }
  }
  return patch;
}

HosakaPatch RandomHosaka(std::uint64_t seed, int degree, bool breaks, bool inner, double size) {
  Random random(seed);
  HosakaPatch patch;
  patch.degree = degree;
  const double move = 0.2 * size / degree;
  const auto add = [&](double u, double v) {
    patch.points.push_back(Vec3(u * size, v * size, 0.0) + random.Point(-move, move));
  };
  for (const double v : {0.0, 1.0}) {
    for (int k = 0; k <= degree; ++k) add(static_cast<double>(k) / degree, v);
  }
  for (const double u : {0.0, 1.0}) {
    for (int k = 1; k < degree; ++k) add(u, static_cast<double>(k) / degree);
  }
  if (breaks) {
    patch.breaks[0] = {{0.45, 0.6}};
    patch.breaks[3] = {{0.3, 0.3}, {0.8, 0.7}};
  }
  if (inner) {
    patch.inner_u = 1;
    patch.inner_v = 2;
    patch.inner_order = 2;
    for (int k = 0; k < 6; ++k) patch.points.push_back(patch.points[0] + random.Point(-size, size));
  }
  return patch;
}

std::vector<PatchShape> BulgedKinds(double size) {
  using enum GregoryPatch::Blend;
  std::vector<PatchShape> kinds = {RandomGregory(1, kCorner, size),
                                   RandomGregory(2, kEdge, size),
                                   RandomBrown(3, 3, 3, size),
                                   RandomBrown(4, 4, 11, size, {0.3, 0.6}, {0.8}),
                                   RandomG2Gregory(5, 5, size),
                                   RandomG2Gregory(6, 7, size),
                                   RandomHosaka(7, 3, false, false, size),
                                   RandomHosaka(8, 4, true, true, size)};
  Random random(9);
  for (PatchShape& shape : kinds) {
    std::visit(
        [&](auto& s) {
          if constexpr (requires { s.bulges; }) {
            s.bulges = {{0.2, 0.8, random.Point(-0.2 * size, 0.2 * size)},
                        {0.9, 0.8, random.Point(-0.2 * size, 0.2 * size)},
                        {0.5, 0.05, random.Point(-0.2 * size, 0.2 * size)}};
          }
        },
        shape);
  }
  return kinds;
}

std::vector<PatchShape> SingularKinds(double size) {
  using enum GregoryPatch::Blend;
  return {RandomBrown(1, 3, 3, size),
          RandomBrown(2, 4, 3, size),
          RandomBrown(3, 5, 11, size),
          RandomGregoryTriangle(4, kCorner, size),
          RandomGregoryTriangle(5, kEdge, size),
          RandomLoftTriangle(6, 3, false, size),
          RandomLoftTriangle(7, 3, true, size),
          RandomLoftTriangle(8, 4, true, size),
          RandomG2Gregory(9, 5, size),
          RandomG2Gregory(10, 6, size),
          RandomG2Gregory(11, 7, size)};
}

}  // namespace patchmill::testing
