#include "cam/post/post_end.h"

#include <optional>

#include <fmt/format.h>

#include "cam/post/post_template.h"
#include "cam/post/program_lines.h"

namespace patchmill {
namespace {

// Values that stand for any.
PostValues AnyValues(const Dialect& dialect) {
  PostValues values;
  values.program = "0001";
  values.work_offset = "G54";
  values.tool = "1";
  values.speed = "1000";
  values.path = dialect.exact_path;
  values.tolerance = "0.01";
  values.x = values.y = values.z = "0.";
  values.unit = dialect.unit_word[ProgramUnit::kMillimeter];
  values.top = "0.";
  return values;
}

// A group of modal words and the line that set it last.
struct LastMode {
  int code = -1;
  std::size_t index = 0;
};

}  // namespace

std::vector<UnexpectedMode> UnexpectedModes(const Dialect& dialect, const std::vector<std::string>& lines) {
  if (dialect.syntax == Syntax::kKlartext) return {};  // every line of motion states its kind
  const PostValues values = AnyValues(dialect);
  ProgramLines reader(dialect);
  LastMode motion, distance;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (lines[k] == kHeaderLine) continue;
    const std::optional<std::string> line = FillTemplate(lines[k], values);
    if (!line) continue;
    const auto block = reader.Read(*line);
    if (!block.ok() || !block->has_value()) continue;
    if ((*block)->motion) motion = {*(*block)->motion, k};
    if ((*block)->distance) distance = {*(*block)->distance, k};
  }
  std::vector<UnexpectedMode> unexpected;
  if (motion.code > 0) {
    unexpected.push_back(
        {motion.index, fmt::format("G{} is in force after it, and the moves of the path begin with a "
                                   "rapid that does not state G0: end with G0",
                                   motion.code / 10)});
  }
  if (distance.code == 910) {
    unexpected.push_back(
        {distance.index, "G91 is in force after it, and the moves of the path are absolute: end with G90"});
  }
  return unexpected;
}

}  // namespace patchmill
