#include "tests/support/known_surfaces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/index.h"
#include "core/base/status.h"
#include "core/curve/spline.h"
#include "core/math/bernstein.h"
#include "tests/support/random.h"

namespace patchmill::testing {
namespace {

constexpr double kPi = std::numbers::pi;

// The derivative at 0 by six places around it. Exact for polynomials up to degree six.
template <class F>
Vec3 Slope(const F& f, double h = 5e-3) {
  return (45.0 * (f(h) - f(-h)) - 9.0 * (f(2 * h) - f(-2 * h)) + (f(3 * h) - f(-3 * h))) / (60.0 * h);
}
template <class F>
Vec3 Bend(const F& f, double h = 2e-2) {
  return (270.0 * (f(h) + f(-h)) - 27.0 * (f(2 * h) + f(-2 * h)) + 2.0 * (f(3 * h) + f(-3 * h)) -
          490.0 * f(0)) /
         (180.0 * h * h);
}

Vec3 AlongU(const KnownSurface& s, double u, double v) {
  return Slope([&](double h) { return s(u + h, v); });
}
Vec3 AlongV(const KnownSurface& s, double u, double v) {
  return Slope([&](double h) { return s(u, v + h); });
}

// The distance of `p` from the surface: Gauss-Newton steps from the parameters of its image.
double DistanceFrom(const KnownSurface& s, const Vec3& p, Vec2 at) {
  for (int k = 0; k < 12; ++k) {
    Eigen::Matrix<double, 3, 2> j;
    j << AlongU(s, at.x(), at.y()), AlongV(s, at.x(), at.y());
    const Vec2 step = (j.transpose() * j).ldlt().solve(j.transpose() * (p - s(at.x(), at.y())));
    at += step;
    if (step.norm() < 1e-12) break;
  }
  return (p - s(at.x(), at.y())).norm();
}

std::vector<double> Spans(const std::vector<double>& at) {
  std::vector<double> spans;
  for (std::size_t i = 0; i + 1 < at.size(); ++i) spans.push_back(at[i + 1] - at[i]);
  return spans;
}

std::vector<double> Even(double from, double to, int spans) {
  std::vector<double> at;
  for (int i = 0; i <= spans; ++i) at.push_back(from + (to - from) * i / spans);
  return at;
}

// The curve of `edge` as it leaves `vertex` into a face: derivatives at that vertex.
CurveJet Leaving(const JoinedEdge& edge, int vertex) {
  CurveJet jet = Evaluate(edge.curve, edge.topology.start == vertex ? 0.0 : 1.0);
  if (edge.topology.start != vertex) jet.d = -jet.d;
  return jet;
}

const JoinedEdge& EdgeBetween(const JoinedNetwork& joined, int a, int b) {
  const auto at = std::ranges::find_if(joined.edges, [&](const JoinedEdge& e) {
    return std::minmax(e.topology.start, e.topology.end) == std::minmax(a, b);
  });
  PM_CHECK(at != joined.edges.end());
  return *at;
}

Vec3 Across(const Vec3& first, const Vec3& second) {
  return (second - first * (first.dot(second) / first.squaredNorm())) / first.squaredNorm();
}

// The vectors of both sides are laid into one direction and get one bend.
void Agree(CrossControl& a, CrossControl& b) {
  const double la = a.first->norm(), lb = b.first->norm();
  const Vec3 direction = (*b.first - *a.first).normalized();
  const Vec3 bends[2] = {Across(-la * direction, *a.second), Across(lb * direction, *b.second)};
  const Vec3 bend = 0.5 * (bends[0] + bends[1]);
  const auto set = [&](CrossControl& c, double length) {
    c.first = length * direction;
    c.second = direction * direction.dot(*c.second) + bend * length * length;
  };
  set(a, -la), set(b, lb);
}

double Hill(double x, double y) { return 20.0 * std::exp(-(x * x + y * y) / 1200.0); }

}  // namespace

KnownNetwork KnownGrid(std::string name, KnownSurface surface, const std::vector<double>& us,
                       const std::vector<double>& vs) {
  KnownNetwork known{std::move(name), std::move(surface), {}, {}};
  const KnownSurface& s = known.surface;
  const int nu = static_cast<int>(us.size()), nv = static_cast<int>(vs.size());
  const auto id = [nv](int i, int j) { return i * nv + j; };
  for (const double u : us) {
    for (const double v : vs) {
      NetworkVertex vertex;
      vertex.position = s(u, v);
      known.network.vertices.push_back(vertex);
    }
  }
  const auto add = [&](const std::vector<int>& line, const std::vector<double>& at, const SplineEnds& ends) {
    std::vector<Vec3> points;
    for (const int v : line) points.push_back(known.network.vertices[At(v)].position);
    const auto curves = SplineOver(points, Spans(at), ends);
    for (std::size_t k = 0; k < curves.size(); ++k) {
      known.network.edges.push_back({"", line[k], line[k + 1], CurveEdge{curves[k]}, false, {}});
    }
  };
  for (int i = 0; i < nu; ++i) {
    std::vector<int> line;
    for (int j = 0; j < nv; ++j) line.push_back(id(i, j));
    add(line, vs, {AlongV(s, us[At(i)], vs.front()), AlongV(s, us[At(i)], vs.back())});
  }
  for (int j = 0; j < nv; ++j) {
    std::vector<int> line;
    for (int i = 0; i < nu; ++i) line.push_back(id(i, j));
    add(line, us, {AlongU(s, us.front(), vs[At(j)]), AlongU(s, us.back(), vs[At(j)])});
  }
  for (int i = 0; i + 1 < nu; ++i) {
    for (int j = 0; j + 1 < nv; ++j) {
      known.network.faces.push_back(
          {"", {id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)}, PatchScheme::kG2Gregory});
      const double u0 = us[At(i)], u1 = us[At(i + 1)], v0 = vs[At(j)], v1 = vs[At(j + 1)];
      known.corners.push_back({Vec2(u0, v0), Vec2(u1, v0), Vec2(u1, v1), Vec2(u0, v1)});
    }
  }
  return known;
}

KnownSurface RandomBicubic(unsigned seed, double move) {
  Random random(seed);
  std::array<std::array<Vec3, 4>, 4> net;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      net[At(i)][At(j)] = Vec3(100.0 * i / 3.0, 100.0 * j / 3.0, 0.0) + random.Point(-move, move);
    }
  }
  return [net](double u, double v) {
    Vec3 p = Vec3::Zero();
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const auto b = [](int k, double t) {
          return Binomial(3, k) * std::pow(t, k) * std::pow(1.0 - t, 3 - k);
        };
        p += b(i, u) * b(j, v) * net[At(i)][At(j)];
      }
    }
    return p;
  };
}

KnownNetwork KnownStar(std::string name, int sectors) {
  constexpr int m = 2;  // faces along a spoke
  KnownNetwork known;
  known.name = std::move(name);
  known.surface = [](double x, double y) { return Vec3(x, y, Hill(x, y)); };
  const auto add = [&](const Vec2& p) {
    NetworkVertex vertex;
    vertex.position = known.surface(p.x(), p.y());
    known.network.vertices.push_back(vertex);
    return static_cast<int>(known.network.vertices.size()) - 1;
  };
  const auto ray = [&](int k) {
    const double angle = 2.0 * kPi * k / sectors;
    return Vec2(15.0 * std::cos(angle), 15.0 * std::sin(angle));
  };
  const int centre = add(Vec2::Zero());
  std::vector<std::array<std::array<int, m + 1>, m + 1>> at(At(sectors));  // at[k][i][j]: i along spoke k
  for (int k = 0; k < sectors; ++k) {
    at[At(k)][0][0] = centre;
    for (int i = 1; i <= m; ++i) {
      for (int j = 0; j <= m; ++j) at[At(k)][At(i)][At(j)] = add(i * ray(k) + j * ray(k + 1));
    }
  }
  for (int k = 0; k < sectors; ++k) {
    for (int j = 1; j <= m; ++j) at[At(k)][0][At(j)] = at[At((k + 1) % sectors)][At(j)][0];
  }
  const auto line = [&](const std::vector<int>& through) {
    std::vector<Vec3> points;
    for (const int v : through) points.push_back(known.network.vertices[At(v)].position);
    const auto along = [&](const Vec3& p, const Vec3& chord) {
      const Vec2 d = chord.head<2>().normalized();
      return Slope([&](double h) { return known.surface(p.x() + h * d.x(), p.y() + h * d.y()); })
          .normalized();
    };
    const std::size_t n = points.size();
    const auto curves = *SplineThrough(
        points, false,
        {along(points[0], points[1] - points[0]), along(points[n - 1], points[n - 1] - points[n - 2])});
    for (std::size_t k = 0; k < curves.size(); ++k) {
      known.network.edges.push_back({"", through[k], through[k + 1], CurveEdge{curves[k]}, false, {}});
    }
  };
  for (int k = 0; k < sectors; ++k) {
    const auto &here = at[At(k)], &before = at[At((k + sectors - 1) % sectors)];
    std::vector<int> spoke;
    for (int i = 0; i <= m; ++i) spoke.push_back(here[At(i)][0]);
    line(spoke);
    for (int i = 1; i <= m; ++i) {  // across spoke k
      std::vector<int> across;
      for (int j = m; j >= 0; --j) across.push_back(before[At(j)][At(i)]);
      for (int j = 1; j <= m; ++j) across.push_back(here[At(i)][At(j)]);
      line(across);
    }
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < m; ++j) {
        const std::array<int, 4> loop = {here[At(i)][At(j)], here[At(i + 1)][At(j)],
                                         here[At(i + 1)][At(j + 1)], here[At(i)][At(j + 1)]};
        known.network.faces.push_back({"", {loop.begin(), loop.end()}, PatchScheme::kG2Gregory});
        std::array<Vec2, 4> corners;
        for (int c = 0; c < 4; ++c) {
          corners[At(c)] = known.network.vertices[At(loop[At(c)])].position.head<2>();
        }
        known.corners.push_back(corners);
      }
    }
  }
  return known;
}

KnownSurface WithoutHiddenPart(const KnownSurface& bicubic) {
  // The coefficient of u^3 v^3, by third differences in both directions.
  Vec3 coefficient = Vec3::Zero();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const double sign = (i + j) % 2 == 0 ? 1.0 : -1.0;
      coefficient += sign * Binomial(3, i) * Binomial(3, j) * bicubic(i / 3.0, j / 3.0);
    }
  }
  coefficient *= std::pow(27.0 / 6.0, 2);
  return [=](double u, double v) { return Vec3(bicubic(u, v) - HiddenPart(u, v) * coefficient); };
}

double HiddenPart(double u, double v) { return u * (u - 0.5) * (u - 1.0) * v * (v - 0.5) * (v - 1.0); }

KnownNetwork KnownBicubic() {
  return KnownGrid("bicubic, 2 x 2", WithoutHiddenPart(RandomBicubic(46, 3.5)), {0, 0.5, 1}, {0, 0.5, 1});
}

std::vector<KnownNetwork> KnownSurfaces() {
  const auto height = [](auto z) { return [z](double x, double y) { return Vec3(x, y, z(x, y)); }; };
  const auto torus = [](double u, double v) {
    const double r = 60.0 + 25.0 * std::cos(v);
    return Vec3(r * std::cos(u), r * std::sin(u), 25.0 * std::sin(v));
  };
  const auto sphere = [](double u, double v) {
    return Vec3(50.0 * std::cos(v) * std::cos(u), 50.0 * std::cos(v) * std::sin(u), 50.0 * std::sin(v));
  };
  const auto cap = [](double x, double y) { return std::sqrt(80.0 * 80.0 - x * x - y * y); };
  const auto waves = [](double x, double y) { return 8.0 * std::sin(0.06 * x) * std::cos(0.05 * y); };
  const auto skewed = [=](double u, double v) {  // over a quadrilateral of four different sides
    const double x = -35.0 + 75.0 * u + 12.0 * v - 18.0 * u * v,
                 y = -30.0 + 8.0 * u + 55.0 * v + 14.0 * u * v;
    return Vec3(x, y, cap(x, y));
  };
  std::vector<KnownNetwork> list;
  const auto add = [&](std::string name, KnownSurface s, const std::vector<double>& us,
                       const std::vector<double>& vs) {
    list.push_back(KnownGrid(std::move(name), std::move(s), us, vs));
  };
  add("bicubic, 3 x 3", RandomBicubic(1, 4.0), Even(0, 1, 3), Even(0, 1, 3));
  add("bicubic, 3 x 4 uneven", RandomBicubic(2, 4.0), {0, 0.2, 0.65, 1}, {0, 0.3, 0.45, 0.8, 1});
  add("bicubic, 4 x 3, steeper", RandomBicubic(3, 12.0), Even(0, 1, 4), Even(0, 1, 3));
  add("paraboloid", height([](double x, double y) { return (x * x + y * y) / 60.0; }), Even(-40, 40, 2),
      Even(-40, 40, 2));
  add("saddle, uneven",
      height([](double x, double y) { return (x * x - 0.7 * y * y) / 60.0 + x * y / 90.0; }),
      {-40, -25, 5, 40}, {-30, 10, 40});
  add("monkey saddle", height([](double x, double y) { return (x * x * x - 3.0 * x * y * y) / 12000.0; }),
      Even(-40, 40, 3), Even(-40, 40, 3));
  add("torus, outside", torus, Even(0, 0.5 * kPi, 5), Even(-0.4 * kPi, 0.4 * kPi, 5));
  add("torus, inside", torus, Even(0, 0.75 * kPi, 5), Even(0.6 * kPi, 1.4 * kPi, 5));
  add("sphere cap", height(cap), Even(-40, 40, 5), Even(-40, 40, 5));
  add("sphere zone", sphere, Even(0, 0.6 * kPi, 4), Even(-0.2, 0.25 * kPi, 4));
  add("sinusoids", height(waves), Even(-60, 60, 9), Even(-60, 60, 8));
  add("sinusoids, uneven", height(waves), {-60, -48, -33, -15, -5, 5, 21, 40, 60},
      {-50, -35, -17, 0, 5, 17, 30, 45, 60});
  add(
      "cylinder", [](double u, double v) { return Vec3(40 * std::cos(u), v, 40 * std::sin(u)); },
      Even(0.2, 2.4, 3), Even(0, 80, 2));
  add("cone", [](double u, double v) { return Vec3((60 - v) * std::cos(u), (60 - v) * std::sin(u), v); },
      Even(0, 2.0, 3), {0, 25, 40});
  add("translation surface",
      [](double u, double v) {
        return Vec3(u + 5.0 * std::cos(0.06 * v), v + 3.0 * std::sin(0.05 * u),
                    8.0 * std::sin(0.07 * u) + v * v / 70.0);
      },
      Even(0, 90, 6), {0, 15, 33, 45, 60});
  add(
      "surface of revolution",
      [](double u, double v) {
        const double r = 40.0 + 8.0 * std::sin(0.08 * v);
        return Vec3(r * std::cos(u), r * std::sin(u), v);
      },
      Even(0, 1.8, 4), Even(0, 90, 9));
  add("helicoid", [](double u, double v) { return Vec3(v * std::cos(u), v * std::sin(u), 20.0 * u); },
      Even(0, 2.0, 3), {15, 30, 60});
  add("sphere cap, skewed grid", skewed, Even(0, 1, 5), {0, 0.2, 0.35, 0.6, 0.75, 1});
  list.push_back(KnownStar("hill, vertex of three", 3));
  list.push_back(KnownStar("hill, vertex of five", 5));
  return list;
}

CrossControl MeanControl(const CurveNetwork& network, const JoinedNetwork& joined, const FaceSide& s) {
  const auto& loop = network.faces[At(s.face)].vertices;
  const int a = loop[At(s.side)], b = loop[At((s.side + 1) % 4)];
  const int before = loop[At((s.side + 3) % 4)], after = loop[At((s.side + 2) % 4)];
  const CurveJet from = Leaving(EdgeBetween(joined, a, before), a),
                 to = Leaving(EdgeBetween(joined, b, after), b);
  return {a, b, s.face, 0.5 * (from.d + to.d), 0.5 * (from.dd + to.dd)};
}

CurveNetwork WithMeans(const KnownNetwork& known) {
  const JoinedNetwork joined = JoinNetwork(known.network);
  CurveNetwork network = known.network;
  for (const JoinedEdge& edge : joined.edges) {
    const auto& sides = edge.topology.faces;
    if (sides.size() == 2 && !edge.equal_curvature) continue;  // it takes no control
    std::vector<CrossControl> means;
    for (const FaceSide& s : sides) means.push_back(MeanControl(known.network, joined, s));
    if (means.size() == 2) Agree(means[0], means[1]);
    network.controls.insert(network.controls.end(), means.begin(), means.end());
  }
  return network;
}

CurveNetwork WithTruth(const KnownNetwork& known) {
  const JoinedNetwork joined = JoinNetwork(known.network);
  CurveNetwork network = known.network;
  for (const JoinedEdge& edge : joined.edges) {
    std::vector<CrossControl> truth;
    for (const FaceSide& s : edge.topology.faces) {
      const auto& at = known.corners[At(s.face)];
      const auto& loop = known.network.faces[At(s.face)].vertices;
      const Vec2 from = at[At(s.side)], to = at[At((s.side + 1) % 4)], middle = 0.5 * (from + to);
      const Vec2 inward = at[At((s.side + 3) % 4)] - from;
      const auto section = [&](double h) {
        return known.surface(middle.x() + h * inward.x(), middle.y() + h * inward.y());
      };
      truth.push_back({loop[At(s.side)], loop[At((s.side + 1) % 4)], s.face, Slope(section), Bend(section)});
    }
    if (truth.size() == 2) Agree(truth[0], truth[1]);
    network.controls.insert(network.controls.end(), truth.begin(), truth.end());
  }
  return network;
}

double LargestError(const KnownNetwork& known, const JoinedNetwork& joined, int samples) {
  PM_CHECK(joined.model.patches.size() == known.corners.size());
  double largest = 0.0;
  for (std::size_t f = 0; f < known.corners.size(); ++f) {
    const auto& at = known.corners[f];
    for (int i = 0; i < samples; ++i) {
      for (int j = 0; j < samples; ++j) {
        const double u = static_cast<double>(i) / (samples - 1), v = static_cast<double>(j) / (samples - 1);
        const Vec2 guess =
            (1 - u) * (1 - v) * at[0] + u * (1 - v) * at[1] + u * v * at[2] + (1 - u) * v * at[3];
        const Vec3 p = Evaluate(joined.model.patches[f].shape, u, v).p;
        largest = std::max(largest, DistanceFrom(known.surface, p, guess));
      }
    }
  }
  return largest;
}

}  // namespace patchmill::testing
