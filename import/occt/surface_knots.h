// The knots of a surface within a range of parameters.
#pragma once

#include <vector>

#include <Geom_Surface.hxx>
#include <Standard_Handle.hxx>

namespace patchmill {

struct ParameterRange {
  double low = 0.0, high = 0.0;
};

// Both ends of the range, low < high, and between them the parameters where the surface is not smooth along
// u (or v), of a periodic surface those of two turns to either side, too. Increasing; those closer to each
// other than 1e-9 of the range count once. May throw Standard_Failure.
std::vector<double> KnotsWithin(const Handle(Geom_Surface) & surface, const ParameterRange& range,
                                bool along_u);

}  // namespace patchmill
