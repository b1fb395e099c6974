#include "core/trim/face_box.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/base/index.h"
#include "core/trim/carrier_grid.h"

namespace patchmill {
namespace {

constexpr double kMargin = 0.02;  // of the parameters' range, beyond what the samples of the loops reach
constexpr int kParts = 4;         // of a carrier along each parameter: the hull of a small part is tight

void AddHull(const BernsteinNet& net, Box3& box) {
  for (const Vec4& p : net.points) {
    if (p.w() > 0.0) box.Add(Vec3(p.head<3>() / p.w()));
  }
}

// The part of one cell of the grid between two places of the grid.
void AddCell(const Piece& carrier, const Vec2& from, const Vec2& to, Box3& box) {
  const Vec2 low = from.cwiseMax(0.0).cwiseMin(1.0), high = to.cwiseMax(0.0).cwiseMin(1.0);
  const Vec2 step = (high - low) / kParts;
  for (int a = 0; a < kParts; ++a) {
    for (int b = 0; b < kParts; ++b) {
      const double u0 = low.x() + a * step.x(), v0 = low.y() + b * step.y();
      AddHull(SubNet(carrier.net, u0, std::min(1.0, u0 + step.x()), v0, std::min(1.0, v0 + step.y())), box);
    }
  }
}

// The surface over a rectangle of its parameters.
void AddSurface(const BrepSurface& surface, const Vec2& lowest, const Vec2& highest, Box3& box) {
  const CarrierGrid grid = CarriersOf(surface, lowest, highest);
  const Vec2 margin = kMargin * (highest - lowest);
  const Vec2 from = GridCoordinates(grid, lowest - margin), to = GridCoordinates(grid, highest + margin);
  for (int i = 0; i < grid.u.count(); ++i) {
    for (int j = 0; j < grid.v.count(); ++j) {
      const Vec2 corner(i, j);
      if ((from - corner).maxCoeff() > 1.0 || (to - corner).minCoeff() < 0.0) continue;
      AddCell(grid.carrier(i, j), from - corner, to - corner, box);
    }
  }
}

}  // namespace

Box3 BoxOfFace(const BrepModel& part, const BrepFace& face) {
  Box3 box = face.box.value_or(Box3());
  Vec2 low = Vec2::Constant(kInfinity), high = Vec2::Constant(-kInfinity);
  for (const BrepLoop& loop : face.loops) {
    for (const BrepEdgeUse& use : loop) {
      // A curve lies in the hull of its points.
      for (const Vec3& p : part.edges[At(use.edge)].curve.points) box.Add(p);
      for (const Vec2& h : use.hint) {
        low = low.cwiseMin(h);
        high = high.cwiseMax(h);
      }
    }
  }
  // A plane face lies in the hull of its edges.
  if (std::holds_alternative<BrepPlane>(face.surface)) return box;
  if (low.allFinite() && high.allFinite()) AddSurface(face.surface, low, high, box);
  return box;
}

std::array<BezierPatch, 6> SidesOf(const Box3& box) {
  const auto side = [&box](int axis, bool high) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    BezierPatch patch;
    patch.degree_u = patch.degree_v = 1;
    for (const bool u : {false, true}) {
      for (const bool v : {false, true}) {
        // u x v is the axis with the first order of the other two, and against it with the second.
        Vec3 p;
        p[axis] = high ? box.max[axis] : box.min[axis];
        p[high ? a : b] = u ? box.max[high ? a : b] : box.min[high ? a : b];
        p[high ? b : a] = v ? box.max[high ? b : a] : box.min[high ? b : a];
        patch.points.push_back(p);
      }
    }
    return patch;
  };
  return {side(2, true), side(0, false), side(0, true), side(1, false), side(1, true), side(2, false)};
}

}  // namespace patchmill
