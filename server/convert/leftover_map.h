// What a program leaves over the part -> files for users.
#pragma once

#include <string>
#include <vector>

#include "cam/verify/verify.h"
#include "core/base/vec.h"

namespace patchmill {

// One line for each place: x_mm,y_mm,z_mm (program frame), leftover_mm, patch (its index in the model). The
// leftover is empty where the ball does not reach. The first line has the names of the columns.
std::string LeftoverCsv(const std::vector<LeftoverPlace>& map, const Vec3& zero);

// The picture from above as PNG (DrawLeftover). `limit` > 0 is the leftover that is allowed, mm.
std::string LeftoverPng(const std::vector<LeftoverPlace>& map, double limit);

}  // namespace patchmill
