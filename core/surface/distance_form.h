// The squared distance of a net to the origin as a polynomial. It gives an exact test that a whole rectangle
// stays out of a ball.
//
// For a net N = (X, Y, Z, w), coordinates relative to the ball's centre,
//   q(u,v) = X^2 + Y^2 + Z^2 - r^2 w^2 = w^2 (|S|^2 - r^2)
// is a polynomial of twice the net's degrees. (For the vertical line through the centre, X^2 + Y^2 alone
// stands in front.) Its Bernstein coefficients bound it. If its Hessian is positive definite all over the
// rectangle ([location T6] in this form), one point with a supporting plane bounds it exactly. Both tests are
// as good for rational nets and for spheres around the centre (q constant) as for planes.
#pragma once

#include <array>
#include <optional>

#include "core/surface/box_quadratic.h"
#include "core/surface/net_kernel.h"

namespace patchmill {

inline constexpr int kMaxFormDegree = 2 * kMaxDegree;

struct DistanceForm {
  int degree_u = 0, degree_v = 0;
  // (degree_u + 1)(degree_v + 1) coefficients, v fastest.
  std::array<double, (kMaxFormDegree + 1) * (kMaxFormDegree + 1)> c;

  double At(int i, int j) const { return c[static_cast<std::size_t>(i * (degree_v + 1) + j)]; }
  int count() const { return (degree_u + 1) * (degree_v + 1); }
};

// `radius` must be >= 0. Cost: (number of net points)^2 / 2 products. `form` is filled in place, because it
// is large and the searches reuse it. The flags choose one of several loops and belong to no common type.
void MakeDistanceForm(NetShape shape, const Vec4* points, bool rational, bool horizontal, double radius,
                      DistanceForm& form);

struct FormMinimum {
  double value = 0.0;         // smallest coefficient: a lower bound of q
  Vec2 place = Vec2::Zero();  // the Greville abscissa of that coefficient
};
FormMinimum SmallestCoefficient(const DistanceForm& form);

// Bounds of the second derivatives over [0,1]^2.
struct FormBend {
  bool convex = false;                // the Hessian is positive definite everywhere
  double max_uu = 0.0, max_vv = 0.0;  // largest absolute values; they say where to cut
};
FormBend BoundSecondDerivatives(const DistanceForm& form);

struct FormJet {
  double f = 0.0;
  Vec2 gradient = Vec2::Zero();
  Sym2 hessian;
};
FormJet Evaluate(const DistanceForm& form, double u, double v);

// For a convex form. Either proves q >= 0 on [0,1]^2 or finds a point with q < 0. Only rounding can leave
// both open.
struct ConvexVerdict {
  bool nonnegative = false;
  std::optional<Vec2> negative_at;
};
ConvexVerdict DecideConvex(const DistanceForm& form, const Vec2& start);

}  // namespace patchmill
