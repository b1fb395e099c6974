// libFuzzer: any bytes as a post file. What is accepted must write a program that the reader ends on.
// Build with the preset `fuzz`; seeds in cam/post/dialects.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "cam/post/dialect.h"
#include "cam/post/program_reader.h"
#include "cam/post/program_writer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace patchmill;
  const auto dialect = ParseDialect(std::string_view(reinterpret_cast<const char*>(data), size));
  if (!dialect.ok()) return 0;
  Toolpath path;
  path.ball_radius = 3.0;
  path.moves = {{.kind = MoveKind::kRapid, .to = Vec3(1, 2, 23)},
                {.kind = MoveKind::kPlunge, .to = Vec3(1, 2, 3), .feed = 400.0},
                {.kind = MoveKind::kCut, .to = Vec3(9, 2, 3), .feed = 1200.0},
                {.kind = MoveKind::kRapid, .to = Vec3(9, 2, 23)}};
  Tool tool;
  tool.cutter = BallEnd{3.0};
  tool.spindle_rpm = 12000;
  PostParams params;
  params.dialect = *dialect;
  params.clearance_z = 20.0;
  params.header = {"part: any (part)"};
  params.sections = {
      {.first_move = 0, .comment = "first"},
      {.first_move = 3, .comment = "last", .tip = {{-1.5, 2.0}}, .continued = true, .restart = true}};
  params.restart_points = !dialect->restart.empty();
  const auto program = WriteProgram(path, tool, params);
  if (!program.ok()) __builtin_trap();
  (void)ReadProgram(*program, {.max_moves = 1000, .dialect = *dialect});
  return 0;
}
