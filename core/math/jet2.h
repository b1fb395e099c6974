// Second-order jets of two variables: a value with first and second partial derivatives, carried exactly
// through + - * / [shapes, section 7]. They serve the blended patches, where a scalar jet multiplies a vector
// (AddTerm in core/patch/kinds.h).
#pragma once

namespace patchmill {

struct Jet2 {
  double f = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0;

  static Jet2 U(double value) { return {value, 1, 0, 0, 0, 0}; }
  static Jet2 V(double value) { return {value, 0, 1, 0, 0, 0}; }
  static Jet2 Constant(double value) { return {value, 0, 0, 0, 0, 0}; }
};

inline Jet2 operator+(const Jet2& a, const Jet2& b) {
  return {a.f + b.f, a.u + b.u, a.v + b.v, a.uu + b.uu, a.uv + b.uv, a.vv + b.vv};
}
inline Jet2 operator-(const Jet2& a, const Jet2& b) {
  return {a.f - b.f, a.u - b.u, a.v - b.v, a.uu - b.uu, a.uv - b.uv, a.vv - b.vv};
}
inline Jet2 operator-(const Jet2& a) { return {-a.f, -a.u, -a.v, -a.uu, -a.uv, -a.vv}; }
inline Jet2 operator*(double s, const Jet2& a) {
  return {s * a.f, s * a.u, s * a.v, s * a.uu, s * a.uv, s * a.vv};
}
inline Jet2 operator*(const Jet2& a, const Jet2& b) {
  return {a.f * b.f,
          a.u * b.f + a.f * b.u,
          a.v * b.f + a.f * b.v,
          a.uu * b.f + 2 * a.u * b.u + a.f * b.uu,
          a.uv * b.f + a.u * b.v + a.v * b.u + a.f * b.uv,
          a.vv * b.f + 2 * a.v * b.v + a.f * b.vv};
}
// Quotient rule: q = a/b solved from q b = a, derivative by derivative. b.f != 0.
inline Jet2 operator/(const Jet2& a, const Jet2& b) {
  const double r = 1.0 / b.f;
  Jet2 q;
  q.f = a.f * r;
  q.u = (a.u - q.f * b.u) * r;
  q.v = (a.v - q.f * b.v) * r;
  q.uu = (a.uu - 2 * q.u * b.u - q.f * b.uu) * r;
  q.uv = (a.uv - q.u * b.v - q.v * b.u - q.f * b.uv) * r;
  q.vv = (a.vv - 2 * q.v * b.v - q.f * b.vv) * r;
  return q;
}

}  // namespace patchmill
