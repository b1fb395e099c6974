#include "import/occt/surface_knots.h"

#include <algorithm>

#include <GeomAdaptor_Surface.hxx>
#include <TColStd_Array1OfReal.hxx>

namespace patchmill {

std::vector<double> KnotsWithin(const Handle(Geom_Surface) & surface, const ParameterRange& range,
                                bool along_u) {
  constexpr double kSameKnot = 1e-9;  // of the range
  const GeomAdaptor_Surface adaptor(surface);
  const int count = along_u ? adaptor.NbUIntervals(GeomAbs_CN) : adaptor.NbVIntervals(GeomAbs_CN);
  TColStd_Array1OfReal at(1, count + 1);
  if (along_u) {
    adaptor.UIntervals(at, GeomAbs_CN);
  } else {
    adaptor.VIntervals(at, GeomAbs_CN);
  }
  const bool turns = along_u ? surface->IsUPeriodic() : surface->IsVPeriodic();
  const double period = !turns ? 0.0 : (along_u ? surface->UPeriod() : surface->VPeriod());
  const double close = kSameKnot * (range.high - range.low);
  std::vector<double> inner;
  for (int turn = turns ? -2 : 0; turn <= (turns ? 2 : 0); ++turn) {
    for (const double x : at) {
      const double moved = x + turn * period;
      if (moved > range.low + close && moved < range.high - close) inner.push_back(moved);
    }
  }
  std::sort(inner.begin(), inner.end());
  std::vector<double> knots = {range.low};
  for (const double x : inner) {
    if (x - knots.back() > close) knots.push_back(x);
  }
  knots.push_back(range.high);
  return knots;
}

}  // namespace patchmill
