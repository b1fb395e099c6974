// Draws the moves of a program in a view, by their purpose.
#pragma once

#include "cam/picture/preview.h"
#include "cam/picture/svg_writer.h"
#include "cam/picture/view.h"
#include "core/base/enum_array.h"

namespace patchmill {

// How a move is drawn. A cut is drawn by the kind of its pass.
enum class MoveLine { kZigzag, kContour, kBorder, kCrease, kRest, kLink, kRapid };
constexpr MoveLine LastOf(MoveLine) { return MoveLine::kRapid; }

struct MoveStyle {
  const char* name;
  const char* color;
  const char* dash;
  bool operator==(const MoveStyle&) const = default;
};

inline constexpr EnumArray<MoveLine, MoveStyle> kMoveStyles{{{{"zig-zag passes", "#1f4e9c", ""},
                                                              {"contour passes", "#9c2f1f", ""},
                                                              {"border passes", "#5d7a00", ""},
                                                              {"pencil passes", "#7a1fa2", ""},
                                                              {"rest passes", "#00796b", ""},
                                                              {"links and leads", "#e09000", "2,1.5"},
                                                              {"rapids", "#d0208f", "4,3"}}}};

MoveLine LineOf(const PreviewInput& input, const Move& move);

// Draws the moves of one kind as polylines of the tip. Vertices that are closer than `apart` px are dropped.
void DrawMoves(const PreviewInput& input, const View& view, MoveLine line, double apart, SvgWriter& svg);

}  // namespace patchmill
