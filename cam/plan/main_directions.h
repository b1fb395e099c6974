// Directions of lines in plan: angles from +x, in [0, pi).
#pragma once

#include <span>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

double AsDirection(double angle);  // of any angle, rad

// rad, in [0, pi/2]; of two directions.
double DirectionsApart(double a, double b);

// In which directions most of a way runs that consists of these steps, the one of most first, `count` at
// most: those that a tenth of its length keeps to within 3.75 degrees, 15 degrees apart or more. Each is the
// mean of what keeps to it. None for a circle. Cost O(n count).
std::vector<double> MainDirections(std::span<const Vec2> steps, int count);

}  // namespace patchmill
