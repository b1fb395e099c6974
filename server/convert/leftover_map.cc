#include "server/convert/leftover_map.h"

#include <iterator>

#include <fmt/format.h>

#include "cam/picture/leftover_picture.h"

namespace patchmill {

std::string LeftoverCsv(const std::vector<LeftoverPlace>& map, const Vec3& zero) {
  std::string csv = "x_mm,y_mm,z_mm,leftover_mm,patch\n";
  for (const LeftoverPlace& place : map) {
    const Vec3 p = place.point - zero;
    fmt::format_to(std::back_inserter(csv), "{:.4f},{:.4f},{:.4f},", p.x(), p.y(), p.z());
    if (place.leftover) fmt::format_to(std::back_inserter(csv), "{:.5f}", *place.leftover);
    fmt::format_to(std::back_inserter(csv), ",{}\n", place.patch_index);
  }
  return csv;
}

std::string LeftoverPng(const std::vector<LeftoverPlace>& map, double limit) {
  std::vector<LeftoverCell> cells;
  cells.reserve(map.size());
  for (const LeftoverPlace& place : map) cells.push_back({place.corners, place.leftover});
  return WritePng(DrawLeftover(cells, limit));
}

}  // namespace patchmill
