// The functions whose zero curves divide the surface, on one piece, in its own parameters.
#pragma once

#include <array>
#include <optional>

#include "core/patch/piece.h"

namespace patchmill {

// Order matters: a silhouette (kTurn) is split first, because D changes its meaning across it (ALGORITHMS 12,
// iii).
enum class Field { kTurn = 0, kSlope = 1, kCurvature = 2, kReach = 3 };
inline constexpr int kFieldCount = 4;

// kTurn:      z component of the unit normal S_u x S_v / |..|; zero on silhouettes and vertical walls
// kSlope:     |e_z| - cos(steep angle); > 0 gentle
// kCurvature: contour curvature kappa_c with respect to S_u x S_v, 1/mm; times the sign of kTurn it is < 0 on
// mountains
struct FieldValues {
  std::array<double, 3> value{};
  Vec3 p = Vec3::Zero();
  bool degenerate = false;  // no normal here; values are 0
};
FieldValues EvaluateFields(const Piece& piece, double u, double v, double cos_steep);

// Values this small are rounding, not shape (unit normals and 1/mm on parts of ordinary size).
inline constexpr double kFieldNoise = 1e-9;

}  // namespace patchmill
