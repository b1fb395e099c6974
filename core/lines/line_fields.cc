#include "core/lines/line_fields.h"

#include <cmath>

#include "core/diffgeo/forms.h"
#include "core/lines/line_forms.h"

namespace patchmill {
namespace {

constexpr double kLevelNoise = 1e-12;  // mm
constexpr double kHorizontal = 1e-12;  // sine of the slope below which a contour has no direction

// The rotation that turns `axis` to z. Exactly the identity for z itself.
Eigen::Matrix3d ToAxis(const Vec3& axis) {
  if (axis == Vec3::UnitZ()) return Eigen::Matrix3d::Identity();
  return Eigen::Quaterniond::FromTwoVectors(axis, Vec3::UnitZ()).toRotationMatrix();
}

SurfaceJet Turned(const Eigen::Matrix3d& turn, const SurfaceJet& jet) {
  SurfaceJet t;
  t.p = turn * jet.p;
  t.du = turn * jet.du;
  t.dv = turn * jet.dv;
  t.duu = turn * jet.duu;
  t.duv = turn * jet.duv;
  t.dvv = turn * jet.dvv;
  return t;
}

BernsteinNet Turned(const Eigen::Matrix3d& turn, BernsteinNet net) {
  for (Vec4& p : net.points) p.head<3>() = Vec3(turn * p.head<3>());
  return net;
}

// A point of the box (or as near to it as rounding) where phi_u = phi_v = 0. Newton's method starts at the
// middle of the box. With saddles_only, summits and pits are left out.
std::optional<Vec2> CriticalPoint(const Piece& piece, const ParameterBox& box, const Vec3& axis,
                                  bool saddles_only) {
  const Vec2 low(box.u0, box.v0), high(box.u1, box.v1), side = high - low;
  const double margin = 1e-9 * side.maxCoeff();
  Vec2 q = 0.5 * (low + high);
  double determinant = 0.0;
  for (int i = 0; i < 20; ++i) {
    const SurfaceJet jet = Evaluate(piece, q.x(), q.y());
    const double fu = axis.dot(jet.du), fv = axis.dot(jet.dv);
    const double fuu = axis.dot(jet.duu), fuv = axis.dot(jet.duv), fvv = axis.dot(jet.dvv);
    determinant = fuu * fvv - fuv * fuv;
    if (!(std::abs(determinant) > 0.0)) return std::nullopt;
    const Vec2 step((fvv * fu - fuv * fv) / determinant, (fuu * fv - fuv * fu) / determinant);
    q -= step;
    // From up to one box beyond, the iteration may still come back.
    if (!((q - low + side).minCoeff() >= 0.0 && (high + side - q).minCoeff() >= 0.0)) return std::nullopt;
    q = q.cwiseMax(0.0).cwiseMin(1.0);
    if (step.norm() < 1e-14) break;
  }
  if ((q - low).minCoeff() < -margin || (high - q).minCoeff() < -margin) return std::nullopt;
  if (saddles_only && determinant >= 0.0) return std::nullopt;  // no curve passes a summit or a pit
  const SurfaceJet jet = Evaluate(piece, q.x(), q.y());
  const double flat = std::hypot(axis.dot(jet.du), axis.dot(jet.dv));
  if (!(flat <= 1e-9 * (jet.du.norm() + jet.dv.norm()))) return std::nullopt;  // stopped at the piece's side
  return q;
}

double Torsion(const SurfaceJet& jet) {
  const auto normal = UnitNormal(jet);
  if (!normal) return 0.0;
  const FundamentalForms f = Forms(jet, *normal);
  const double zu = jet.du.z(), zv = jet.dv.z();
  const double length2 = f.E * zv * zv - 2.0 * f.F * zu * zv + f.G * zu * zu;  // W sin^2(slope)
  const double w = f.E * f.G - f.F * f.F;
  if (!(length2 > kHorizontal * kHorizontal * w)) return 0.0;
  return ((f.M * f.G - f.N * f.F) * zu * zu - (f.G * f.L - f.N * f.E) * zu * zv +
          (f.L * f.F - f.M * f.E) * zv * zv) /
         (std::sqrt(w) * length2);
}

}  // namespace

ZeroField ContourField(double level, const Vec3& axis) {
  ZeroField field;
  field.value = [=](const SurfaceJet& jet) { return axis.dot(jet.p) - level; };
  field.form = [=](const BernsteinNet& net) { return LevelForm(net, axis, level); };
  field.node = [=](const Piece& piece, const ParameterBox& box) {
    std::optional<Vec2> q = CriticalPoint(piece, box, axis, true);
    if (q &&
        std::abs(axis.dot(Position(piece, q->x(), q->y())) - level) > kLevelNoise * (1 + std::abs(level)))
      q.reset();
    return q;
  };
  field.noise = kLevelNoise * (1.0 + std::abs(level));
  return field;
}

ZeroField SlopeField(double angle, const Vec3& axis) {
  const double c = std::cos(angle);
  ZeroField field;
  field.value = [=](const SurfaceJet& jet) {
    const auto normal = UnitNormal(jet);
    return normal ? std::abs(axis.dot(*normal)) - c : 0.0;
  };
  const Eigen::Matrix3d turn = ToAxis(axis);
  field.form = [=](const BernsteinNet& net) { return SlopeForm(Turned(turn, net), c); };
  return field;
}

ZeroField BrightnessField(double brightness, const Vec3& light) {
  ZeroField field;
  field.value = [=](const SurfaceJet& jet) {
    const auto normal = UnitNormal(jet);
    return normal ? light.dot(*normal) - brightness : 0.0;
  };
  const Eigen::Matrix3d turn = ToAxis(light);
  // (light . n)^2 - brightness^2 also vanishes on light . n = -brightness, but never on both along one arc.
  field.form = [=](const BernsteinNet& net) {
    return brightness == 0.0 ? TurnForm(Turned(turn, net)) : SlopeForm(Turned(turn, net), brightness);
  };
  return field;
}

ZeroField SilhouetteField(const Vec3& view) {
  ZeroField field;
  field.value = [=](const SurfaceJet& jet) {
    const auto normal = UnitNormal(jet);
    return normal ? view.dot(*normal) : 0.0;
  };
  const Eigen::Matrix3d turn = ToAxis(view);
  field.form = [=](const BernsteinNet& net) { return TurnForm(Turned(turn, net)); };
  return field;
}

ZeroField EyeSilhouetteField(const Vec3& eye) {
  ZeroField field;
  field.value = [=](const SurfaceJet& jet) {
    const auto normal = UnitNormal(jet);
    return normal ? (jet.p - eye).dot(*normal) : 0.0;
  };
  field.form = [=](const BernsteinNet& net) { return EyeForm(net, eye); };
  return field;
}

ZeroField ContourCurvatureField(const Vec3& axis) {
  const Eigen::Matrix3d turn = ToAxis(axis);
  ZeroField field;
  field.value = [=](const SurfaceJet& given) {
    const SurfaceJet jet = Turned(turn, given);
    const auto normal = UnitNormal(jet);
    return normal ? ContourCurvature(jet, Forms(jet, *normal)) : 0.0;
  };
  field.form = [=](const BernsteinNet& net) { return ContourCurvatureForm(Turned(turn, net)); };
  field.node = [=](const Piece& piece, const ParameterBox& box) {
    return CriticalPoint(piece, box, axis, true);
  };
  return field;
}

ZeroField SlopeExtremumField(const Vec3& axis) {
  const Eigen::Matrix3d turn = ToAxis(axis);
  ZeroField field;
  field.value = [=](const SurfaceJet& jet) { return Torsion(Turned(turn, jet)); };
  field.form = [=](const BernsteinNet& net) { return SlopeExtremumForm(Turned(turn, net)); };
  field.node = [=](const Piece& piece, const ParameterBox& box) {
    return CriticalPoint(piece, box, axis, false);
  };
  return field;
}

}  // namespace patchmill
