// The moves of a program in a view, by what they are for.
#pragma once

#include <array>

#include "cam/picture/preview.h"
#include "cam/picture/svg_writer.h"
#include "cam/picture/view.h"

namespace patchmill {

struct MoveStyle {
  const char* name;
  const char* color;
  const char* dash;
};

// Those of cuts are pass kinds, in their order.
inline constexpr std::array<MoveStyle, 7> kMoveStyles{{{"zig-zag passes", "#1f4e9c", ""},
                                                       {"contour passes", "#9c2f1f", ""},
                                                       {"border passes", "#5d7a00", ""},
                                                       {"crease passes", "#7a1fa2", ""},
                                                       {"rest passes", "#00796b", ""},
                                                       {"links and leads", "#e09000", "2,1.5"},
                                                       {"rapids", "#d0208f", "4,3"}}};
inline constexpr std::size_t kRapidStyle = kMoveStyles.size() - 1, kLinkStyle = kRapidStyle - 1;
static_assert(static_cast<std::size_t>(PassKind::kRest) + 1 == kLinkStyle);

// Which of them a move is drawn in.
std::size_t StyleOf(const PreviewInput& input, const Move& move);

// Moves of one style as polylines of tip positions, vertices closer than `apart` px dropped.
void DrawMoves(const PreviewInput& input, const View& view, std::size_t style, double apart, SvgWriter& svg);

}  // namespace patchmill
