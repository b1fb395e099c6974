#include "core/surface/air_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"
#include "core/network/edge_contacts.h"
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
constexpr int kMostWallPlaces = 9;              // each way: so many places of a wall are looked at

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

// Which way the places of a piece look.
struct Looks {
  bool upright = false;              // somewhere
  bool over = false, under = false;  // somewhere the side of du x dv of the patch looks up, or down
  bool wall = true;                  // nowhere more than kMostWallSlope from vertical
  void Add(double e_z, double most_upright) {
    upright = upright || std::abs(e_z) <= most_upright;
    over = over || e_z > most_upright;
    under = under || e_z < -most_upright;
    wall = wall && std::abs(e_z) <= kMostWallSlope;
  }
  void Add(const Looks& other, int orientation) {
    upright = upright || other.upright;
    over = over || (orientation > 0 ? other.over : other.under);
    under = under || (orientation > 0 ? other.under : other.over);
  }
};

Looks LooksOf(const Piece& piece) {
  Looks looks;
  const int orientation = OrientationOf(piece);
  const auto add = [&](double u, double v) {
    const auto normal = UnitNormal(Evaluate(piece, u, v));
    if (normal) looks.Add(orientation * normal->z(), piece.sides.upright);
  };
  for (const double u : kAt) {
    for (const double v : kAt) add(u, v);
  }
  if (!looks.wall) return looks;
  // Walls of files often wave by a micrometre or so: as often as their degree lets them.
  const auto places = [](int degree) { return std::min(2 * degree + 1, kMostWallPlaces); };
  const int nu = places(piece.net.degree_u), nv = places(piece.net.degree_v);
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) add((i + 0.5) / nu, (j + 0.5) / nv);
  }
  return looks;
}

// Files round coordinates: a wall whose coordinates have four decimals leans by some 1e-4 mm, which says
// nothing about its sides. A piece that leans by no more than kMostLean over its height, and nowhere by more
// than kMostUprightSlope, counts as a vertical face all over.
constexpr double kMostLean = 5e-3;   // mm, half of the default tolerance
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

  // `looks`, index: piece.
  absl::StatusOr<AirSides> Run(const std::vector<Looks>& looks) {
    const std::size_t patches = surface_.network.model.patches.size();
    pieces_of_.resize(patches);
    std::vector<Looks> of_patch(patches);
    for (std::size_t i = 0; i < looks.size(); ++i) {
      const std::size_t patch = surface_.pieces[i].patch.index();
      pieces_of_[patch].push_back(i);
      of_patch[patch].Add(looks[i], 1);
    }
    PM_ASSIGN_OR_RETURN(Decided decided, Decide(of_patch));
    if (!decided.undecided.empty() && AddContacts()) {
      PM_ASSIGN_OR_RETURN(Decided loosely, Decide(of_patch));
      decided = Merged(std::move(decided), loosely);
    }
    AirSides sides{std::move(decided.of_upright), std::move(decided.outer), {}, std::move(decided.undecided)};
    sides.overhangs.assign(looks.size(), 0);
    PM_RETURN_IF_ERROR(ParallelFor(run_, nullptr, looks.size(), [&](std::size_t i) {
      const Piece& piece = surface_.pieces[i];
      sides.overhangs[i] = Overhangs(piece, looks[i], decided.of_component[piece.patch.index()]) ? 1 : 0;
    }));
    for (std::size_t i = 0; i < looks.size(); ++i) {
      const std::size_t patch = surface_.pieces[i].patch.index();
      if (sides.overhangs[i] != 0) sides.of_patch[patch] = decided.of_component[patch];
    }
    return sides;
  }

 private:
  // Air sides in the patches' own parameters: 1, -1, or 0 if unknown.
  struct Decided {
    std::vector<int> of_upright;    // index: patch. Of patches with vertical faces
    std::vector<int> of_component;  // index: patch. Of all patches of components that have an air side
    std::vector<int> outer;         // index: patch. Of all patches of closed components that have an air side
    std::vector<PatchId> undecided;  // with vertical faces, ascending
  };

  // `of_patch`, index: patch.
  absl::StatusOr<Decided> Decide(const std::vector<Looks>& of_patch) {
    const std::vector<int> unknown(of_patch.size(), 0);
    Decided decided{unknown, unknown, unknown, {}};
    for (const Component& component : FindComponents(neighbors_, orientation_)) {
      Looks all;
      for (const std::size_t patch : component.patches) all.Add(of_patch[patch], orientation_[patch]);
      if (!all.upright && !(all.over && all.under)) continue;
      PM_RETURN_IF_ERROR(run_.Check());
      const int side = component.one_sided ? 0 : SideOf(component);
      const bool closed = IsClosed(component);
      for (const std::size_t patch : component.patches) {
        decided.of_component[patch] = side * orientation_[patch];
        if (closed) decided.outer[patch] = decided.of_component[patch];
        if (!of_patch[patch].upright) continue;
        const int own = side != 0 ? decided.of_component[patch] : SideByNeighbors(patch);
        decided.of_upright[patch] = own;
        if (own == 0) decided.undecided.push_back(PatchId(patch));
      }
    }
    std::sort(decided.undecided.begin(), decided.undecided.end());
    return decided;
  }

  // Edges that overlap in part, or with a gap, join patches too. Returns whether there are any.
  bool AddContacts() {
    if (surface_.network.edges.empty()) return false;  // a network without links, of which nothing is joined
    PatchModel model;  // the surface keeps the control points of its patches in the pieces
    for (std::size_t i = 0; i < neighbors_.size(); ++i)
      model.patches.push_back({surface_.network.model.patches[i].id, ShapeOf(surface_, PatchId(i))});
    const std::vector<EdgeContact> contacts = FindEdgeContacts(model, surface_.network, run_);
    for (const EdgeContact& contact : contacts) {
      const int turn = TurnOf(contact.self, contact.other, contact.reversed);
      neighbors_[contact.self.patch.index()].push_back({contact.other.patch.index(), turn});
      neighbors_[contact.other.patch.index()].push_back({contact.self.patch.index(), turn});
    }
    return !contacts.empty();
  }

  // Takes from `other` what `first` did not decide.
  static Decided Merged(Decided first, const Decided& other) {
    for (const PatchId patch : first.undecided)
      first.of_upright[patch.index()] = other.of_upright[patch.index()];
    for (std::size_t i = 0; i < first.of_component.size(); ++i) {
      if (first.of_component[i] == 0) first.of_component[i] = other.of_component[i];
      if (first.outer[i] == 0) first.outer[i] = other.outer[i];
    }
    std::erase_if(first.undecided, [&](PatchId patch) { return first.of_upright[patch.index()] != 0; });
    return first;
  }

  // `air_side`: of the patch in its own parameters, 0 if unknown.
  bool Overhangs(const Piece& piece, const Looks& looks, int air_side) const {
    if (air_side == 0 || !(air_side > 0 ? looks.under : looks.over)) return false;
    if (looks.wall) return true;
    if (surface_.network.open_edge_count == 0) return false;  // no back of a closed body is open to the sky
    const int back = -air_side * OrientationOf(piece);
    for (const double u : kAt) {
      for (const double v : kAt) {
        const SurfaceJet jet = Evaluate(piece, u, v);
        const auto normal = UnitNormal(jet);
        if (normal && back * normal->z() >= kLeastSlope && IsOpenToTheSky(surface_, jet.p)) return true;
      }
    }
    return false;
  }

  bool IsClosed(const Component& component) const {
    const PatchNetwork& network = surface_.network;
    if (network.edges.empty()) return false;  // a network without links, of which nothing is joined
    if (network.open_edge_count == 0) return true;
    return std::all_of(component.patches.begin(), component.patches.end(), [&](std::size_t patch) {
      const auto first = network.edges.begin() + network.first_edge[patch];
      const int count = EdgeCount(network.model.patches[patch].shape);
      return std::all_of(first, first + count, [](const EdgeLink& link) {
        return link.neighbor || link.collapsed || link.on_t_junction;
      });
    });
  }

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
  Neighbors neighbors_;
  std::vector<int> orientation_;
  std::vector<std::vector<std::size_t>> pieces_of_;
};

}  // namespace

absl::StatusOr<AirSides> FindAirSides(const Surface& surface, const RunContext& run) {
  std::vector<Looks> looks(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, surface.pieces.size(),
                                 [&](std::size_t i) { looks[i] = LooksOf(surface.pieces[i]); }));
  return SideFinder(surface, run).Run(looks);
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
      if (steepest > kMostUprightSlope || steepest * (high - low) > kMostLean) return kUprightFace;
    }
  }
  return std::max(kUprightFace, kLeanMargin * steepest);
}

int OrientationOf(const Piece& piece) {
  const Vec2 u = piece.native[1] - piece.native[0], v = piece.native[2] - piece.native[0];
  return u.x() * v.y() - u.y() * v.x() < 0.0 ? -1 : 1;
}

std::optional<Vec3> NormalOfPatch(const Piece& piece, const SurfaceJet& jet) {
  std::optional<Vec3> normal = UnitNormal(jet);
  if (normal && OrientationOf(piece) < 0) *normal = -*normal;
  return normal;
}

void SetAirSides(const AirSides& sides, std::vector<Piece>& pieces) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces[i].sides.air_side = sides.of_patch[pieces[i].patch.index()] * OrientationOf(pieces[i]);
    pieces[i].sides.outer_side = sides.outer_of_patch[pieces[i].patch.index()] * OrientationOf(pieces[i]);
    pieces[i].sides.overhangs = sides.overhangs[i] != 0;
  }
}

void SetAirSide(PatchId patch, int side, std::vector<Piece>& pieces) {
  for (Piece& piece : pieces) {
    if (piece.patch == patch) piece.sides.air_side = side * OrientationOf(piece);
  }
}

}  // namespace patchmill
