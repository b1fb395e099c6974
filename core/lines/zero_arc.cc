#include <array>
#include <optional>

#include "core/base/segment.h"
#include "core/lines/zero_mesh.h"
#include "core/lines/zero_root.h"

namespace patchmill {
namespace {

constexpr int kMostHalvings = 12;

// A chord between two places of a piece, and its ends in space.
struct Chord {
  Vec2 from, to;
  Vec3 a, b;
  double length() const { return (b - a).norm(); }
};

class Refiner {
 public:
  Refiner(const Piece& piece, const ZeroField& field, double tolerance)
      : piece_(piece), field_(field), tolerance_(tolerance) {
    if (field.follow) follow_ = field.follow(piece);
  }

  // Two places beside the point `at` of the chord, one on each side and within the tolerance of the
  // chord. If the curve is straight there, it passes between them.
  std::optional<std::array<Vec2, 2>> Beside(const Chord& chord, double at) const {
    const Vec2 along = chord.to - chord.from, mid = chord.from + at * along;
    const Vec2 across = 0.7 * tolerance_ * Across(mid, along, chord.length());
    const Vec2 one = mid + Inside(mid, across) * across, other = mid - Inside(mid, -across) * across;
    if (!Near(one, chord) || !Near(other, chord)) return std::nullopt;
    return std::array{one, other};
  }
  Vec3 At(const Vec2& q) const { return Position(piece_, q.x(), q.y()); }

  // The first chord is tested in three places, because an arc with two bends may cross it in the middle.
  void AddFirst(const Vec2& from, const Vec2& to, std::vector<Vec2>& out) const {
    const Chord chord{from, to, At(from), At(to)};
    if (chord.length() <= tolerance_) return;
    double at_mid = 0.0;
    if (Straight(chord, 0.5, &at_mid) &&
        (!field_.smooth || (Straight(chord, 0.25) && Straight(chord, 0.75)))) {
      return;
    }
    AddBent(from, to, at_mid, out);
  }

  // For a chord that is known not to be straight. `at_mid` is the value at its middle, 0 if it is not known.
  void AddBent(const Vec2& from, const Vec2& to, double at_mid, std::vector<Vec2>& out) const {
    std::optional<Vec2> root = Followed(from, to);
    if (!root) root = OnPerpendicular(from, to, (At(to) - At(from)).norm(), at_mid);
    if (!root) return;
    Add(from, *root, kMostHalvings, out);
    out.push_back(*root);
    Add(*root, to, kMostHalvings, out);
  }

 private:
  bool Near(const Vec2& q, const Chord& chord) const {
    return SegmentDistance(At(q), chord.a, chord.b) <= tolerance_;
  }
  // A step of 1 mm on the surface, at right angles to the direction `along`. A right angle in the parameters
  // would be another direction and another length.
  Vec2 Across(const Vec2& at, const Vec2& along, double length) const {
    const SurfaceJet jet = Evaluate(piece_, at.x(), at.y());
    const Vec3 tangent = along.x() * jet.du + along.y() * jet.dv;
    const Vec2 across(-tangent.dot(jet.dv), tangent.dot(jet.du));
    const double millimetres = (across.x() * jet.du + across.y() * jet.dv).norm();
    return millimetres > 0.0 ? Vec2(across / millimetres) : Vec2(Vec2(-along.y(), along.x()) / length);
  }
  // The cheap test: true if the curve passes within the tolerance of the point `at` of the chord. If not,
  // the point lies on the same side of a limit as the two places beside it, and `value` is the value at one
  // of them.
  bool Straight(const Chord& chord, double at, double* value = nullptr) const {
    const auto beside = Beside(chord, at);
    if (!beside) return false;
    const double one = Value(field_, piece_, (*beside)[0]), other = Value(field_, piece_, (*beside)[1]);
    if (value != nullptr && !field_.smooth && one * other > 0.0) *value = one;
    return one * other <= 0.0;
  }

  void Add(const Vec2& from, const Vec2& to, int depth, std::vector<Vec2>& out) const {
    const Chord chord{from, to, At(from), At(to)};
    if (depth == 0 || chord.length() <= tolerance_) return;
    std::optional<Vec2> root = Followed(from, to);
    if (!root) {
      double at_mid = 0.0;
      if (Straight(chord, 0.5, &at_mid)) return;
      root = OnPerpendicular(from, to, chord.length(), at_mid);
    }
    if (!root || Near(*root, chord)) return;
    Add(from, *root, depth - 1, out);
    out.push_back(*root);
    Add(*root, to, depth - 1, out);
  }

  // As OnPerpendicular, for fields that can be followed.
  std::optional<Vec2> Followed(const Vec2& from, const Vec2& to) const {
    if (!follow_) return std::nullopt;
    const Vec2 mid = 0.5 * (from + to), across(-(to - from).y(), (to - from).x());
    const std::optional<double> share =
        follow_({from, to}, across, -Inside(mid, -across), Inside(mid, across));
    if (!share) return std::nullopt;
    return Vec2(mid + *share * across);
  }

  // The root on the perpendicular through the chord's middle, inside the piece and at most half a chord away.
  // For a limit it may be a whole chord away, because cells may hold a sharper bend of a limit. `at_mid` as
  // for AddBent.
  std::optional<Vec2> OnPerpendicular(const Vec2& from, const Vec2& to, double length, double at_mid) const {
    const Vec2 mid = 0.5 * (from + to), across(-(to - from).y(), (to - from).x());
    if (at_mid == 0.0) at_mid = Value(field_, piece_, mid);
    if (at_mid == 0.0) return mid;
    for (const double reach : {0.05, 0.15, 0.5, 1.0}) {
      if (reach > 0.5 && field_.smooth) break;
      for (const double side : {reach, -reach}) {
        const Vec2 q = mid + Inside(mid, side * across) * side * across;
        const double at_q = Value(field_, piece_, q);
        if ((at_q > 0.0) == (at_mid > 0.0)) continue;
        if (field_.limits) {
          const ZeroSegment segment = at_mid > 0.0 ? ZeroSegment{q, mid} : ZeroSegment{mid, q};
          double share = 0.0;
          field_.limits(piece_, {&segment, 1}, {&share, 1});
          return Vec2(segment.from + share * (segment.to - segment.from));
        }
        const double stop = EnoughFor(field_, length * reach);
        return Vec2(mid + ZeroBetween(field_, piece_, {mid, q, at_mid, at_q}, stop) * (q - mid));
      }
    }
    return std::nullopt;
  }

  // The largest share of `step` from `at` that stays in the piece.
  static double Inside(const Vec2& at, const Vec2& step) {
    double part = 1.0;
    for (int c = 0; c < 2; ++c) {
      if (at[c] + step[c] > 1.0) part = std::min(part, (1.0 - at[c]) / step[c]);
      if (at[c] + step[c] < 0.0) part = std::min(part, -at[c] / step[c]);
    }
    return part;
  }

  const Piece& piece_;
  const ZeroField& field_;
  double tolerance_;
  ZeroField::Follow follow_;
};

}  // namespace

std::vector<Vec2> RefineZeroArc(const Piece& piece, const ZeroField& field, const Vec2& from, const Vec2& to,
                                double tolerance) {
  std::vector<Vec2> out;
  Refiner(piece, field, tolerance).AddFirst(from, to, out);
  return out;
}

std::vector<std::vector<Vec2>> RefineZeroArcs(const Piece& piece, const ZeroField& field,
                                              std::span<const ZeroSegment> chords, double tolerance) {
  std::vector<std::vector<Vec2>> arcs(chords.size());
  const Refiner refiner(piece, field, tolerance);
  if (field.smooth || !field.values) {
    for (std::size_t k = 0; k < chords.size(); ++k) refiner.AddFirst(chords[k].from, chords[k].to, arcs[k]);
    return arcs;
  }
  // Most chords are straight. They are all evaluated in one call.
  std::vector<std::size_t> asked;
  std::vector<std::pair<std::size_t, double>> bent;  // with the value at the chord's middle
  std::vector<SurfaceJet> jets;
  for (std::size_t k = 0; k < chords.size(); ++k) {
    const Chord chord{chords[k].from, chords[k].to, refiner.At(chords[k].from), refiner.At(chords[k].to)};
    if (chord.length() <= tolerance) continue;
    const auto beside = refiner.Beside(chord, 0.5);
    if (!beside) {
      bent.emplace_back(k, 0.0);
      continue;
    }
    asked.push_back(k);
    for (const Vec2& q : *beside) jets.push_back(Evaluate(piece, q.x(), q.y()));
  }
  std::vector<double> values(jets.size());
  field.values(jets, values);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    if (!(values[2 * i] * values[2 * i + 1] <= 0.0)) bent.emplace_back(asked[i], values[2 * i]);
  }
  for (const auto& [k, at_mid] : bent) refiner.AddBent(chords[k].from, chords[k].to, at_mid, arcs[k]);
  return arcs;
}

}  // namespace patchmill
