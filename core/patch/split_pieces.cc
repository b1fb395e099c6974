#include "core/patch/split_pieces.h"

#include "core/patch/bulge.h"
#include "core/patch/condition_pieces.h"
#include "core/patch/kinds.h"

namespace patchmill {
namespace {

// Non-empty spans of the domain.
std::size_t CountSpans(const SplineDirection& d) {
  const auto p = static_cast<std::size_t>(d.degree);
  std::size_t count = 0;
  for (std::size_t k = p; k + p + 1 < d.knots.size(); ++k) count += d.knots[k] < d.knots[k + 1];
  return count;
}

bool IsDegree(int degree) { return degree >= 1 && degree <= kMaxDegree; }

}  // namespace

std::vector<Piece> SplitIntoPieces(PatchId id, const PatchShape& shape, const RunContext& run) {
  std::vector<Piece> pieces = std::visit(
      [&run](const auto& s) {
        if constexpr (requires { internal::ShapePieces(s, run); }) {
          return internal::ShapePieces(s, run);
        } else {
          return internal::ShapePieces(s);
        }
      },
      shape);
  if (std::holds_alternative<BezierPatch>(shape) || std::holds_alternative<BsplinePatch>(shape))
    pieces = internal::ConditionPieces(std::move(pieces));
  const bool bulged = std::visit(
      [&pieces](const auto& s) {
        if constexpr (requires { s.bulges; }) {
          if (s.bulges.empty()) return false;
          pieces = internal::WithBulges(pieces, s.bulges, internal::NetWeight(s));
          return true;
        } else {
          return false;
        }
      },
      shape);
  const bool singular = std::visit([](const auto& s) { return internal::HasSingularNet(s); }, shape);
  for (Piece& piece : pieces) {
    piece.patch = id;
    piece.gregory = bulged ? nullptr : std::get_if<GregoryPatch>(&shape);
    if (singular && piece.gregory == nullptr) piece.shape = &shape;
  }
  return pieces;
}

std::size_t CountSplinePiecePoints(const SplineDirection& u, const SplineDirection& v) {
  if (!IsDegree(u.degree) || !IsDegree(v.degree)) return 0;
  return CountSpans(u) * CountSpans(v) * static_cast<std::size_t>((u.degree + 1) * (v.degree + 1));
}

}  // namespace patchmill
