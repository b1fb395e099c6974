#include "cam/plan/beside_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "cam/plan/footprint.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"
#include "core/surface/air_sides.h"
#include "core/surface/highest.h"

namespace patchmill {
namespace {

constexpr double kLookBeside = 2.0;  // cells: so far beside a wall the part must have ended
constexpr double kPlaceStep = 4.0;   // cells: distance of the places of a wall that are looked at
constexpr int kMostPlacesOfAStretch = 256;
// Ball radii: how far areas reach, and the least of it where something else of the part is near.
constexpr double kDeep = 4.0, kLeastDeep = 1.1;
constexpr int kMostStretches = 64;    // of a curved wall, each way
constexpr double kSagitta = 0.5;      // of the gap between wall and area: how far a wall may leave its chord
constexpr double kHeightProof = 0.1;  // of the tolerance
constexpr double kSameEnd = 2.0;      // tolerances: stretches whose ends are this close meet
constexpr double kOverlap = 4.0;      // tolerances: how far the area over a joint reaches into both
constexpr double kNoTurn = 1e-3;      // rad

// An area begins this far off its wall, mm. A ball that rolls over a sharp upper edge is half the tolerance
// lower than that edge there.
double GapOf(const BesidePartParams& params) { return std::sqrt(params.radius * params.tolerance); }

// A straight part of a wall seen from above, the part of the model on the left of a b.
struct Stretch {
  Vec2 a = Vec2::Zero(), b = Vec2::Zero();
  double top_z = 0.0;
  double deep = 0.0;  // mm
  StripKind kind = StripKind::kOutside;
  Vec2 Out() const {
    const Vec2 along = (b - a).normalized();
    return {along.y(), -along.x()};
  }
};

// Corners of cells on a piece that counts as a vertical face all over.
struct UprightGrid {
  int nu = 1, nv = 1;
  std::vector<Vec3> points;    // (nu + 1) (nv + 1), v fastest
  std::vector<Vec2> middles;   // in plan, the point of the wall in the middle of each cell
  std::vector<Vec2> air_side;  // unit normal in plan on the side of du x dv, of each cell
  int side = 0;  // the air side: FaceSides::air_side, or the upper side where all of it leans that way
  const Vec3& At(int i, int j) const { return points[static_cast<std::size_t>(i * (nv + 1) + j)]; }
};

// nullopt unless the piece leans by less than half the tolerance over its height, and by kMostUprightSlope,
// wherever it is looked at.
std::optional<UprightGrid> GridOn(const Piece& piece, double tolerance, int nu, int nv) {
  UprightGrid grid;
  grid.nu = nu;
  grid.nv = nv;
  grid.side = piece.sides.air_side;
  double low = kInfinity, high = -kInfinity, steepest = 0.0;
  bool leans_over = true, leans_under = true;
  for (int i = 0; i <= nu; ++i) {
    for (int j = 0; j <= nv; ++j) {
      grid.points.push_back(Position(piece, double(i) / nu, double(j) / nv));
      low = std::min(low, grid.points.back().z());
      high = std::max(high, grid.points.back().z());
    }
  }
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) {
      const SurfaceJet jet = Evaluate(piece, (i + 0.5) / nu, (j + 0.5) / nv);
      const auto normal = UnitNormal(jet);
      grid.middles.push_back(Xy(jet.p));
      if (!normal) {
        grid.air_side.push_back(Vec2::Zero());
        continue;
      }
      steepest = std::max(steepest, std::abs(normal->z()));
      const bool leans = steepest * (high - low) > 0.5 * tolerance || steepest > kMostUprightSlope;
      if (leans && steepest > piece.sides.upright) return std::nullopt;
      leans_over = leans_over && normal->z() > piece.sides.upright;
      leans_under = leans_under && normal->z() < -piece.sides.upright;
      grid.air_side.push_back(Xy(*normal).normalized());
    }
  }
  if (grid.side == 0 && leans_over != leans_under) grid.side = leans_over ? 1 : -1;
  return grid;
}

// How far the surface is from n chords one after the other, in plan, along u or v.
double SagittaOf(const Piece& piece, bool along_u, int n) {
  double worst = 0.0;
  for (const double other : {0.0, 0.5, 1.0}) {
    const auto at = [&](double t) -> Vec2 {
      return Xy(along_u ? Position(piece, t, other) : Position(piece, other, t));
    };
    for (int j = 0; j < n; ++j) {
      const Vec2 a = at(double(j) / n), along = at(double(j + 1) / n) - a;
      const double length2 = along.squaredNorm();
      for (const double share : {0.25, 0.5, 0.75}) {
        const Vec2 m = at((j + share) / n);
        const double t = length2 > 0.0 ? std::clamp((m - a).dot(along) / length2, 0.0, 1.0) : 0.0;
        worst = std::max(worst, (m - a - t * along).norm());
      }
    }
  }
  return worst;
}

int ChordsFor(const Piece& piece, bool along_u, double sagitta) {
  int n = 1;
  while (n < kMostStretches && SagittaOf(piece, along_u, n) > sagitta) n *= 2;
  return n;
}

class StretchFinder {
 public:
  StretchFinder(const Surface& surface, const Footprint& footprint, const BesidePartParams& params)
      : surface_(surface), footprint_(footprint), params_(params) {}

  std::vector<Stretch> On(const Piece& piece) const {
    std::vector<Stretch> found;
    if (!GridOn(piece, params_.tolerance, 3, 3)) return found;
    const double sagitta = kSagitta * GapOf(params_);
    const int nu = ChordsFor(piece, true, sagitta), nv = ChordsFor(piece, false, sagitta);
    const auto grid = GridOn(piece, params_.tolerance, nu, nv);
    if (!grid) return found;
    const bool named = !params_.selected.empty() && params_.selected[piece.patch.index()];
    for (int i = 0; i < nu; ++i) {
      for (int j = 0; j < nv; ++j) AddCell(*grid, i, j, named, found);
    }
    return found;
  }

 private:
  void AddCell(const UprightGrid& grid, int i, int j, bool named, std::vector<Stretch>& found) const {
    const Vec2 normal = grid.air_side[static_cast<std::size_t>(i * grid.nv + j)];
    if (normal.isZero()) return;
    const Vec2 along(-normal.y(), normal.x());
    const std::array<Vec2, 4> corners = {Xy(grid.At(i, j)), Xy(grid.At(i + 1, j)), Xy(grid.At(i, j + 1)),
                                         Xy(grid.At(i + 1, j + 1))};
    const auto [first, last] =
        std::minmax_element(corners.begin(), corners.end(),
                            [&](const Vec2& p, const Vec2& q) { return along.dot(p) < along.dot(q); });
    if ((*last - *first).norm() < params_.tolerance) return;
    double lowest = kInfinity;
    for (const auto& [a, b] : {std::array{i, j}, {i + 1, j}, {i, j + 1}, {i + 1, j + 1}})
      lowest = std::min(lowest, grid.At(a, b).z());
    const Vec2 bend = grid.middles[static_cast<std::size_t>(i * grid.nv + j)] - 0.5 * (*first + *last);
    const Chord chord{*first, *last, normal, bend.dot(normal), grid.side};
    for (const auto& [from, to, over, under] : BareParts(chord)) {
      if (!over && !under) continue;
      if (grid.side == 0 && over && under) continue;  // stands alone: it is milled on both sides
      const double top = TopOver(from, to);
      if (!(top > lowest + params_.tolerance)) continue;
      for (const double side : {1.0, -1.0}) {
        if (!(side > 0.0 ? over : under)) continue;
        Stretch stretch;
        stretch.kind = LooksAway(grid.side, side) ? StripKind::kMaterial : StripKind::kOutside;
        if (stretch.kind == StripKind::kOutside && (params_.mill_outside || named)) continue;
        // Outside lies on the right of a b.
        stretch.a = side > 0.0 ? to : from;
        stretch.b = side > 0.0 ? from : to;
        stretch.top_z = top;
        if (stretch.Out().dot(side * normal) < 0.0) std::swap(stretch.a, stretch.b);
        stretch.deep = DeepBeside(stretch);
        found.push_back(stretch);
      }
    }
  }

  // A chord of a wall from above. The wall is up to `bend` (mm) beside it, positive on the side of `normal`.
  struct Chord {
    Vec2 first, last, normal;
    double bend = 0.0;
    int air_side = 0;  // UprightGrid::side
  };

  // A part of a chord. `over`, `under`: nothing of the part lies on the side of the normal, on the other.
  struct BarePart {
    Vec2 from, to;
    bool over = false, under = false;
  };

  // True if the air side of a wall is known and is the other one: this side is material.
  static bool LooksAway(int air_side, double side) { return air_side != 0 && air_side * side < 0.0; }

  // Behind a wall there is material, in a hole of the model too. Before it holes are for the tool.
  bool IsBare(StripKind kind, const Vec2& q) const {
    return kind == StripKind::kMaterial ? footprint_.IsBare(q) : footprint_.IsOutside(q);
  }

  // The parts of a chord with the same bare sides. Another part of the model may touch the wall anywhere, so
  // places all along the chord are looked at.
  std::vector<BarePart> BareParts(const Chord& chord) const {
    const double cell = footprint_.cell(), length = (chord.last - chord.first).norm();
    const int places = std::clamp(static_cast<int>(length / (kPlaceStep * cell)), 1, kMostPlacesOfAStretch);
    const auto at = [&](double place) -> Vec2 {
      return chord.first + place / places * (chord.last - chord.first);
    };
    const auto bare = [&](int place, double side) {
      const double bend = std::max(0.0, side * chord.bend);
      const auto beside = [&](double off) -> Vec2 {
        return at(place + 0.5) + side * (off + bend) * chord.normal;
      };
      const StripKind kind = LooksAway(chord.air_side, side) ? StripKind::kMaterial : StripKind::kOutside;
      if (!IsBare(kind, beside(kLookBeside * cell))) return false;
      // A rib may be thinner than that, and its top is the part's.
      const double gap = GapOf(params_);
      const Vec2 close = beside(gap);
      return kind != StripKind::kMaterial ||
             !AnyInColumn(surface_, {close, close, 0.5 * gap}, -kInfinity, 0.25 * gap);
    };
    std::vector<BarePart> parts;
    for (int k = 0; k < places; ++k) {
      const BarePart part{at(k), at(k + 1), bare(k, 1.0), bare(k, -1.0)};
      if (k > 0 && parts.back().over == part.over && parts.back().under == part.under) {
        parts.back().to = part.to;
      } else {
        parts.push_back(part);
      }
    }
    return parts;
  }

  // Up to what else the part has there.
  double DeepBeside(const Stretch& stretch) const {
    const double step = footprint_.cell(), most = kDeep * params_.radius, least = kLeastDeep * params_.radius;
    const Vec2 along = stretch.b - stretch.a, out = stretch.Out();
    const int places = 1 + std::min(64, static_cast<int>(along.norm() / std::max(params_.radius, step)));
    double deep = most;
    for (int k = 0; k <= places; ++k) {
      const Vec2 from = stretch.a + double(k) / places * along;
      double here = kLookBeside * step;
      while (here < deep && IsBare(stretch.kind, from + here * out)) here += step;
      if (here < deep) deep = here - kLookBeside * step;
    }
    return std::max(deep, least);
  }

  double TopOver(const Vec2& a, const Vec2& b) const {
    const double wide = params_.tolerance, proof = kHeightProof * params_.tolerance;
    const auto highest = HighestInColumn(surface_, {a, b, wide}, -kInfinity, proof);
    return highest ? highest->p.z() + proof : -kInfinity;
  }

  const Surface& surface_;
  const Footprint& footprint_;
  const BesidePartParams& params_;
};

// Neighbours in one line, of one height, depth and kind, as one.
std::vector<Stretch> Merged(std::vector<Stretch> stretches, double tolerance) {
  for (bool again = true; again;) {
    again = false;
    for (std::size_t i = 0; i < stretches.size(); ++i) {
      for (std::size_t k = i + 1; k < stretches.size(); ++k) {
        Stretch &a = stretches[i], &b = stretches[k];
        if (a.kind != b.kind || a.deep != b.deep || std::abs(a.top_z - b.top_z) > kHeightProof * tolerance)
          continue;
        if (a.Out().dot(b.Out()) < 1.0 - 1e-12) continue;
        const Vec2 along = (a.b - a.a).normalized();
        if (std::abs(a.Out().dot(b.a - a.a)) > 1e-3 * tolerance) continue;
        const double a1 = along.dot(a.b - a.a), b0 = along.dot(b.a - a.a), b1 = along.dot(b.b - a.a);
        if (b0 > a1 + tolerance || b1 < -tolerance) continue;
        const Vec2 from = a.a;
        a.a = from + std::min(0.0, b0) * along;
        a.b = from + std::max(a1, b1) * along;
        a.top_z = std::max(a.top_z, b.top_z);
        stretches.erase(stretches.begin() + static_cast<std::ptrdiff_t>(k));
        again = true;
        break;
      }
      if (again) break;
    }
  }
  return stretches;
}

class StripMaker {
 public:
  explicit StripMaker(const BesidePartParams& params)
      : gap_(GapOf(params)), meet_(kSameEnd * params.tolerance), overlap_(kOverlap * params.tolerance) {}

  BesideStrip Beside(const Stretch& s) const {
    // Areas are kept within half a tolerance: past the end of a wall the tool would go down beside it.
    const Vec2 out = s.Out(), past = overlap_ * (s.b - s.a).normalized(), a = s.a - past, b = s.b + past;
    const Ring ring = {a + gap_ * out, a + s.deep * out, b + s.deep * out, b + gap_ * out};
    return {s.kind, Outline({ring}), s.top_z};
  }

  // Over the joint of two areas, where the outline goes on straight or turns away from the outside: room is
  // measured in each area by itself, so that areas that only touch would leave a slit. nullopt where the two
  // overlap.
  std::optional<BesideStrip> Corner(const Stretch& from, const Stretch& to) const {
    if ((from.b - to.a).norm() > meet_) return std::nullopt;
    const Vec2 one = from.Out(), other = to.Out();
    const double turn = std::atan2(Cross(one, other), one.dot(other));
    if (turn < -kNoTurn) return std::nullopt;
    const StripKind kind = from.kind == StripKind::kMaterial && to.kind == StripKind::kMaterial
                               ? StripKind::kMaterial
                               : StripKind::kOutside;
    const Vec2 between = (one + other).normalized(), p = to.a;
    const double deep = std::min(from.deep, to.deep), farther = deep / std::max(0.2, std::cos(0.5 * turn));
    const Vec2 before = p - overlap_ * (from.b - from.a).normalized(),
               after = p + overlap_ * (to.b - to.a).normalized();
    const Ring ring = {before + gap_ * one, before + deep * one, p + farther * between, after + deep * other,
                       after + gap_ * other};
    return BesideStrip{kind, Outline({ring}), std::max(from.top_z, to.top_z)};
  }

 private:
  double gap_, meet_, overlap_;  // mm
};

}  // namespace

absl::StatusOr<std::vector<BesideStrip>> FindBesideStrips(const Surface& surface,
                                                          const BesidePartParams& params,
                                                          const RunContext& run) {
  constexpr std::size_t kPolled = 256;  // pieces between two looks at the run
  std::vector<std::size_t> walls;
  for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
    if (i % kPolled == 0) PM_RETURN_IF_ERROR(run.Check());
    if (GridOn(surface.pieces[i], params.tolerance, 1, 1)) walls.push_back(i);
  }
  if (walls.empty()) return std::vector<BesideStrip>();
  PM_RETURN_IF_ERROR(run.Check());
  const Footprint footprint(surface, run);
  PM_RETURN_IF_ERROR(run.Check());
  const StretchFinder finder(surface, footprint, params);
  std::vector<std::vector<Stretch>> found(walls.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, walls.size(), [&](std::size_t i) {
    found[i] = Merged(finder.On(surface.pieces[walls[i]]), params.tolerance);
  }));
  std::vector<Stretch> stretches;
  for (const std::vector<Stretch>& of : found) stretches.insert(stretches.end(), of.begin(), of.end());
  std::stable_sort(stretches.begin(), stretches.end(),
                   [](const Stretch& a, const Stretch& b) { return a.a.x() < b.a.x(); });
  const StripMaker maker(params);
  std::vector<BesideStrip> strips;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    PM_RETURN_IF_ERROR(run.Check());
    strips.push_back(maker.Beside(stretches[i]));
    const double x = stretches[i].b.x(), meet = kSameEnd * params.tolerance;
    auto next = std::lower_bound(stretches.begin(), stretches.end(), x - meet,
                                 [](const Stretch& s, double least) { return s.a.x() < least; });
    for (; next != stretches.end() && next->a.x() <= x + meet; ++next) {
      if (auto corner = maker.Corner(stretches[i], *next)) strips.push_back(*std::move(corner));
    }
  }
  return strips;
}

}  // namespace patchmill
