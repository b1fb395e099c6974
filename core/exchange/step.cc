#include "core/exchange/step.h"

#include <algorithm>
#include <array>
#include <iterator>

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/exchange/number_text.h"

namespace patchmill {
namespace {

constexpr double kOnePoint = 1e-7;  // mm: a side of this size is a point

// A side of a surface as a curve on the same knots.
struct SideCurve {
  int degree = 1;
  const std::vector<double>* knots = nullptr;
  std::vector<Vec3> points;
  std::vector<double> weights;
};

template <class List, class Text>
std::string Listed(const List& list, const Text& text) {
  std::string all = "(";
  for (const auto& item : list) {
    if (all.size() > 1) all += ',';
    all += text(item);
  }
  all += ')';
  return all;
}
std::string References(const std::vector<int>& ids) {
  return Listed(ids, [](int id) { return fmt::format("#{}", id); });
}
std::string Reals(const std::vector<double>& numbers) { return Listed(numbers, RealText); }

class StepWriter {
 public:
  std::string Write(const SplineSurfaces& surfaces) {
    text_ =
        "ISO-10303-21;\nHEADER;\n"
        "FILE_DESCRIPTION(('Surfaces of a Patchmill model'),'2;1');\n"
        "FILE_NAME('part.step','2000-01-01T00:00:00',(''),(''),'Patchmill','Patchmill','');\n"
        "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n";
    std::vector<int> faces;
    for (const SplineSurface& s : surfaces.surfaces) faces.push_back(Face(s));
    const int shell = Put("OPEN_SHELL('',{})", References(faces));
    const int model = Put("SHELL_BASED_SURFACE_MODEL('',(#{}))", shell);
    const int length = Put("{}", "(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.))");
    const int angle = Put("{}", "(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.))");
    const int solid = Put("{}", "(NAMED_UNIT(*) SI_UNIT($,.STERADIAN.) SOLID_ANGLE_UNIT())");
    const int accuracy =
        Put("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-5),#{},'distance_accuracy_value','')", length);
    const int context =
        Put("(GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{})) "
            "GLOBAL_UNIT_ASSIGNED_CONTEXT((#{},#{},#{})) REPRESENTATION_CONTEXT('',''))",
            accuracy, length, angle, solid);
    const int shape = Put("MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#{}),#{})", model, context);
    const int application = Put("APPLICATION_CONTEXT('{}')", "automotive design");
    Put("APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,#{})",
        application);
    const int of_product = Put("PRODUCT_CONTEXT('',#{},'mechanical')", application);
    const int of_design = Put("PRODUCT_DEFINITION_CONTEXT('part definition',#{},'design')", application);
    const int product = Put("PRODUCT('part','part','',(#{}))", of_product);
    const int formation = Put("PRODUCT_DEFINITION_FORMATION('','',#{})", product);
    const int definition = Put("PRODUCT_DEFINITION('design','',#{},#{})", formation, of_design);
    const int shape_of = Put("PRODUCT_DEFINITION_SHAPE('','',#{})", definition);
    Put("SHAPE_DEFINITION_REPRESENTATION(#{},#{})", shape_of, shape);
    text_ += "ENDSEC;\nEND-ISO-10303-21;\n";
    return std::move(text_);
  }

 private:
  template <class... Values>
  int Put(fmt::format_string<Values...> form, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), "#{}=", ++last_);
    fmt::format_to(std::back_inserter(text_), form, std::forward<Values>(values)...);
    text_ += ";\n";
    return last_;
  }

  int Point(const Vec3& p) {
    return Put("CARTESIAN_POINT('',({},{},{}))", RealText(p.x()), RealText(p.y()), RealText(p.z()));
  }

  // The distinct knots and how often each of them counts.
  static std::pair<std::vector<double>, std::vector<int>> Counted(const std::vector<double>& knots) {
    std::pair<std::vector<double>, std::vector<int>> counted;
    for (const double t : knots) {
      if (counted.first.empty() || counted.first.back() != t) {
        counted.first.push_back(t);
        counted.second.push_back(0);
      }
      ++counted.second.back();
    }
    return counted;
  }
  static std::string Counts(const std::vector<int>& counts) {
    return Listed(counts, [](int n) { return fmt::format("{}", n); });
  }

  int Curve(const SideCurve& side) {
    std::vector<int> points;
    for (const Vec3& p : side.points) points.push_back(Point(p));
    const auto [knots, counts] = Counted(*side.knots);
    if (side.weights.empty()) {
      return Put("B_SPLINE_CURVE_WITH_KNOTS('',{},{},.UNSPECIFIED.,.F.,.F.,{},{},.UNSPECIFIED.)", side.degree,
                 References(points), Counts(counts), Reals(knots));
    }
    return Put(
        "(BOUNDED_CURVE() B_SPLINE_CURVE({},{},.UNSPECIFIED.,.F.,.F.) "
        "B_SPLINE_CURVE_WITH_KNOTS({},{},.UNSPECIFIED.) CURVE() GEOMETRIC_REPRESENTATION_ITEM() "
        "RATIONAL_B_SPLINE_CURVE({}) REPRESENTATION_ITEM(''))",
        side.degree, References(points), Counts(counts), Reals(knots), Reals(side.weights));
  }

  int Surface(const BsplinePatch& patch, int nu, int nv) {
    std::vector<std::vector<int>> rows;
    for (int i = 0; i < nu; ++i) {
      std::vector<int>& row = rows.emplace_back();
      for (int j = 0; j < nv; ++j) row.push_back(Point(patch.points[At(i * nv + j)]));
    }
    const std::string points = Listed(rows, References);
    const auto [knots_u, counts_u] = Counted(patch.knots_u);
    const auto [knots_v, counts_v] = Counted(patch.knots_v);
    const std::string knots = fmt::format("{},{},{},{},.UNSPECIFIED.", Counts(counts_u), Counts(counts_v),
                                          Reals(knots_u), Reals(knots_v));
    if (patch.weights.empty()) {
      return Put("B_SPLINE_SURFACE_WITH_KNOTS('',{},{},{},.UNSPECIFIED.,.F.,.F.,.F.,{})", patch.degree_u,
                 patch.degree_v, points, knots);
    }
    std::vector<std::vector<double>> weights;
    for (int i = 0; i < nu; ++i)
      weights.emplace_back(patch.weights.begin() + i * nv, patch.weights.begin() + (i + 1) * nv);
    return Put(
        "(BOUNDED_SURFACE() B_SPLINE_SURFACE({},{},{},.UNSPECIFIED.,.F.,.F.,.F.) "
        "B_SPLINE_SURFACE_WITH_KNOTS({}) GEOMETRIC_REPRESENTATION_ITEM() RATIONAL_B_SPLINE_SURFACE({}) "
        "REPRESENTATION_ITEM('') SURFACE())",
        patch.degree_u, patch.degree_v, points, knots, Listed(weights, Reals));
  }

  // The sides anticlockwise in the parameter plane: v=0, u=1, v=1 and u=0, the last two against their
  // parameter.
  static std::array<SideCurve, 4> SidesOf(const BsplinePatch& patch, int nu, int nv) {
    const auto side = [&](bool along_u, int row) {
      SideCurve curve{
          along_u ? patch.degree_u : patch.degree_v, along_u ? &patch.knots_u : &patch.knots_v, {}, {}};
      for (int k = 0; k < (along_u ? nu : nv); ++k) {
        const std::size_t at = At(along_u ? k * nv + row : row * nv + k);
        curve.points.push_back(patch.points[at]);
        if (!patch.weights.empty()) curve.weights.push_back(patch.weights[at]);
      }
      return curve;
    };
    return {side(true, 0), side(false, nu - 1), side(true, nv - 1), side(false, 0)};
  }

  int Face(const SplineSurface& s) {
    const int nv = static_cast<int>(s.surface.knots_v.size()) - s.surface.degree_v - 1;
    const int nu = static_cast<int>(s.surface.knots_u.size()) - s.surface.degree_u - 1;
    const int surface = Surface(s.surface, nu, nv);
    const std::array<SideCurve, 4> sides = SidesOf(s.surface, nu, nv);
    const auto is_point = [&](const SideCurve& side) {
      return std::ranges::all_of(
          side.points, [&](const Vec3& p) { return (p - side.points.front()).norm() <= kOnePoint; });
    };
    // Corner k is where side k begins, as the loop runs. A side that is a point joins two corners.
    std::array<int, 4> corner = {};
    for (int k = 0; k < 4; ++k) {
      if (k > 0 && is_point(sides[At(k - 1)])) {
        corner[At(k)] = corner[At(k - 1)];
      } else {
        corner[At(k)] = Put("VERTEX_POINT('',#{})",
                            Point(k < 2 ? sides[At(k)].points.front() : sides[At(k)].points.back()));
      }
    }
    if (is_point(sides[3])) corner[0] = corner[3];
    std::vector<int> loop;
    for (int k = 0; k < 4; ++k) {
      if (is_point(sides[At(k)])) continue;
      const int from = corner[At(k)], to = corner[At((k + 1) % 4)];
      const bool turned = k >= 2;
      const int edge =
          Put("EDGE_CURVE('',#{},#{},#{},.T.)", turned ? to : from, turned ? from : to, Curve(sides[At(k)]));
      loop.push_back(Put("ORIENTED_EDGE('',*,*,#{},.{}.)", edge, turned ? "F" : "T"));
    }
    const int edges = Put("EDGE_LOOP('',{})", References(loop));
    const int bound = Put("FACE_OUTER_BOUND('',#{},.T.)", edges);
    return Put("ADVANCED_FACE('{}',(#{}),#{},.T.)", s.name, bound, surface);
  }

  std::string text_;
  int last_ = 0;
};

}  // namespace

std::string StepText(const SplineSurfaces& surfaces) { return StepWriter().Write(surfaces); }

}  // namespace patchmill
