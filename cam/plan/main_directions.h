// Directions of lines in plan: angles from +x, in [0, pi).
#pragma once

#include <span>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

double AsDirection(double angle);  // of any angle, rad

// rad, in [0, pi/2]; of two directions.
double DirectionsApart(double a, double b);

// The main directions of a polyline that consists of these steps, at most `count`, the most frequent first.
// At least a tenth of the length runs within 3.75 degrees of each, and they are 15 degrees or more apart.
// Each is the mean direction of that length. A circle has none. Cost O(n count).
std::vector<double> MainDirections(std::span<const Vec2> steps, int count);

}  // namespace patchmill
