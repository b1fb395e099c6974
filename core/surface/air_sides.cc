#include "core/surface/air_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"
#include "core/surface/highest.h"

namespace patchmill {
namespace {

// Sample parameters on a piece, the same for u and v. They are not symmetric, so that a silhouette is not
// taken for a vertical face.
constexpr std::array kAt = {0.17, 0.53, 0.86};
constexpr std::size_t kMostPlaces = 2000;  // per component
constexpr double kDecides = 0.9;           // share of the open area in plan that makes a side the air side
constexpr double kLeastSlope = 0.02;       // e_z; steeper places say nothing of the sky
constexpr double kColumn = 1e-6, kOver = 1e-4;  // share of the box's diagonal

// A patch that is joined by an edge. `turn` is 1 if both have the same orientation, -1 otherwise.
struct Neighbor {
  std::size_t patch = 0;
  int turn = 1;
};
using Neighbors = std::vector<std::vector<Neighbor>>;  // index: patch

// Edges 0 and 1 run counter-clockwise around a patch, the others clockwise.
bool Forward(const PatchEdge& edge) { return edge.edge <= 1; }

// `reversed`: the parameters of the two edges run against each other. Two patches have the same orientation
// if they run around their common edge in opposite directions.
int TurnOf(const PatchEdge& a, const PatchEdge& b, bool reversed) {
  return (Forward(a) == Forward(b)) != reversed ? -1 : 1;
}

Neighbors FindNeighbors(const PatchNetwork& network) {
  Neighbors neighbors(network.model.patches.size());
  const auto join = [&](const PatchEdge& a, const PatchEdge& b, bool reversed) {
    const int turn = TurnOf(a, b, reversed);
    neighbors[a.patch.index()].push_back({b.patch.index(), turn});
    neighbors[b.patch.index()].push_back({a.patch.index(), turn});
  };
  for (const EdgeLink& link : network.edges) {
    if (!link.neighbor || !(link.self < *link.neighbor)) continue;
    const EdgeLink& back = network.Link(*link.neighbor);
    if (back.neighbor && *back.neighbor == link.self) join(link.self, *link.neighbor, link.reversed);
  }
  for (const PartLink& link : network.part_links) join(link.part, link.whole, link.from > link.to);
  return neighbors;
}

// Patches that are joined to each other. `one_sided`: they have no common orientation.
struct Component {
  std::vector<std::size_t> patches;
  bool one_sided = false;
};

std::vector<Component> FindComponents(const Neighbors& neighbors, std::vector<int>& orientation) {
  std::vector<Component> components;
  orientation.assign(neighbors.size(), 0);
  for (std::size_t first = 0; first < neighbors.size(); ++first) {
    if (orientation[first] != 0) continue;
    Component component;
    orientation[first] = 1;
    component.patches.push_back(first);
    for (std::size_t i = 0; i < component.patches.size(); ++i) {
      const std::size_t patch = component.patches[i];
      for (const Neighbor& next : neighbors[patch]) {
        const int wanted = orientation[patch] * next.turn;
        if (orientation[next.patch] == 0) {
          orientation[next.patch] = wanted;
          component.patches.push_back(next.patch);
        } else if (orientation[next.patch] != wanted) {
          component.one_sided = true;
        }
      }
    }
    components.push_back(std::move(component));
  }
  return components;
}

// Orientation of the piece's parameters relative to those of its patch: 1 or -1.
int OrientationOf(const Piece& piece) {
  const Vec2 u = piece.native[1] - piece.native[0], v = piece.native[2] - piece.native[0];
  return u.x() * v.y() - u.y() * v.x() < 0.0 ? -1 : 1;
}

bool HasUpright(const Piece& piece) {
  for (const double u : kAt) {
    for (const double v : kAt) {
      const auto normal = UnitNormal(Evaluate(piece, u, v));
      if (normal && std::abs(normal->z()) <= piece.upright) return true;
    }
  }
  return false;
}

// Files round coordinates: a wall whose coordinates have four decimals leans by some 1e-4 mm, which says
// nothing about its sides. A piece that leans by no more than kMostLean over its height, and by no more than
// kMostLeanShare of its height, counts as a vertical face all over.
constexpr double kMostLean = 5e-3;  // mm, half of the default tolerance
constexpr double kMostLeanShare = 0.01;
constexpr double kLeanMargin = 1.5;  // factor: between the sampled places a wall may lean a little more

bool IsOpenToTheSky(const Surface& surface, const Vec3& p) {
  const double size = surface.box.Diagonal();
  const Vec2 q = Xy(p);
  return !AnyInColumn(surface, {q, q, kColumn * size}, p.z() + kOver * size, 0.1 * kColumn * size);
}

// Area in plan that is open to the sky. `over` is the part where du x dv looks up, `under` the part where it
// looks down.
struct OpenArea {
  double over = 0.0, under = 0.0;
  void Add(const OpenArea& other, int orientation) {
    over += orientation > 0 ? other.over : other.under;
    under += orientation > 0 ? other.under : other.over;
  }
  int Side() const {
    const double all = over + under;
    if (!(all > 0.0)) return 0;
    return over >= kDecides * all ? 1 : under >= kDecides * all ? -1 : 0;
  }
};

OpenArea MeasureOpen(const Surface& surface, const Piece& piece) {
  OpenArea open;
  const int orientation = OrientationOf(piece);
  for (const double u : kAt) {
    for (const double v : kAt) {
      const SurfaceJet jet = Evaluate(piece, u, v);
      const auto normal = UnitNormal(jet);
      if (!normal || std::abs(normal->z()) < kLeastSlope || !IsOpenToTheSky(surface, jet.p)) continue;
      const double area = std::abs(jet.du.cross(jet.dv).z());
      (normal->z() * orientation > 0.0 ? open.over : open.under) += area;
    }
  }
  return open;
}

class SideFinder {
 public:
  SideFinder(const Surface& surface, const RunContext& run)
      : surface_(surface), run_(run), neighbors_(FindNeighbors(surface.network)) {}

  absl::StatusOr<AirSides> Run(const std::vector<char>& upright) {
    AirSides sides;
    sides.of_patch.assign(upright.size(), 0);
    pieces_of_.resize(upright.size());
    for (std::size_t i = 0; i < surface_.pieces.size(); ++i)
      pieces_of_[surface_.pieces[i].patch.index()].push_back(i);
    for (const Component& component : FindComponents(neighbors_, orientation_)) {
      const bool any = std::any_of(component.patches.begin(), component.patches.end(),
                                   [&](std::size_t patch) { return upright[patch] != 0; });
      if (!any) continue;
      PM_RETURN_IF_ERROR(run_.Check());
      const int side = component.one_sided ? 0 : SideOf(component);
      for (const std::size_t patch : component.patches) {
        if (upright[patch] == 0) continue;
        const int own = side != 0 ? side * orientation_[patch] : SideByNeighbors(patch);
        sides.of_patch[patch] = own;
        if (own == 0) sides.undecided.push_back(PatchId(patch));
      }
    }
    std::sort(sides.undecided.begin(), sides.undecided.end());
    return sides;
  }

 private:
  OpenArea OpenOf(std::size_t patch) const {
    OpenArea open;
    for (const std::size_t piece : pieces_of_[patch])
      open.Add(MeasureOpen(surface_, surface_.pieces[piece]), 1);
    return open;
  }

  // The air side relative to the orientation of the component's first patch: 1, -1, or 0 if undecided.
  int SideOf(const Component& component) const {
    std::vector<std::size_t> pieces;
    for (const std::size_t patch : component.patches)
      pieces.insert(pieces.end(), pieces_of_[patch].begin(), pieces_of_[patch].end());
    const std::size_t most = kMostPlaces / (kAt.size() * kAt.size());
    const std::size_t stride = 1 + (pieces.size() - 1) / most;
    OpenArea open;
    for (std::size_t k = 0; k < pieces.size() && !run_.Cancelled(); k += stride) {
      const Piece& piece = surface_.pieces[pieces[k]];
      open.Add(MeasureOpen(surface_, piece), orientation_[piece.patch.index()]);
    }
    return open.Side();
  }

  // The air side in the patch's own parameters: 1, -1, or 0 if undecided.
  int SideByNeighbors(std::size_t patch) const {
    OpenArea open;
    for (const Neighbor& next : neighbors_[patch]) open.Add(OpenOf(next.patch), next.turn);
    return open.Side();
  }

  const Surface& surface_;
  const RunContext& run_;
  const Neighbors neighbors_;
  std::vector<int> orientation_;
  std::vector<std::vector<std::size_t>> pieces_of_;
};

}  // namespace

absl::StatusOr<AirSides> FindAirSides(const Surface& surface, const RunContext& run) {
  std::vector<char> piece_upright(surface.pieces.size(), 0);
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, surface.pieces.size(), [&](std::size_t i) {
    piece_upright[i] = HasUpright(surface.pieces[i]) ? 1 : 0;
  }));
  std::vector<char> upright(surface.network.model.patches.size(), 0);
  bool any = false;
  for (std::size_t i = 0; i < piece_upright.size(); ++i) {
    if (piece_upright[i] == 0) continue;
    upright[surface.pieces[i].patch.index()] = 1;
    any = true;
  }
  if (!any) return AirSides{std::vector<int>(upright.size(), 0), {}};
  return SideFinder(surface, run).Run(upright);
}

double UprightOf(const Piece& piece) {
  constexpr int kCells = 4;  // each way, corners included: a bilinear patch leans most there
  double low = kInfinity, high = -kInfinity, steepest = 0.0;
  for (int i = 0; i <= kCells; ++i) {
    for (int j = 0; j <= kCells; ++j) {
      const SurfaceJet jet =
          Evaluate(piece, static_cast<double>(i) / kCells, static_cast<double>(j) / kCells);
      low = std::min(low, jet.p.z());
      high = std::max(high, jet.p.z());
      const auto normal = UnitNormal(jet);
      if (normal) steepest = std::max(steepest, std::abs(normal->z()));
      if (steepest > kMostLeanShare || steepest * (high - low) > kMostLean) return kUprightFace;
    }
  }
  return std::max(kUprightFace, kLeanMargin * steepest);
}

void SetAirSides(const AirSides& sides, std::vector<Piece>& pieces) {
  for (Piece& piece : pieces) piece.air_side = sides.of_patch[piece.patch.index()] * OrientationOf(piece);
}

}  // namespace patchmill
