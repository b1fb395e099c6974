#include "core/io/strokes.h"

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/io/text_scanner.h"

namespace patchmill {

absl::StatusOr<std::vector<std::vector<Vec3>>> ReadStrokes(std::string_view text) {
  TextScanner scanner(text, '#');
  std::vector<std::vector<Vec3>> strokes;
  int total = 0;
  while (!scanner.AtEnd()) {
    PM_ASSIGN_OR_RETURN(const std::string_view word, scanner.Word("v"));
    if (word != "v") {
      return scanner.Fail(fmt::format(
          "{} where a stroke begins; it begins with \"v\" and the number of its points", Quoted(word)));
    }
    if (strokes.size() == static_cast<std::size_t>(kMaxStrokes)) {
      return scanner.Fail(fmt::format("more than {} strokes", kMaxStrokes));
    }
    PM_ASSIGN_OR_RETURN(const int count, scanner.Integer("number of points", 1, kMaxStrokePoints));
    total += count;
    if (total > kMaxStrokePoints)
      return scanner.Fail(fmt::format("more than {} points in all", kMaxStrokePoints));
    std::vector<Vec3>& stroke = strokes.emplace_back();
    for (int k = 0; k < count; ++k) {
      PM_ASSIGN_OR_RETURN(const Vec3 point, scanner.Point());
      stroke.push_back(point);
    }
  }
  if (strokes.empty()) return scanner.Fail("the text holds no stroke");
  return strokes;
}

}  // namespace patchmill
