#include "core/trim/carrier_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include "core/math/bernstein.h"

namespace patchmill {
namespace {

constexpr double kQuarter = kPi / 2.0;
constexpr int kMaxQuarters = 64;  // a helical face of sixteen turns; files give a turn or two

// A point of a quarter arc about the origin in homogeneous coordinates (w a, w b, w).
struct ArcPoint {
  double a = 0.0, b = 0.0, w = 1.0;
};
// The three points of the arc from k to k + 1 quarter turns. No trigonometric function takes part, whose last
// bit differs between machines.
std::array<ArcPoint, 3> QuarterArc(int k) {
  static constexpr std::array<double, 4> kCos = {1.0, 0.0, -1.0, 0.0}, kSin = {0.0, 1.0, 0.0, -1.0};
  const auto from_turn = static_cast<std::size_t>((k % 4 + 4) % 4), to_turn = (from_turn + 1) % 4;
  const Vec2 from(kCos[from_turn], kSin[from_turn]), to(kCos[to_turn], kSin[to_turn]);
  const double w = std::numbers::sqrt2 / 2.0;
  return {{{from.x(), from.y(), 1.0},
           {w * (from.x() + to.x()), w * (from.y() + to.y()), w},
           {to.x(), to.y(), 1.0}}};
}

GridAxis QuarterAxis(double lowest, double highest) {
  const double slack = 1e-9;
  const double first = std::floor(lowest / kQuarter + slack);
  const double last = std::max(std::ceil(highest / kQuarter - slack), first + 1.0);
  GridAxis axis;
  axis.angle = true;
  const int count = static_cast<int>(std::min(last - first, static_cast<double>(kMaxQuarters)));
  for (int k = 0; k <= count; ++k) axis.breaks.push_back((first + k) * kQuarter);
  return axis;
}
int QuarterOf(const GridAxis& axis, int i) {
  return static_cast<int>(std::lround(axis.breaks[static_cast<std::size_t>(i)] / kQuarter));
}

// A little beyond the range, so that edges beside it have their foot inside.
GridAxis StraightAxis(double lowest, double highest) {
  const double margin = 0.01 * std::max(highest - lowest, 1e-6);
  return {{lowest - margin, highest + margin}, false};
}

// A meridian in homogeneous coordinates: distance from the axis, height along it, weight.
using Meridian = std::vector<ArcPoint>;

// The surface that the meridian sweeps in the quarter k about the frame's z axis.
Piece Swept(const BrepFrame& frame, int k, const Meridian& meridian) {
  Piece piece;
  piece.net.degree_u = 2;
  piece.net.degree_v = static_cast<int>(meridian.size()) - 1;
  piece.net.rational = true;
  for (const ArcPoint& turn : QuarterArc(k)) {
    for (const ArcPoint& m : meridian) {
      const Vec3 p =
          m.a * (turn.a * frame.x + turn.b * frame.y) + turn.w * (m.b * frame.z + m.w * frame.origin);
      piece.net.points.push_back({p.x(), p.y(), p.z(), turn.w * m.w});
    }
  }
  return piece;
}

struct Grids {
  Vec2 lowest, highest;

  CarrierGrid Turned(const BrepFrame& frame, GridAxis v, const std::vector<Meridian>& meridians) const {
    CarrierGrid grid;
    grid.u = QuarterAxis(lowest.x(), highest.x());
    grid.v = std::move(v);
    for (int i = 0; i < grid.u.count(); ++i) {
      for (const Meridian& m : meridians) grid.carriers.push_back(Swept(frame, QuarterOf(grid.u, i), m));
    }
    return grid;
  }

  CarrierGrid operator()(const BrepPlane& plane) const {
    CarrierGrid grid;
    grid.u = StraightAxis(lowest.x(), highest.x());
    grid.v = StraightAxis(lowest.y(), highest.y());
    Piece piece;
    piece.net.degree_u = piece.net.degree_v = 1;
    for (const double u : grid.u.breaks) {
      for (const double v : grid.v.breaks) {
        const Vec3 p = plane.frame.origin + u * plane.frame.x + v * plane.frame.y;
        piece.net.points.push_back({p.x(), p.y(), p.z(), 1.0});
      }
    }
    grid.carriers.push_back(std::move(piece));
    return grid;
  }
  CarrierGrid operator()(const BrepCylinder& cylinder) const {
    const GridAxis v = StraightAxis(lowest.y(), highest.y());
    const Meridian m = {{cylinder.radius, v.breaks[0], 1.0}, {cylinder.radius, v.breaks[1], 1.0}};
    return Turned(cylinder.frame, v, {m});
  }
  CarrierGrid operator()(const BrepCone& cone) const {
    GridAxis v = StraightAxis(lowest.y(), highest.y());
    const double s = std::sin(cone.half_angle), c = std::cos(cone.half_angle);
    const double apex = -cone.radius / s;
    // The apex belongs to the side on which most of the face lies.
    if (apex <= 0.5 * (lowest.y() + highest.y())) {
      v.breaks[0] = std::max(v.breaks[0], apex);
    } else {
      v.breaks[1] = std::min(v.breaks[1], apex);
    }
    Meridian m;
    for (const double at : v.breaks) m.push_back({at == apex ? 0.0 : cone.radius + at * s, at * c, 1.0});
    return Turned(cone.frame, v, {m});
  }
  CarrierGrid operator()(const BrepSphere& sphere) const {
    const GridAxis v{{-kQuarter, 0.0, kQuarter}, true};
    return Turned(sphere.frame, v, {Arc(-1, 0.0, sphere.radius), Arc(0, 0.0, sphere.radius)});
  }
  CarrierGrid operator()(const BrepTorus& torus) const {
    const GridAxis v = QuarterAxis(lowest.y(), highest.y());
    std::vector<Meridian> meridians;
    for (int j = 0; j < v.count(); ++j) meridians.push_back(Arc(QuarterOf(v, j), torus.major, torus.minor));
    return Turned(torus.frame, v, meridians);
  }
  CarrierGrid operator()(const BrepSpline& spline) const {
    const PatchShape shape = spline.patch;
    CarrierGrid grid;
    grid.carriers = SplitIntoPieces(PatchId(0), shape);
    const auto axis = [](const std::vector<double>& knots, int degree) {
      GridAxis a;
      a.breaks.assign(knots.begin() + degree, knots.end() - degree);
      a.breaks.erase(std::unique(a.breaks.begin(), a.breaks.end()), a.breaks.end());
      return a;
    };
    grid.u = axis(spline.patch.knots_u, spline.patch.degree_u);
    grid.v = axis(spline.patch.knots_v, spline.patch.degree_v);
    return grid;
  }

  static Meridian Arc(int quarter, double center, double radius) {
    Meridian m;
    for (const ArcPoint& p : QuarterArc(quarter))
      m.push_back({p.w * center + radius * p.a, radius * p.b, p.w});
    return m;
  }
};

double AxisCoordinate(const GridAxis& axis, double parameter) {
  const auto after = std::upper_bound(axis.breaks.begin() + 1, axis.breaks.end() - 1, parameter);
  const double from = *(after - 1), to = *after;
  const auto i = static_cast<double>(after - axis.breaks.begin() - 1);
  const double part = std::clamp((parameter - from) / (to - from), 0.0, 1.0);
  if (!axis.angle) return i + part;
  const double near = std::sin(part * kQuarter / 2.0), far = std::sin((1.0 - part) * kQuarter / 2.0);
  return i + near / (near + far);
}

}  // namespace

CarrierGrid CarriersOf(const BrepSurface& surface, const Vec2& lowest, const Vec2& highest) {
  CarrierGrid grid = std::visit(Grids{lowest, highest}, surface);
  Box3 box;
  for (const Piece& piece : grid.carriers) {
    for (const Vec4& p : piece.net.points) {
      if (p.w() > 0.0) box.Add(Vec3(p.head<3>() / p.w()));
    }
  }
  grid.size = box.Diagonal();
  return grid;
}

Vec2 GridCoordinates(const CarrierGrid& grid, const Vec2& parameters) {
  return {AxisCoordinate(grid.u, parameters.x()), AxisCoordinate(grid.v, parameters.y())};
}

GridCell CellAt(const CarrierGrid& grid, const Vec2& at) {
  return {std::clamp(static_cast<int>(std::floor(at.x())), 0, grid.u.count() - 1),
          std::clamp(static_cast<int>(std::floor(at.y())), 0, grid.v.count() - 1)};
}

SurfaceJet JetAt(const CarrierGrid& grid, GridCell cell, const Vec2& at) {
  return Evaluate(grid.carrier(cell.i, cell.j), at.x() - cell.i, at.y() - cell.j);
}

Vec3 PositionAt(const CarrierGrid& grid, const Vec2& at) {
  const GridCell cell = CellAt(grid, at);
  return Position(grid.carrier(cell.i, cell.j), at.x() - cell.i, at.y() - cell.j);
}

namespace {

// Where neither parameter moves the place, a foot is moved by this share of the way to the middle of its
// rectangle.
constexpr double kNudge = 1e-3;

// FootOnGrid, where a parameter that moves the place by less than the root of `damping` of the other one
// hardly moves.
std::optional<GridFoot> DampedFoot(const CarrierGrid& grid, const Vec3& place, const Vec2& start,
                                   double damping) {
  Vec2 at = start;
  GridCell cell = CellAt(grid, at);
  int moves = 0, nudges = 0;
  double last_step = kInfinity, last_way = kInfinity;  // mm: by parameters, and of the place itself
  for (int round = 0; round < 60; ++round) {
    const SurfaceJet jet = JetAt(grid, cell, at);
    const Vec3 off = place - jet.p;
    const double uu = jet.du.squaredNorm(), vv = jet.dv.squaredNorm(), uv = jet.du.dot(jet.dv);
    Eigen::Matrix2d h;
    h << uu - off.dot(jet.duu), uv - off.dot(jet.duv), uv - off.dot(jet.duv), vv - off.dot(jet.dvv);
    // Newton's matrix where it is definite, else that of Gauss and Newton.
    if (!(h(0, 0) > 0.0 && h(1, 1) > 0.0 && h.determinant() > 1e-3 * uu * vv)) h << uu, uv, uv, vv;
    h(0, 0) += 1e-13 * uu + damping * vv + 1e-300;
    h(1, 1) += 1e-13 * vv + damping * uu + 1e-300;
    const Vec2 slope(off.dot(jet.du), off.dot(jet.dv));
    Vec2 step = h.inverse() * slope;
    if (uu + vv <= 1e-24 * grid.size * grid.size || !step.allFinite()) {
      // Neither parameter moves the place here, as in the corner of a strip between a border and the
      // line that touches it. That holds in the corner only.
      if (off.norm() <= 1e-12 * grid.size) return GridFoot{at, jet.p, off.norm()};
      if (nudges++ > 2) return std::nullopt;
      at += kNudge * (Vec2(cell.i + 0.5, cell.j + 0.5) - at);
      continue;
    }
    // At the border of the grid, and on the way out of it, only the other coordinate moves.
    const auto leaves = [](double x, double dx, int count) {
      return (x <= 0.0 && dx < 0.0) || (x >= count && dx > 0.0);
    };
    const bool out_u = leaves(at.x(), step.x(), grid.u.count()),
               out_v = leaves(at.y(), step.y(), grid.v.count());
    if (out_u) step = {0.0, out_v ? 0.0 : slope.y() / h(1, 1)};
    if (out_v && !out_u) step = {slope.x() / h(0, 0), 0.0};
    const double most = step.cwiseAbs().maxCoeff();
    if (most > 0.5) step *= 0.5 / most;
    Vec2 next = at + step;
    // Beyond the carrier, the search goes on in the next one, from the line between them.
    GridCell to = cell;
    const auto follow = [&moves](double& x, int& i, int count) {
      if (x < i) {
        if (i > 0 && moves < 8 + 2 * count) {
          x = std::max(x, i - 0.25);
          --i;
          ++moves;
        } else {
          x = i;
        }
      } else if (x > i + 1) {
        if (i + 1 < count && moves < 8 + 2 * count) {
          x = std::min(x, i + 1.25);
          ++i;
          ++moves;
        } else {
          x = i + 1;
        }
      }
    };
    follow(next.x(), to.i, grid.u.count());
    follow(next.y(), to.j, grid.v.count());
    const Vec2 moved = next - at;
    const double length = std::abs(moved.x()) * jet.du.norm() + std::abs(moved.y()) * jet.dv.norm();
    const bool same_cell = to.i == cell.i && to.j == cell.j;
    const GridCell from = cell;
    at = next;
    cell = to;
    const bool at_line = !same_cell && length <= 1e-9 * grid.size;
    if (at_line) {
      // The next carrier may be a million times as wide: the step leads to the line between the two.
      if (to.i != from.i) at.x() = std::max(to.i, from.i);
      if (to.j != from.j) at.y() = std::max(to.j, from.j);
    }
    if (at_line || length <= 1e-15 * grid.size ||
        (length <= 1e-11 * grid.size && length >= 0.5 * last_step)) {
      const Vec3 p = JetAt(grid, cell, at).p;
      return GridFoot{at, p, (place - p).norm()};
    }
    last_step = length;
    last_way = (moved.x() * jet.du + moved.y() * jet.dv).norm();
  }
  // Where both parameters run in one direction, as where a side of a strip is tangent to the next one, the
  // parameters settle slowly. The place has settled long before. On a strip as narrow as the last bits of its
  // coordinates it moves by these bits for ever.
  const double last_bits = 1024.0 * std::numeric_limits<double>::epsilon() * place.cwiseAbs().maxCoeff();
  if (last_way <= 1e-11 * grid.size + last_bits) {
    const Vec3 p = JetAt(grid, cell, at).p;
    return GridFoot{at, p, (place - p).norm()};
  }
  return std::nullopt;
}

}  // namespace

std::optional<GridFoot> FootOnGrid(const CarrierGrid& grid, const Vec3& place, const Vec2& start) {
  // A strip may be ten million times as long as it is wide. Beside a pole, where one parameter hardly
  // counts, that parameter must rather stay.
  if (const std::optional<GridFoot> foot = DampedFoot(grid, place, start, 1e-20)) return foot;
  return DampedFoot(grid, place, start, 1e-13);
}

}  // namespace patchmill
