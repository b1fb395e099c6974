// A function of the jet whose zero curves on the surface are wanted, as lines to draw or as borders of
// regions.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "core/lines/bernstein_form.h"
#include "core/patch/piece.h"

namespace patchmill {

// A straight segment in the parameters of a piece. The field is negative at `from` and positive at `to`.
struct ZeroSegment {
  Vec2 from, to;
};

struct ZeroField {
  // A smooth field is continuous and has both signs beside its zero curves, in any unit. Of other fields only
  // the sign counts; 0 means that the field does not apply. Thread-safe.
  std::function<double(const SurfaceJet&)> value;
  // The same at many places near each other. May be empty; set it if it is faster.
  std::function<void(std::span<const SurfaceJet>, std::span<double>)> values;
  // A polynomial over the net. It vanishes wherever `value` does. Where it changes sign, `value` changes sign
  // along all of the arc or nowhere on it. So where the form has no zero, `value` has none; where its zero
  // set is one arc, that of `value` is this arc or nothing. Returns nullopt if the form is too costly. May be
  // empty.
  std::function<std::optional<BernsteinForm>(const BernsteinNet&)> form;
  // For a field that is not smooth and can find its limits better than by signs: the shares of the segments
  // at which the sign changes, to `resolution`. May be empty.
  std::function<void(const Piece&, std::span<const ZeroSegment>, std::span<double>)> limits;
  // For a field that is not smooth and can follow its limit better than by signs. For one piece: the share t
  // of `across`, in [least, most], from the middle of a chord to the limit, to `resolution`. The ends of the
  // chord lie on the limit. Chords near each other should be passed one after the other. nullopt if the limit
  // is not found that way. May be empty.
  using Follow = std::function<std::optional<double>(const ZeroSegment& chord, const Vec2& across,
                                                     double least, double most)>;
  std::function<Follow(const Piece&)> follow;
  // A point of the closed box where curves of the field cross each other, or nullopt. May be empty.
  std::function<std::optional<Vec2>(const Piece&, const ParameterBox&)> node;
  bool smooth = true;
  double noise = 1e-9;       // smaller values are rounding and have the sign 0
  double resolution = 0.01;  // mm; accuracy of the limits of a field that is not smooth
  // This field counts only where the earlier field `where` of a list has the sign `where_sign` (-1 or +1).
  // Elsewhere its curves are not cut in, and triangles have no sign of it. If it is not smooth, it is
  // evaluated only there and on the zero curve of that field, where a limit may begin.
  int where = -1;
  std::int8_t where_sign = -1;
};

}  // namespace patchmill
