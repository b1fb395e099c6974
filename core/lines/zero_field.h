// A function of the jet whose zero curves on the surface are wanted: lines to draw, or borders of regions.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "core/lines/bernstein_form.h"
#include "core/patch/piece.h"

namespace patchmill {

// The part [u0,u1] x [v0,v1] of a piece's parameters.
struct ParameterBox {
  double u0 = 0.0, u1 = 1.0, v0 = 0.0, v1 = 1.0;
};

// A straight way in the parameters of a piece, from where a field is negative to where it is positive.
struct ZeroSegment {
  Vec2 from, to;
};

struct ZeroField {
  // Smooth fields: continuous, of both signs beside their zero curves, any unit. Others: the sign counts, 0
  // where the question does not apply. Thread-safe.
  std::function<double(const SurfaceJet&)> value;
  // The same at many places near each other, where that is faster. May be empty.
  std::function<void(std::span<const SurfaceJet>, std::span<double>)> values;
  // A polynomial over the net that vanishes wherever `value` does and, where it changes sign, makes `value`
  // change sign along all of the arc or nowhere on it; so where it has no zero `value` has none, and where
  // its zero set is one arc, that of `value` is this arc or nothing. Nothing: too costly. May be empty.
  std::function<std::optional<BernsteinForm>(const BernsteinNet&)> form;
  // The shares of such segments where the sign changes, to `resolution`, of a field that is not smooth and
  // has a better way than asking for signs. May be empty.
  std::function<void(const Piece&, std::span<const ZeroSegment>, std::span<double>)> limits;
  // For one piece: where the sign changes half way between two places where it does, a share t in
  // [least, most] of `across` from the middle of their chord, to `resolution`; for chords near each other,
  // one after the other. Nothing where it is not found that way. Of a field that is not smooth and has a
  // better way than asking for signs. May be empty.
  using Follow = std::function<std::optional<double>(const ZeroSegment& chord, const Vec2& across,
                                                     double least, double most)>;
  std::function<Follow(const Piece&)> follow;
  // A point of the closed box where curves of the field cross each other, or nothing. May be empty.
  std::function<std::optional<Vec2>(const Piece&, const ParameterBox&)> node;
  bool smooth = true;
  double noise = 1e-9;       // values up to this are rounding: sign 0
  double resolution = 0.01;  // mm: how exactly the limits of a field that is not smooth are placed
  // Counts only where this earlier field of a list has this sign, -1 or +1: elsewhere its curves are not cut
  // in, triangles have no sign of it, and one that is not smooth is asked
  // for there and on that field's curve alone: a limit may begin on it.
  int where = -1;
  std::int8_t where_sign = -1;
};

}  // namespace patchmill
