#include "cam/verify/validate.h"

#include <cmath>

#include <fmt/format.h>

namespace patchmill {

absl::Status ValidateVerifyInput(const Surface& surface, const Tool& tool, const ProgramMotion& motion,
                                 const VerifyParams& params) {
  const auto bad = [](const char* field, double value, const char* constraint) {
    return absl::InvalidArgumentError(fmt::format("{} = {:.6g} mm; must be {}", field, value, constraint));
  };
  const double radius = BallRadius(tool);
  if (!(radius > 0.0) || !std::isfinite(radius)) return bad("tool.ball.radius", radius, "> 0");
  if (!(params.tolerance > 0.0) || !(params.tolerance < radius))
    return bad("tolerance", params.tolerance, "in (0, ball radius)");
  if (!(params.certainty > 0.0)) return bad("certainty", params.certainty, "> 0");
  if (!(params.leave >= 0.0) || !std::isfinite(params.leave)) return bad("leave", params.leave, ">= 0");
  for (const double allowance : {params.allowance.walls, params.allowance.floors}) {
    if (!(allowance >= 0.0) || !std::isfinite(allowance)) return bad("allowance", allowance, ">= 0");
  }
  const auto sound = [&](const Finish& finish) {
    return !finish.scallop || (*finish.scallop > 0.0 && *finish.scallop < radius);
  };
  if (!sound(params.finish)) return bad("scallop", *params.finish.scallop, "in (0, ball radius)");
  for (const FinishPart& part : params.parts) {
    if (!sound(part.finish)) return bad("parts.scallop", *part.finish.scallop, "in (0, ball radius)");
    if (part.where != nullptr && part.where->pieces() != surface.pieces.size()) {
      return absl::InvalidArgumentError("parts.where: pieces of another surface");
    }
  }
  if (!params.program_zero.allFinite() || !std::isfinite(params.stock_top_z) || std::isnan(params.floor_z)) {
    return absl::InvalidArgumentError("program zero, stock top or floor is not a number");
  }
  if (tool.shank_diameter && *tool.shank_diameter > 2.0 * radius && !tool.flute_length) {
    return bad("tool.shank_diameter", *tool.shank_diameter,
               "no wider than the ball unless flute_length says where the shank begins");
  }
  if (!tool.holder.empty() && !tool.stickout)
    return absl::InvalidArgumentError("tool.holder: tool.stickout must say where it begins");
  const Containment& c = params.containment;
  const std::size_t patches = surface.network.model.patches.size();
  if ((!c.selected.empty() && c.selected.size() != patches) ||
      (!c.avoided.empty() && c.avoided.size() != patches)) {
    return absl::InvalidArgumentError("containment: patches of another model");
  }
  if (motion.moves.empty()) return absl::InvalidArgumentError("program: no motion");
  return absl::OkStatus();
}

}  // namespace patchmill
