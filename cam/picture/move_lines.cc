#include "cam/picture/move_lines.h"

#include <algorithm>

#include <fmt/format.h>

namespace patchmill {

std::size_t StyleOf(const PreviewInput& input, const Move& move) {
  if (move.kind == MoveKind::kRapid) return kRapidStyle;
  if (move.kind != MoveKind::kCut) return kLinkStyle;
  const auto pass = static_cast<std::size_t>(std::max(0, move.pass));
  return pass < input.pass_kinds.size() ? static_cast<std::size_t>(input.pass_kinds[pass]) : 0;
}

void DrawMoves(const PreviewInput& input, const View& view, std::size_t style, double apart, SvgWriter& svg) {
  const Toolpath& path = *input.toolpath;
  const Vec3 tip(0, 0, -path.ball_radius);
  const MoveStyle& s = kMoveStyles[style];
  svg.OpenGroup(fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-opacity=\"{}\"{}",
                            s.color, style >= kLinkStyle ? 0.5 : 0.45, style == kRapidStyle ? 0.5 : 0.9,
                            *s.dash ? fmt::format(" stroke-dasharray=\"{}\"", s.dash) : std::string()));
  std::vector<Vec2> points;
  const auto flush = [&] {
    if (points.size() > 1) svg.Polyline(points, "");
    points.clear();
  };
  for (std::size_t i = 1; i < path.moves.size(); ++i) {
    if (StyleOf(input, path.moves[i]) != style) {
      flush();
      continue;
    }
    if (points.empty()) points.push_back(view(path.moves[i - 1].to + tip));
    const Vec2 q = view(path.moves[i].to + tip);
    const bool last = i + 1 == path.moves.size() || StyleOf(input, path.moves[i + 1]) != style;
    if (last || (q - points.back()).norm() >= apart) points.push_back(q);
  }
  flush();
  svg.CloseGroup();
}

}  // namespace patchmill
