#include "cam/picture/pass_order.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

#include <fmt/format.h>

namespace patchmill {
namespace {

constexpr double kShortest = 14.0, kApart = 12.0;  // px

// Places of the picture of which no two are nearer to each other than kApart.
class Spread {
 public:
  bool Add(const Vec2& at) {
    const auto cell = [](double x) { return static_cast<std::int64_t>(std::floor(x / kApart)); };
    const std::int64_t column = cell(at.x()), row = cell(at.y());
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        const auto found = cells_.find(Key(column + dx, row + dy));
        if (found != cells_.end() && (found->second - at).norm() < kApart) return false;
      }
    }
    cells_.emplace(Key(column, row), at);
    return true;
  }

 private:
  static std::int64_t Key(std::int64_t column, std::int64_t row) { return column * 1'000'003 + row; }
  std::unordered_map<std::int64_t, Vec2> cells_;  // a cell holds at most one: its diagonal is longer
};

Vec3 TipOf(const Toolpath& toolpath, std::size_t move) {
  return toolpath.moves[move].to - Vec3(0, 0, toolpath.ball_radius);
}

// The moves first to last (inclusive) in the view, arcs as chords.
std::vector<Vec2> LineOf(const Toolpath& toolpath, std::size_t first, std::size_t last, const View& view) {
  constexpr double kSagitta = 0.05;  // mm
  std::vector<Vec2> line = {view(TipOf(toolpath, first - 1))};
  for (std::size_t k = first; k <= last; ++k) {
    const Move& move = toolpath.moves[k];
    std::vector<Vec3> places = {move.to};
    if (move.arc) places = ChordEnds(*move.arc, {toolpath.moves[k - 1].to, move.to}, kSagitta);
    for (const Vec3& place : places) line.push_back(view(place - Vec3(0, 0, toolpath.ball_radius)));
  }
  return line;
}

// The middle of the line; no direction if it is too short.
PassArrow MiddleOf(const std::vector<Vec2>& line) {
  double length = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k) length += (line[k] - line[k - 1]).norm();
  if (length < kShortest) return {};
  double left = 0.5 * length;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Vec2 way = line[k] - line[k - 1];
    if (way.norm() >= left && way.norm() > 0.0)
      return {line[k - 1] + left * way.normalized(), way.normalized()};
    left -= way.norm();
  }
  return {};
}

}  // namespace

std::vector<PassArrow> ArrowsOf(const Toolpath& toolpath, const View& view) {
  std::vector<PassArrow> arrows;
  Spread spread;
  const std::vector<Move>& moves = toolpath.moves;
  for (std::size_t first = 1; first < moves.size();) {
    std::size_t next = first + 1;
    while (next < moves.size() && moves[next].pass == moves[first].pass) ++next;
    if (moves[first].pass >= 0) {
      const PassArrow arrow = MiddleOf(LineOf(toolpath, first, next - 1, view));
      if (!arrow.direction.isZero() && spread.Add(arrow.at)) arrows.push_back(arrow);
    }
    first = next;
  }
  return arrows;
}

std::vector<Vec2> StartsOf(const Toolpath& toolpath, const std::vector<int>& passes, const View& view) {
  std::vector<Vec2> starts;
  for (std::size_t k = 1; k < toolpath.moves.size() && starts.size() < passes.size(); ++k) {
    if (toolpath.moves[k].pass == passes[starts.size()]) starts.push_back(view(TipOf(toolpath, k - 1)));
  }
  return starts;
}

void DrawPassOrder(const PreviewInput& input, const View& view, SvgWriter& svg) {
  constexpr double kLong = 6.0, kWide = 2.2;  // px
  svg.OpenGroup("fill=\"#101010\" fill-opacity=\"0.75\" stroke=\"none\"");
  for (const PassArrow& arrow : ArrowsOf(*input.toolpath, view)) {
    const Vec2 d = arrow.direction, side(-d.y(), d.x());
    svg.Polygon({arrow.at + 0.5 * kLong * d, arrow.at - 0.5 * kLong * d + kWide * side,
                 arrow.at - 0.5 * kLong * d - kWide * side},
                "");
  }
  svg.CloseGroup();
  const std::vector<Vec2> starts = StartsOf(*input.toolpath, input.section_passes, view);
  Spread spread;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    if (!spread.Add(starts[k])) continue;
    svg.Circle(starts[k], 7.0, "fill=\"#fffbe0\" stroke=\"#101010\" stroke-width=\"0.8\"");
    svg.Text(starts[k] + Vec2(0, 3), 8, fmt::format("{}", k + 1), "text-anchor=\"middle\"");
  }
}

}  // namespace patchmill
