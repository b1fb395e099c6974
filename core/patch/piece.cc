#include "core/patch/piece.h"

#include "core/patch/bicubic_sums.h"
#include "core/patch/kinds.h"
#include "core/patch/split_pieces.h"
#include "core/patch/tensor_kernel.h"

namespace patchmill {
namespace {

using internal::HomogeneousJet;

// The common degrees are constants, so that the compiler unrolls; -1 stands for any degree.
template <int kU, int kV>
HomogeneousJet NetJet(const BernsteinNet& net, double u, double v) {
  const int degree_u = kU < 0 ? net.degree_u : kU, degree_v = kV < 0 ? net.degree_v : kV;
  BasisJet bu, bv;
  AllBernsteinJet(degree_u, u, bu);
  AllBernsteinJet(degree_v, v, bv);
  const Vec4* points = net.points.data();
  return internal::TensorJet(degree_u, degree_v, bu, bv,
                             [&](int i, int j) -> const Vec4& { return points[i * (degree_v + 1) + j]; });
}

SurfaceJet BicubicJet(const BernsteinNet& net, double u, double v) {
  BasisJet bu, bv;
  AllBernsteinJet(3, u, bu);
  AllBernsteinJet(3, v, bv);
  double sums[24];
  internal::SumBicubic(net.points.front().data(), bu, bv, sums);
  if (!net.rational) {  // the most frequent case: avoid copies
    const auto three = [&](int k) { return Vec3(sums[k], sums[k + 1], sums[k + 2]); };
    return {three(0), three(4), three(8), three(12), three(16), three(20), {}};
  }
  const auto four = [&](int k) { return Vec4(sums[k], sums[k + 1], sums[k + 2], sums[k + 3]); };
  return internal::RationalJet({four(0), four(4), four(8), four(12), four(16), four(20)});
}

HomogeneousJet NetJet(const BernsteinNet& net, double u, double v) {
  if (net.degree_u == 2 && net.degree_v == 2) return NetJet<2, 2>(net, u, v);
  return NetJet<-1, -1>(net, u, v);
}

template <int kU, int kV>
Vec4 NetPoint(const BernsteinNet& net, double u, double v) {
  const int degree_u = kU < 0 ? net.degree_u : kU, degree_v = kV < 0 ? net.degree_v : kV;
  double bu[kMaxBasisDegree + 1], bv[kMaxBasisDegree + 1];
  AllBernstein(degree_u, u, bu);
  AllBernstein(degree_v, v, bv);
  const Vec4* points = net.points.data();
  return internal::TensorPoint(degree_u, degree_v, bu, bv,
                               [&](int i, int j) -> const Vec4& { return points[i * (degree_v + 1) + j]; });
}

Vec4 NetPoint(const BernsteinNet& net, double u, double v) {
  if (net.degree_u == 3 && net.degree_v == 3) return NetPoint<3, 3>(net, u, v);
  if (net.degree_u == 2 && net.degree_v == 2) return NetPoint<2, 2>(net, u, v);
  return NetPoint<-1, -1>(net, u, v);
}

// The jet of the patch, mapped to the piece's parameters by the chain rule through the bilinear map `native`.
SurfaceJet ShapeJet(const Piece& piece, double u, double v) {
  const auto& c = piece.native;
  const Vec2 at = NativeParameters(piece, u, v);
  const Vec2 a = (1.0 - v) * (c[1] - c[0]) + v * (c[3] - c[2]);  // d/du
  const Vec2 b = (1.0 - u) * (c[2] - c[0]) + u * (c[3] - c[1]);  // d/dv
  const Vec2 ab = c[3] - c[2] - c[1] + c[0];
  const SurfaceJet n = Evaluate(*piece.shape, at.x(), at.y());
  SurfaceJet s;
  s.p = n.p;
  s.du = a.x() * n.du + a.y() * n.dv;
  s.dv = b.x() * n.du + b.y() * n.dv;
  s.duu = a.x() * a.x() * n.duu + 2.0 * a.x() * a.y() * n.duv + a.y() * a.y() * n.dvv;
  s.dvv = b.x() * b.x() * n.duu + 2.0 * b.x() * b.y() * n.duv + b.y() * b.y() * n.dvv;
  s.duv = a.x() * b.x() * n.duu + (a.x() * b.y() + a.y() * b.x()) * n.duv + a.y() * b.y() * n.dvv +
          ab.x() * n.du + ab.y() * n.dv;
  return s;
}

SurfaceJet JetOf(const Piece& piece, double u, double v) {
  if (piece.gregory) return internal::EvaluateShape(*piece.gregory, u, v);
  if (piece.shape) return ShapeJet(piece, u, v);
  if (piece.net.degree_u == 3 && piece.net.degree_v == 3) return BicubicJet(piece.net, u, v);
  const HomogeneousJet h = NetJet(piece.net, u, v);
  return piece.net.rational ? internal::RationalJet(h) : internal::PolynomialJet(h);
}

}  // namespace

BernsteinNet SubNet(const BernsteinNet& net, double u0, double u1, double v0, double v1) {
  BernsteinNet sub = net;
  const int row = net.degree_v + 1;
  // Cuts [x0,1] first, then [x0,x1] from it. The parameters stay in [0,1], so every step is convex.
  if (u0 > 0.0) {
    for (int j = 0; j < row; ++j) KeepRight(&sub.points[static_cast<std::size_t>(j)], net.degree_u, row, u0);
  }
  if (u1 < 1.0) {
    const double t = (u1 - u0) / (1.0 - u0);
    for (int j = 0; j < row; ++j) KeepLeft(&sub.points[static_cast<std::size_t>(j)], net.degree_u, row, t);
  }
  for (int i = 0; i <= net.degree_u; ++i) {
    Vec4* first = &sub.points[static_cast<std::size_t>(i * row)];
    if (v0 > 0.0) KeepRight(first, net.degree_v, 1, v0);
    if (v1 < 1.0) KeepLeft(first, net.degree_v, 1, (v1 - v0) / (1.0 - v0));
  }
  if (!sub.rational) {
    for (Vec4& p : sub.points) p.w() = 1.0;
  }
  return sub;
}

std::vector<Piece> SplitIntoPieces(PatchId id, const PatchShape& shape) {
  return SplitIntoPieces(id, shape, RunContext());
}

SurfaceJet Evaluate(const Piece& piece, double u, double v) {
  SurfaceJet jet = JetOf(piece, u, v);
  jet.sides = piece.sides;
  return jet;
}

SurfaceJet EvaluateSlopes(const Piece& piece, double u, double v) {
  const BernsteinNet& net = piece.net;
  if (piece.gregory || piece.shape || net.rational || net.degree_u != 3 || net.degree_v != 3)
    return Evaluate(piece, u, v);
  BasisJet bu, bv;
  AllBernsteinSlopes(3, u, bu);
  AllBernsteinSlopes(3, v, bv);
  double sums[12];
  internal::SumBicubicSlopes(net.points.front().data(), bu, bv, sums);
  const auto three = [&](int k) { return Vec3(sums[k], sums[k + 1], sums[k + 2]); };
  SurfaceJet jet;
  jet.p = three(0);
  jet.du = three(4);
  jet.dv = three(8);
  jet.sides = piece.sides;
  return jet;
}

Vec3 Position(const Piece& piece, double u, double v) {
  if (piece.gregory) return internal::ShapePosition(*piece.gregory, u, v);
  if (piece.shape) {
    const Vec2 at = NativeParameters(piece, u, v);
    return Position(*piece.shape, at.x(), at.y());
  }
  const Vec4 p = NetPoint(piece.net, u, v);
  return piece.net.rational ? Vec3(p.head<3>() / p.w()) : Vec3(p.head<3>());
}

Vec2 NativeParameters(const Piece& piece, double u, double v) {
  const auto& c = piece.native;
  if (piece.speed != Vec2(1.0, 1.0)) {
    u = Eased(u, piece.speed.x());
    v = Eased(v, piece.speed.y());
  }
  return (1.0 - v) * ((1.0 - u) * c[0] + u * c[1]) + v * ((1.0 - u) * c[2] + u * c[3]);
}

}  // namespace patchmill
