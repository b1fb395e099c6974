#include "import/occt/face_integrals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <Geom_BSplineSurface.hxx>
#include <Geom_ElementarySurface.hxx>
#include <Geom_Plane.hxx>

#include "core/base/index.h"
#include "core/math/gauss_rule.h"
#include "import/occt/convert.h"
#include "import/occt/surface_knots.h"

namespace patchmill {
namespace {

constexpr std::size_t kManyBreaks = 64;  // from so many knots on, four points between two of them do
constexpr double kAgreement = 1e-8;
constexpr int kMostHalvings = 5;
// Into how many steps a direction is cut at least, so that eight points follow an arc or a high degree.
int FewestSteps(const Geom_Surface& bare) {
  if (bare.IsKind(STANDARD_TYPE(Geom_Plane))) return 1;
  if (bare.IsKind(STANDARD_TYPE(Geom_ElementarySurface))) return 4;
  const auto* spline = dynamic_cast<const Geom_BSplineSurface*>(&bare);
  return spline == nullptr ? 12 : 2 + 2 * std::min(spline->UDegree(), 5);
}

using Sums = Eigen::Vector2d;  // area and volume

// The smooth parts of [low, high] in one direction.
std::vector<double> BreaksOf(const Handle(Geom_Surface) & bare, const NeededParameters& range, bool along_u) {
  const NeededParameters::Range& own = along_u ? range.u : range.v;
  if (!(own.low < own.high)) return {own.low, own.high};
  // A span between the end of the range and a knot beside it would take steps from the others.
  const std::vector<double> breaks = KnotsWithin(bare, {own.low, own.high}, along_u);
  const auto spans = static_cast<int>(breaks.size()) - 1;
  const int fewest = along_u ? FewestSteps(*bare) : 1;
  if (spans >= fewest) return breaks;
  const int parts = (fewest + spans - 1) / spans;
  std::vector<double> fine = {breaks.front()};
  for (std::size_t k = 1; k < breaks.size(); ++k) {
    for (int i = 1; i < parts; ++i) fine.push_back(breaks[k - 1] + (breaks[k] - breaks[k - 1]) * i / parts);
    fine.push_back(breaks[k]);
  }
  return fine;
}

class Integrator {
 public:
  Integrator(const Handle(Geom_Surface) & bare, const NeededParameters& range)
      : surface_(bare), u_(BreaksOf(bare, range, true)), v_(BreaksOf(bare, range, false)) {}

  // One use of an edge, cut where it is not smooth, with a first estimate for each part.
  struct Run {
    const SampledUse* use = nullptr;
    std::vector<double> breaks;
    std::vector<Sums> parts;
  };
  Run Estimate(const SampledUse& use) const {
    Run run{&use, use.curve.Breaks(), {}};
    AddCrossings(use.curve, run.breaks);
    for (std::size_t k = 1; k < run.breaks.size(); ++k) {
      run.parts.push_back(Rule(use.curve, run.breaks[k - 1], run.breaks[k]));
    }
    return run;
  }

  // Along the straight line that closes a gap between neighbours in a loop.
  Sums Between(const Vec2& from, const Vec2& to) const {
    Sums sums = Sums::Zero();
    const Vec2 step = to - from;
    if (step.y() == 0.0) return sums;
    for (const GaussPoint& g : kGauss8) {
      const Vec2 place = from + g.at * step;
      sums += g.weight * step.y() * UpTo(place.x(), place.y());
    }
    return sums;
  }

  // Each part within `slack` of its area.
  Sums Refine(const Run& run, double slack) const {
    Sums sums = Sums::Zero();
    for (std::size_t k = 0; k < run.parts.size(); ++k) {
      sums += Halved(run.use->curve, run.breaks[k], run.breaks[k + 1], run.parts[k], slack, 0);
    }
    return sums;
  }

 private:
  // The integrands of area and volume.
  Sums Density(double u, double v) const {
    gp_Pnt p;
    gp_Vec du, dv;
    surface_->D1(u, v, p, du, dv);
    const gp_Vec normal = du.Crossed(dv);
    return {normal.Magnitude(), gp_Vec(p.XYZ()).Dot(normal) / 3.0};
  }

  // From the lowest u to this one, at this v.
  Sums UpTo(double u, double v) const {
    Sums sums = Sums::Zero();
    const bool few = u_.size() > kManyBreaks;
    for (std::size_t k = 1; k < u_.size(); ++k) {
      const bool last = k + 1 == u_.size() || u_[k] >= u;
      const double from = u_[k - 1], step = (last ? u : u_[k]) - from;
      const std::span<const GaussPoint> rule = few ? std::span<const GaussPoint>(kGauss4) : kGauss8;
      for (const GaussPoint& g : rule) sums += g.weight * step * Density(from + step * g.at, v);
      if (last) break;
    }
    return sums;
  }

  Sums Rule(const PlaceCurve& curve, double from, double to) const {
    Sums sums = Sums::Zero();
    const double lowest = u_.front(), width = u_.back() - u_.front();
    for (const GaussPoint& g : kGauss8) {
      const PlaceJet jet = curve.At(from + (to - from) * g.at);
      if (jet.d.y() == 0.0 || std::abs(jet.place.x() - lowest) <= 1e-15 * width) continue;
      sums += g.weight * (to - from) * jet.d.y() * UpTo(jet.place.x(), jet.place.y());
    }
    return sums;
  }

  Sums Halved(const PlaceCurve& curve, double from, double to, const Sums& whole, double slack,
              int depth) const {
    if (whole.x() == 0.0) return whole;
    const double middle = 0.5 * (from + to);
    const Sums a = Rule(curve, from, middle), b = Rule(curve, middle, to);
    if (std::abs(a.x() + b.x() - whole.x()) <= slack || depth >= kMostHalvings) return a + b;
    return Halved(curve, from, middle, a, slack, depth + 1) + Halved(curve, middle, to, b, slack, depth + 1);
  }

  // Where the curve crosses knots of the surface in v, between places a part of a span apart.
  void AddCrossings(const PlaceCurve& curve, std::vector<double>& breaks) const {
    if (v_.size() <= 2) return;
    constexpr int kPlaces = 8;
    const std::vector<double> own = breaks;
    for (std::size_t k = 1; k < own.size(); ++k) {
      for (int i = 0; i < kPlaces; ++i) {
        const double a = own[k - 1] + (own[k] - own[k - 1]) * i / kPlaces,
                     b = own[k - 1] + (own[k] - own[k - 1]) * (i + 1) / kPlaces;
        const double va = curve.At(a).place.y(), vb = curve.At(b).place.y();
        const auto first = std::upper_bound(v_.begin(), v_.end(), std::min(va, vb));
        const auto last = std::lower_bound(v_.begin(), v_.end(), std::max(va, vb));
        for (auto line = first; line < last; ++line) breaks.push_back(Crossing(curve, a, b, va, *line));
      }
    }
    std::sort(breaks.begin(), breaks.end());
  }

  static double Crossing(const PlaceCurve& curve, double a, double b, double va, double line) {
    for (int round = 0; round < 48; ++round) {
      const double middle = 0.5 * (a + b);
      if ((curve.At(middle).place.y() < line) == (va < line)) {
        a = middle;
      } else {
        b = middle;
      }
    }
    return 0.5 * (a + b);
  }

  const Handle(Geom_Surface) surface_;
  std::vector<double> u_, v_;
};

}  // namespace

FaceIntegrals IntegrateFace(const Handle(Geom_Surface) & bare, const std::vector<SampledLoop>& loops) {
  const Integrator integrator(bare, ParametersOf(loops));
  std::vector<Integrator::Run> runs;
  double size = 0.0;
  for (const SampledLoop& loop : loops) {
    for (const SampledUse& use : loop) {
      runs.push_back(integrator.Estimate(use));
      for (const Sums& part : runs.back().parts) size += std::abs(part.x());
    }
  }
  Sums sums = Sums::Zero();
  for (const SampledLoop& loop : loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      sums += integrator.Between(loop[k].end(), loop[(k + 1) % loop.size()].begin());
    }
  }
  for (const Integrator::Run& run : runs) {
    sums += (run.use->forward ? 1.0 : -1.0) * integrator.Refine(run, kAgreement * size);
  }
  return {std::abs(sums.x()), sums.x() < 0.0 ? -sums.y() : sums.y()};
}

}  // namespace patchmill
