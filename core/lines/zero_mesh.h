// One piece of a surface cut into triangles along the zero curves of several fields [lines, section 4]: what
// is connected is decided by signs at vertices, and vertices on a curve lie on the true one.
//
// A quadtree over the piece is divided until, for every field with a form, each cell is proven to hold no
// zero or a single arc that meets each side once at most; so no curve is lost inside the piece down to the
// smallest cell. Fields without form are seen through their signs at points of the cells, max_cell / 2 apart:
// loops narrower than that may be missed. Nodes that a field knows of become vertices.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/run_context.h"
#include "core/lines/zero_field.h"

namespace patchmill {

inline constexpr int kMaxZeroFields = 10;
using ZeroFieldBits = std::uint16_t;  // bit k: of field k

struct ZeroVertex {
  double u = 0.0, v = 0.0;
  Vec3 p = Vec3::Zero();
  std::array<std::int8_t, kMaxZeroFields> sign{};  // -1, 0, +1
  ZeroFieldBits on = 0;                            // bit k: lies on the zero curve of field k
  ZeroFieldBits known = 0;                         // bit k: sign[k] has been asked for
};

struct ZeroTriangle {
  std::array<int, 3> vertex{};                     // counter-clockwise in (u,v)
  std::array<std::int8_t, kMaxZeroFields> sign{};  // of each field on it; 0: nothing but rounding,
                                                   // or the field does not count there
};

struct ZeroMesh {
  std::vector<ZeroVertex> vertices;  // some may belong to no triangle
  std::vector<ZeroTriangle> triangles;
};

struct ZeroMeshParams {
  double max_turn = 0.35;  // rad, of the normal across a cell, estimated
  double max_cell = 1.0;   // mm, side of a cell
  double min_cell = 0.1;   // mm: cells are not divided below about this side, nor below 1/128 of a piece
  // Leaves out cells where every field is proven to have one sign: enough to draw curves, no tiling.
  bool curves_only = false;
  // Divides no cell for the sake of a form that is negligible all over it (BernsteinForm): vertical walls and
  // flat plates of files with few digits would be divided to the last.
  bool skip_negligible = false;
  // Polled when set: a mesh that was cancelled is cut short and means nothing.
  const RunContext* run = nullptr;
};

// Cuts along fields[0], then fields[1], ... (at most kMaxZeroFields). Deterministic. Cost: some microseconds
// a cell and what the fields cost at 2 to 4 points of it.
ZeroMesh BuildZeroMesh(const Piece& piece, std::span<const ZeroField> fields, const ZeroMeshParams& params);

// The zero curve of `field` between two points on it, as parameter points without the ends, so dense that
// chords keep to `tolerance` (mm). Where the root is not found on the perpendicular the chord stays.
std::vector<Vec2> RefineZeroArc(const Piece& piece, const ZeroField& field, const Vec2& from, const Vec2& to,
                                double tolerance);
// The same of many chords, faster for fields that answer many questions at once.
std::vector<std::vector<Vec2>> RefineZeroArcs(const Piece& piece, const ZeroField& field,
                                              std::span<const ZeroSegment> chords, double tolerance);

}  // namespace patchmill
