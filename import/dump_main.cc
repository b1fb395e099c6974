// Prints what the importer understands of a CAD file, and how well it fits together.
//
// usage: cad_dump [--loops] FILE...
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "core/base/index.h"
#include "core/brep/brep_model.h"
#include "core/math/bspline_basis.h"
#include "core/patch/patch.h"
#include "import/occt/brep_of_shape.h"
#include "import/occt/read_file.h"

namespace patchmill {
namespace {

using Clock = std::chrono::steady_clock;
double Seconds(Clock::time_point from) { return std::chrono::duration<double>(Clock::now() - from).count(); }

constexpr std::array<const char*, 6> kKinds = {"plane", "cylinder", "cone", "sphere", "torus", "spline"};

struct Places {
  double u, v;
  Vec3 operator()(const BrepPlane& s) const { return s.frame.origin + u * s.frame.x + v * s.frame.y; }
  Vec3 operator()(const BrepCylinder& s) const {
    return s.frame.origin + s.radius * Around(s.frame) + v * s.frame.z;
  }
  Vec3 operator()(const BrepCone& s) const {
    return s.frame.origin + (s.radius + v * std::sin(s.half_angle)) * Around(s.frame) +
           v * std::cos(s.half_angle) * s.frame.z;
  }
  Vec3 operator()(const BrepSphere& s) const {
    return s.frame.origin + s.radius * (std::cos(v) * Around(s.frame) + std::sin(v) * s.frame.z);
  }
  Vec3 operator()(const BrepTorus& s) const {
    return s.frame.origin + (s.major + s.minor * std::cos(v)) * Around(s.frame) +
           s.minor * std::sin(v) * s.frame.z;
  }
  Vec3 operator()(const BrepSpline& s) const {
    const BsplinePatch& p = s.patch;
    const double u0 = p.knots_u[At(p.degree_u)], u1 = *(p.knots_u.end() - 1 - p.degree_u),
                 v0 = p.knots_v[At(p.degree_v)], v1 = *(p.knots_v.end() - 1 - p.degree_v);
    return Position(PatchShape(p), std::clamp((u - u0) / (u1 - u0), 0.0, 1.0),
                    std::clamp((v - v0) / (v1 - v0), 0.0, 1.0));
  }
  Vec3 Around(const BrepFrame& f) const { return std::cos(u) * f.x + std::sin(u) * f.y; }
};
Vec3 PointOn(const BrepSurface& surface, const Vec2& uv) {
  return std::visit(Places{uv.x(), uv.y()}, surface);
}

Vec3 PointOn(const BrepCurve& curve, double t) {
  const int span = FindSpan(curve.knots, curve.degree, t);
  BasisJet basis;
  BsplineBasisJet(curve.knots, curve.degree, span, t, basis);
  Vec4 h = Vec4::Zero();
  for (int i = 0; i <= curve.degree; ++i) {
    const std::size_t k = At(span - curve.degree + i);
    const double w = curve.weights.empty() ? 1.0 : curve.weights[k];
    h.head<3>() += basis.f[i] * w * curve.points[k];
    h.w() += basis.f[i] * w;
  }
  return h.head<3>() / h.w();
}

// The parameters that a surface has, where it ends by itself.
struct Domain {
  Vec2 low = Vec2::Constant(-kInfinity), high = Vec2::Constant(kInfinity);
};
Domain DomainOf(const BrepSurface& surface) {
  const auto* spline = std::get_if<BrepSpline>(&surface);
  if (spline == nullptr) return {};
  const BsplinePatch& p = spline->patch;
  return {{p.knots_u[At(p.degree_u)], p.knots_v[At(p.degree_v)]},
          {*(p.knots_u.end() - 1 - p.degree_u), *(p.knots_v.end() - 1 - p.degree_v)}};
}

// Distance of the place from the surface, from parameters near its foot: Gauss and Newton with differences.
double FootDistance(const BrepSurface& surface, const Vec3& place, Vec2 at, const Vec2& scale) {
  const Domain domain = DomainOf(surface);
  at = at.cwiseMax(domain.low).cwiseMin(domain.high);
  double best = (PointOn(surface, at) - place).norm();
  for (int round = 0; round < 20; ++round) {
    const Vec3 p = PointOn(surface, at);
    Vec3 d[2];
    for (int axis = 0; axis < 2; ++axis) {
      Vec2 a = at, b = at;
      a[axis] = std::max(at[axis] - 1e-6 * scale[axis], domain.low[axis]);
      b[axis] = std::min(at[axis] + 1e-6 * scale[axis], domain.high[axis]);
      d[axis] = (PointOn(surface, b) - PointOn(surface, a)) / (b[axis] - a[axis]);
    }
    Eigen::Matrix2d g;
    g << d[0].squaredNorm(), d[0].dot(d[1]), d[0].dot(d[1]), d[1].squaredNorm();
    g.diagonal() *= 1.0 + 1e-9;
    g.diagonal().array() += 1e-300;
    Vec2 step = g.inverse() * Vec2(d[0].dot(place - p), d[1].dot(place - p));
    if (!step.allFinite()) break;
    // At an end of the surface, along it.
    for (int axis = 0; axis < 2; ++axis) {
      const double next = at[axis] + step[axis];
      if (next >= domain.low[axis] && next <= domain.high[axis]) continue;
      step[axis] = std::clamp(next, domain.low[axis], domain.high[axis]) - at[axis];
      const int other = 1 - axis;
      step[other] = d[other].dot(place - p - step[axis] * d[axis]) / (d[other].squaredNorm() + 1e-300);
      break;
    }
    at += step.cwiseMax(-0.1 * scale).cwiseMin(0.1 * scale);
    at = at.cwiseMax(domain.low).cwiseMin(domain.high);
    best = std::min(best, (PointOn(surface, at) - place).norm());
  }
  return best;
}

struct Worst {
  double jump = 0.0;       // of the face's range of parameters, between neighbours in a loop
  double jump_mm = 0.0;    // the same in space
  double hint_mm = 0.0;    // of S(hint) from the curve at hint_at
  double foot_mm = 0.0;    // of the curve from the surface
  double area_sign = 1.0;  // of the outer loop in the parameters
  void Add(const Worst& o) {
    jump = std::max(jump, o.jump);
    jump_mm = std::max(jump_mm, o.jump_mm);
    hint_mm = std::max(hint_mm, o.hint_mm);
    foot_mm = std::max(foot_mm, o.foot_mm);
  }
};

Vec2 Begin(const BrepEdgeUse& use) { return use.forward ? use.hint.front() : use.hint.back(); }
Vec2 End(const BrepEdgeUse& use) { return use.forward ? use.hint.back() : use.hint.front(); }

double SignedArea(const BrepLoop& loop) {
  std::vector<Vec2> places;
  for (const BrepEdgeUse& use : loop) {
    std::vector<Vec2> part = use.hint;
    if (!use.forward) std::reverse(part.begin(), part.end());
    places.insert(places.end(), part.begin(), part.end());
  }
  double area = 0.0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    area += 0.5 * Cross(places[k] - places[0], places[(k + 1) % places.size()] - places[0]);
  }
  return area;
}

Worst Examine(const BrepModel& model, const BrepFace& face, const BrepLoop& loop, const Vec2& scale) {
  Worst worst;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const BrepEdgeUse& use = loop[k];
    const Vec2 a = End(use), b = Begin(loop[(k + 1) % loop.size()]);
    worst.jump = std::max(worst.jump, (a - b).cwiseQuotient(scale).cwiseAbs().maxCoeff());
    worst.jump_mm = std::max(worst.jump_mm, (PointOn(face.surface, a) - PointOn(face.surface, b)).norm());
    const BrepEdge& edge = model.edges[At(use.edge)];
    for (std::size_t i = 0; i < use.hint.size(); ++i) {
      if (i > 0 && !(use.hint_at[i] > use.hint_at[i - 1])) std::printf("    hint_at does not increase\n");
      if (edge.degenerate) continue;
      const Vec3 p = PointOn(edge.curve, use.hint_at[i]);
      worst.hint_mm = std::max(worst.hint_mm, (PointOn(face.surface, use.hint[i]) - p).norm());
      worst.foot_mm = std::max(worst.foot_mm, FootDistance(face.surface, p, use.hint[i], scale));
    }
  }
  return worst;
}

void Dump(const std::string& path, bool loops) {
  std::ifstream in(path, std::ios::binary);
  const std::string content((std::istreambuf_iterator<char>(in)), {});
  const std::string ending = path.substr(path.rfind('.') + 1);
  const bool step = !ending.empty() && (ending[0] == 's' || ending[0] == 'S' || ending[0] == 'p');
  const auto start = Clock::now();
  const absl::StatusOr<CadFile> file = ReadCadFile(content, step ? "step" : "iges");
  const double read_s = Seconds(start);
  const std::string name = path.substr(path.rfind('/') + 1);
  std::printf("%s\n", name.c_str());
  if (!file.ok()) {
    std::printf("  failed: %s\n", std::string(file.status().message()).c_str());
    return;
  }
  std::printf("  schema %s, unit %s, by %s, roots %d%s\n", file->schema.c_str(), file->unit.c_str(),
              file->written_by.c_str(), file->root_count, file->searched ? " (searched)" : "");
  for (const auto& [kind, count] : file->skipped) std::printf("  skipped %d %s\n", count, kind.c_str());
  for (const std::string& other : file->external_files) std::printf("  refers to %s\n", other.c_str());
  for (const std::int64_t lost : file->lost_faces)
    std::printf("  lost face #%lld\n", static_cast<long long>(lost));
  std::printf("  free edges %d -> %d (sewn at %g)\n", file->sewing.free_edges_before,
              file->sewing.free_edges_after, file->sewing.tolerance);
  const auto convert = Clock::now();
  const absl::StatusOr<BrepOfShapeResult> result = BrepOfShape(file->shape, file->labels);
  const double convert_s = Seconds(convert);
  if (!result.ok()) {
    std::printf("  failed: %s\n", std::string(result.status().message()).c_str());
    return;
  }
  const BrepModel& model = result->model;
  std::map<std::string, int> kinds, layers, names;
  double area = 0.0, error = 0.0;
  int uses = 0, loop_count = 0, coloured = 0, degenerate = 0, backward = 0;
  Worst all;
  Box3 box;
  for (const BrepEdge& e : model.edges) {
    degenerate += e.degenerate ? 1 : 0;
    for (const Vec3& p : e.curve.points) box.Add(p);
  }
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const BrepFace& face = model.faces[f];
    ++kinds[kKinds[face.surface.index()]];
    ++layers[face.layer];
    ++names[face.name];
    coloured += face.rgb ? 1 : 0;
    area += face.area.value_or(0.0);
    error = std::max(error, face.surface_error);
    loop_count += static_cast<int>(face.loops.size());
    Vec2 low = Vec2::Constant(kInfinity), high = Vec2::Constant(-kInfinity);
    for (const BrepLoop& loop : face.loops) {
      uses += static_cast<int>(loop.size());
      for (const BrepEdgeUse& use : loop) {
        for (const Vec2& h : use.hint) {
          low = low.cwiseMin(h);
          high = high.cwiseMax(h);
        }
      }
    }
    const Vec2 scale = (high - low).cwiseMax(1e-12);
    if (!face.loops.empty() && SignedArea(face.loops[0]) <= 0.0) ++backward;
    Worst of_face;
    for (const BrepLoop& loop : face.loops) of_face.Add(Examine(model, face, loop, scale));
    all.Add(of_face);
    if (loops || of_face.jump > 0.01 || of_face.foot_mm > 1e-3) {
      std::printf("  f%zu #%lld %s %s%s loops %zu uses", f + 1, static_cast<long long>(face.entity),
                  kKinds[face.surface.index()], face.reversed ? "reversed " : "", face.name.c_str(),
                  face.loops.size());
      for (const BrepLoop& loop : face.loops) std::printf(" %zu", loop.size());
      std::printf(" area %.8g jump %.2g (%.2g mm) hint %.2g foot %.2g mm\n", face.area.value_or(-1.0),
                  of_face.jump, of_face.jump_mm, of_face.hint_mm, of_face.foot_mm);
    }
  }
  for (const BrepBody& body : model.bodies) {
    std::printf("  body '%s' %s", body.name.c_str(), body.solid ? "closed" : "open");
    if (body.volume) std::printf(" volume %.10g", *body.volume);
    std::printf("\n");
  }
  for (const ShapeFinding& finding : result->findings) {
    std::printf("  %s f%d #%lld: %s\n", finding.code.c_str(), finding.face + 1,
                static_cast<long long>(finding.entity), finding.reason.c_str());
  }
  const Vec3 size = box.Empty() ? Vec3::Zero() : Vec3(box.max - box.min);
  std::printf("  faces %zu:", model.faces.size());
  for (const auto& [kind, count] : kinds) std::printf(" %s %d", kind.c_str(), count);
  std::printf("; loops %d, uses %d, edges %zu (%d degenerate), vertices %zu\n", loop_count, uses,
              model.edges.size(), degenerate, model.vertices.size());
  std::printf("  coloured %d, layers %zu, names %zu ('%s'), loops backward %d\n", coloured, layers.size(),
              names.size(), names.empty() ? "" : names.begin()->first.c_str(), backward);
  std::printf("  box of edges %.6g x %.6g x %.6g, area %.10g, surface error %.2g\n", size.x(), size.y(),
              size.z(), area, error);
  std::printf("  worst: jump %.2g (%.2g mm), hint %.2g mm, foot %.2g mm; read %.2f s, convert %.2f s\n",
              all.jump, all.jump_mm, all.hint_mm, all.foot_mm, read_s, convert_s);
  std::printf("ROW|%s|%zu|%zu|%d|%zu|%.2g|%.2g|%.2g|%.9g|%.2g|%.2f|%.2f\n", name.c_str(), model.faces.size(),
              result->findings.size(), uses, model.bodies.size(), all.jump, all.hint_mm, all.foot_mm, area,
              error, read_s, convert_s);
}

}  // namespace
}  // namespace patchmill

int main(int argc, char** argv) {
  bool loops = false;
  for (int k = 1; k < argc; ++k) {
    if (std::string(argv[k]) == "--loops") {
      loops = true;
    } else {
      patchmill::Dump(argv[k], loops);
    }
  }
}
