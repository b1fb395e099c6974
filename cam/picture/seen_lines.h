// Draws lines in a view without the parts that the surface hides.
#pragma once

#include <vector>

#include "cam/picture/depth_map.h"
#include "cam/picture/svg_writer.h"

namespace patchmill {

class SeenLines {
 public:
  // The view fills `size` px from `corner`. `cells` is the number of hiding facets along each side of a
  // piece.
  SeenLines(const Surface& surface, const View& view, const Vec2& corner, const Vec2& size, int cells);

  // Draws the parts of the polyline that are not hidden. Vertices closer than 0.6 px are dropped.
  void Draw(const std::vector<Vec3>& line, SvgWriter& svg) const;
  bool Sees(const Vec3& p) const;

 private:
  View view_;
  DepthMap depth_;
  double slack_;
};

}  // namespace patchmill
