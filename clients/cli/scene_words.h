// What pages and pictures of a job call its regions, borders and passes, and the colours they give them.
#pragma once

#include <array>
#include <string>

#include "patchmill/v1/region.pb.h"

namespace patchmill::cli {

bool IsUnreached(const v1::Region& region);
// "3 basin, steep: 120.5 mm2", or "4 UNDERCUT: 12.3 mm2, 0.12 mm stays".
std::string RegionName(const v1::Region& region);
// As "#rrggbb": the colours of the SVG pictures (cam/plan/job_preview.cc). Mountains are red, basins blue
// and neutral areas green, steep ones stronger than gentle ones; what is out of reach has the colour of its
// reason.
std::string RegionColor(const v1::Region& region);

// "open edge".
std::string BorderName(v1::BorderKind kind);
const char* BorderColor(v1::BorderKind kind);

// By PassKind, less one.
inline constexpr std::array<const char*, 5> kPassNames = {"zig-zag", "contour", "border", "pencil", "rest"};

}  // namespace patchmill::cli
