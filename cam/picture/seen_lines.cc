#include "cam/picture/seen_lines.h"

namespace patchmill {
namespace {

constexpr double kDot = 1.5;    // px, dot of the depth map
constexpr double kSlack = 3.0;  // in dots; allowed depth, because facets deviate from the surface
constexpr double kApart = 0.6;  // px; closer vertices are dropped

}  // namespace

SeenLines::SeenLines(const Surface& surface, const View& view, const Vec2& corner, const Vec2& size,
                     int cells)
    : view_(view),
      depth_(surface, view, {corner, size.x(), size.y(), kDot}, cells),
      slack_(kSlack * kDot / view.scale) {}

bool SeenLines::Sees(const Vec3& p) const { return depth_.Visible(p, slack_); }

void SeenLines::Draw(const std::vector<Vec3>& line, SvgWriter& svg) const {
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (!Sees(line[i])) {
      if (points.size() > 1) svg.Polyline(points, "");
      points.clear();
      continue;
    }
    const Vec2 q = view_(line[i]);
    if (points.empty() || i + 1 == line.size() || (q - points.back()).norm() >= kApart) points.push_back(q);
  }
  if (points.size() > 1) svg.Polyline(points, "");
}

}  // namespace patchmill
