#include "cam/picture/move_lines.h"

#include <algorithm>

#include <fmt/format.h>

namespace patchmill {

namespace {

constexpr double kArcSagitta = 0.01;  // mm, of the chords that an arc is drawn with

MoveLine LineOf(PassKind kind) {
  switch (kind) {
    case PassKind::kZigzag:
      return MoveLine::kZigzag;
    case PassKind::kContour:
      return MoveLine::kContour;
    case PassKind::kBorder:
      return MoveLine::kBorder;
    case PassKind::kPencil:
      return MoveLine::kCrease;
    case PassKind::kRest:
      return MoveLine::kRest;
  }
  return MoveLine::kZigzag;
}

}  // namespace

MoveLine LineOf(const PreviewInput& input, const Move& move) {
  if (move.kind == MoveKind::kRapid) return MoveLine::kRapid;
  if (move.kind != MoveKind::kCut) return MoveLine::kLink;
  const auto pass = static_cast<std::size_t>(std::max(0, move.pass));
  return pass < input.pass_kinds.size() ? LineOf(input.pass_kinds[pass]) : MoveLine::kZigzag;
}

void DrawMoves(const PreviewInput& input, const View& view, MoveLine line, double apart, SvgWriter& svg) {
  const Toolpath& path = *input.toolpath;
  const Vec3 tip(0, 0, -path.ball_radius);
  const MoveStyle& s = kMoveStyles[line];
  const bool is_rapid = line == MoveLine::kRapid, is_cut = !is_rapid && line != MoveLine::kLink;
  svg.OpenGroup(fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-opacity=\"{}\"{}",
                            s.color, is_cut ? 0.45 : 0.5, is_rapid ? 0.5 : 0.9,
                            *s.dash ? fmt::format(" stroke-dasharray=\"{}\"", s.dash) : std::string()));
  std::vector<Vec2> points;
  const auto flush = [&] {
    if (points.size() > 1) svg.Polyline(points, "");
    points.clear();
  };
  for (std::size_t i = 1; i < path.moves.size(); ++i) {
    if (LineOf(input, path.moves[i]) != line) {
      flush();
      continue;
    }
    if (points.empty()) points.push_back(view(path.moves[i - 1].to + tip));
    const Move& move = path.moves[i];
    const bool last = i + 1 == path.moves.size() || LineOf(input, path.moves[i + 1]) != line;
    std::vector<Vec3> places = {move.to};
    if (move.arc) places = ChordEnds(*move.arc, {path.moves[i - 1].to, move.to}, kArcSagitta);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const Vec2 q = view(places[k] + tip);
      const bool end = last && k + 1 == places.size();
      if (end || (q - points.back()).norm() >= apart) points.push_back(q);
    }
  }
  flush();
  svg.CloseGroup();
}

}  // namespace patchmill
