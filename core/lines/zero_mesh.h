// Cuts one piece of a surface into triangles along the zero curves of several fields [lines, section 4].
// Signs at vertices decide what is connected. Vertices on a curve lie on the true curve.
//
// A quadtree over the piece is divided until, for every field with a form, each cell is proven to hold no
// zero, or a single arc that meets each side at most once. So no curve inside the piece is lost down to the
// smallest cell. Fields without a form are seen through their signs at points of the cells, max_cell / 2
// apart, so narrower loops may be missed. Nodes that a field knows become vertices.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/run_context.h"
#include "core/lines/zero_field.h"

namespace patchmill {

inline constexpr int kMaxZeroFields = 11;
using ZeroFieldBits = std::uint16_t;  // bit k: field k

struct ZeroVertex {
  double u = 0.0, v = 0.0;
  Vec3 p = Vec3::Zero();
  std::array<std::int8_t, kMaxZeroFields> sign{};  // -1, 0, +1
  ZeroFieldBits on = 0;                            // bit k: lies on the zero curve of field k
  ZeroFieldBits known = 0;                         // bit k: sign[k] is known
};

struct ZeroTriangle {
  std::array<int, 3> vertex{};                     // counter-clockwise in (u,v)
  std::array<std::int8_t, kMaxZeroFields> sign{};  // sign of each field on it; 0 if all values are rounding
                                                   // or the field does not count there
};

struct ZeroMesh {
  std::vector<ZeroVertex> vertices;  // some may belong to no triangle
  std::vector<ZeroTriangle> triangles;
};

struct ZeroMeshParams {
  double max_turn = 0.35;  // rad, turn of the normal across a cell, estimated
  double max_cell = 1.0;   // mm, largest side of a cell
  double min_cell = 0.1;   // mm; cells are not divided below about this side, nor below 1/128 of a piece
  // Leaves out cells where every field is proven to have one sign. This is enough to draw curves; the
  // triangles do not cover the piece.
  bool curves_only = false;
  // Divides no cell because of a form that is negligible all over it (BernsteinForm). Otherwise vertical
  // walls and flat plates from files with few digits would be divided down to the smallest cell.
  bool skip_negligible = false;
  // Polled if set. A mesh that was cancelled is incomplete and must not be used.
  const RunContext* run = nullptr;
};

// Cuts along fields[0], then fields[1], ... (at most kMaxZeroFields). Deterministic. Cost: some microseconds
// per cell, and the evaluation of the fields at 2 to 4 points of it.
ZeroMesh BuildZeroMesh(const Piece& piece, std::span<const ZeroField> fields, const ZeroMeshParams& params);

// The zero curve of `field` between two points on it, as parameter points without the ends. They are so dense
// that chords deviate by at most `tolerance` (mm). Where no root is found on the perpendicular, the chord
// stays.
std::vector<Vec2> RefineZeroArc(const Piece& piece, const ZeroField& field, const Vec2& from, const Vec2& to,
                                double tolerance);
// The same for many chords. Faster for fields with `values`.
std::vector<std::vector<Vec2>> RefineZeroArcs(const Piece& piece, const ZeroField& field,
                                              std::span<const ZeroSegment> chords, double tolerance);

}  // namespace patchmill
