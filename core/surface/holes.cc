#include "core/surface/holes.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/Eigenvalues>

#include "core/base/index.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/base/union_find.h"
#include "core/diffgeo/forms.h"
#include "core/surface/air_sides.h"
#include "core/surface/face_figures.h"

namespace patchmill {
namespace {

constexpr double kSameCylinder = 1e-4;         // share of the radius that places of one cylinder may be off
constexpr int kFitSteps = 4, kTurnSteps = 16;  // of a piece along each parameter
constexpr int kTurnBins = 72;                  // of 5 degrees each
constexpr int kEdgeSteps = 64;                 // of an edge
// Share of the way from its edge to its centre at which a patch is looked at.
constexpr double kInward = 0.02;

// A cylinder that is hollow. The axis looks up; a level one looks along +X, or +Y.
struct Cylinder {
  double radius = 0.0;
  Vec3 origin = Vec3::Zero(), axis = Vec3::UnitZ();

  double Height(const Vec3& p) const { return (p - origin).dot(axis); }
  double DistanceOfAxis(const Vec3& p) const { return (p - origin - Height(p) * axis).norm(); }
};

Vec3 Upwards(const Vec3& axis) {
  constexpr double kLevel = 1e-9;
  for (const int k : {2, 0, 1}) {
    if (std::abs(axis[k]) > kLevel) return axis[k] > 0.0 ? axis : Vec3(-axis);
  }
  return axis;
}

bool SameAxis(const Cylinder& a, const Cylinder& b) {
  const double off = kSameCylinder * std::max(a.radius, b.radius);
  return a.axis.cross(b.axis).norm() < kSameCylinder && a.DistanceOfAxis(b.origin) < 2.0 * off;
}

struct Sample {
  Vec3 p, normal;          // the normal points out of the body
  double concavity = 0.0;  // the larger principal curvature towards it, 1/mm
};

std::vector<Sample> SamplesOf(const Surface& surface, const std::vector<PieceId>& pieces) {
  std::vector<Sample> samples;
  for (const PieceId id : pieces) {
    const Piece& piece = surface.piece(id);
    for (int i = 0; i <= kFitSteps; ++i) {
      for (int j = 0; j <= kFitSteps; ++j) {
        const SurfaceJet jet =
            Evaluate(piece, static_cast<double>(i) / kFitSteps, static_cast<double>(j) / kFitSteps);
        if (const std::optional<Vec3> normal = NormalOfPatch(piece, jet))
          samples.push_back({jet.p, *normal, Principal(Forms(jet, *normal)).k_max});
      }
    }
  }
  return samples;
}

// The radius that the face should have: that of the file, or the middle one of its places.
std::optional<double> RadiusOf(const ModelFace& face, const std::vector<Sample>& samples) {
  if (face.kind == SurfaceKind::kCylinder && face.hollow && face.radius > 0.0) return face.radius;
  if (face.kind != SurfaceKind::kSpline || samples.empty()) return std::nullopt;
  std::vector<double> curvatures;
  for (const Sample& sample : samples) curvatures.push_back(sample.concavity);
  std::nth_element(curvatures.begin(), curvatures.begin() + static_cast<std::ptrdiff_t>(samples.size() / 2),
                   curvatures.end());
  const double k = curvatures[samples.size() / 2];
  if (!(k > 0.0)) return std::nullopt;
  return 1.0 / k;
}

// The cylinder on which all of the face lies, if there is one and the face looks to its axis.
std::optional<Cylinder> CylinderOf(const ModelFace& face, const std::vector<Sample>& samples) {
  const std::optional<double> radius = RadiusOf(face, samples);
  if (!radius || samples.empty()) return std::nullopt;
  Mat3 normals = Mat3::Zero();
  for (const Sample& sample : samples) normals += sample.normal * sample.normal.transpose();
  // Ascending eigenvalues: no normal has a part along the axis, and the normals of some arc have parts along
  // two more directions.
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(normals / static_cast<double>(samples.size()));
  constexpr double kSomeArc = 1e-4;
  if (!(solver.eigenvalues()[1] > kSomeArc)) return std::nullopt;
  Cylinder cylinder{*radius, Vec3::Zero(), Upwards(solver.eigenvectors().col(0))};
  for (const Sample& sample : samples)
    cylinder.origin += (sample.p + *radius * sample.normal) / static_cast<double>(samples.size());
  for (const Sample& sample : samples) {
    const Vec3 centre = sample.p + *radius * sample.normal;
    if (!(cylinder.DistanceOfAxis(centre) <= kSameCylinder * *radius)) return std::nullopt;
    if (!(std::abs(sample.normal.dot(cylinder.axis)) <= kSameCylinder)) return std::nullopt;
  }
  return cylinder;
}

// What faces of one cylinder cover of it.
struct Cover {
  std::bitset<kTurnBins> turn;
  double low = kInfinity, high = -kInfinity;
};

void AddCover(const Piece& piece, const Cylinder& cylinder, Cover& cover) {
  const Vec3 x = cylinder.axis.unitOrthogonal(), y = cylinder.axis.cross(x);
  std::array<std::array<double, kTurnSteps + 1>, kTurnSteps + 1> angle;
  for (int i = 0; i <= kTurnSteps; ++i) {
    for (int j = 0; j <= kTurnSteps; ++j) {
      const Vec3 p =
          Position(piece, static_cast<double>(i) / kTurnSteps, static_cast<double>(j) / kTurnSteps);
      const Vec3 d = p - cylinder.origin;
      angle[At(i)][At(j)] = std::atan2(d.dot(y), d.dot(x));
      cover.low = std::min(cover.low, d.dot(cylinder.axis));
      cover.high = std::max(cover.high, d.dot(cylinder.axis));
    }
  }
  // Marks all bins between two neighbouring samples.
  const auto mark = [&](double from, double to) {
    const double way = std::remainder(to - from, 2.0 * kPi);
    if (std::abs(way) > 0.25 * kPi) return;  // too coarse to know which way around
    const double bin = 2.0 * kPi / kTurnBins;
    const double first = std::floor((from + std::min(way, 0.0)) / bin);
    const double last = std::floor((from + std::max(way, 0.0)) / bin);
    for (double k = first; k <= last; k += 1.0)
      cover.turn.set(static_cast<std::size_t>(std::fmod(k + 4.0 * kTurnBins, kTurnBins)));
  };
  for (int i = 0; i <= kTurnSteps; ++i) {
    for (int j = 0; j < kTurnSteps; ++j) {
      mark(angle[At(i)][At(j)], angle[At(i)][At(j + 1)]);
      mark(angle[At(j)][At(i)], angle[At(j + 1)][At(i)]);
    }
  }
}

// What lies around one end of a hole.
struct Rim {
  double open = 0.0, closed = 0.0;  // mm of edges beyond which the surface falls away, or rises into the air
  std::set<FaceId> open_faces, closed_faces;
};

// An edge of the hole's wall and one of another patch that runs along it.
struct WallEdge {
  PatchEdge wall, beside;
  double wall_from = 0.0, wall_to = 1.0;  // the parameters between which they run together
  double beside_from = 0.0, beside_to = 1.0;
};

class RimFinder {
 public:
  RimFinder(const Surface& surface, const Cylinder& cylinder, double middle)
      : surface_(surface), cylinder_(cylinder), middle_(middle) {}

  // rims[0] is that of the upper end.
  void Add(const WallEdge& edge, std::array<Rim, 2>& rims) const {
    const double at = 0.5 * (edge.wall_from + edge.wall_to);
    const SurfaceJet wall = JetAt(edge.wall, at, 0.0);
    std::optional<Vec3> normal = UnitNormal(wall);
    if (!normal) normal = UnitNormal(JetAt(edge.wall, at, kInward));
    if (!normal) return;
    const double t = Nearest(edge, wall.p);
    const Vec3 inward = JetAt(edge.beside, t, kInward).p - JetAt(edge.beside, t, 0.0).p;
    const double rise = inward.dot(*normal);
    constexpr double kLevel = 1e-5;  // share of the way that counts as neither
    Rim& rim = rims[cylinder_.Height(wall.p) > middle_ ? 0 : 1];
    const auto& face = surface_.network.model.patches[edge.beside.patch.index()].face;
    if (std::abs(rise) <= kLevel * inward.norm() || !face) return;
    (rise > 0.0 ? rim.closed : rim.open) += Length(edge);
    (rise > 0.0 ? rim.closed_faces : rim.open_faces).insert(*face);
  }

 private:
  SurfaceJet JetAt(PatchEdge edge, double t, double inward) const {
    const PatchShape& shape = surface_.network.model.patches[edge.patch.index()].shape;
    const Vec2 middle = IsTriangle(shape) ? Vec2::Constant(1.0 / 3.0) : Vec2::Constant(0.5);
    Vec2 uv = EdgeParameters(shape, edge.edge, t);
    uv += inward * (middle - uv);
    return Evaluate(surface_, edge.patch, uv.x(), uv.y());
  }
  // The parameter of the other patch's edge nearest to a place of the wall's.
  double Nearest(const WallEdge& edge, const Vec3& p) const {
    double best = 0.0, distance = kInfinity;
    for (int k = 0; k <= kEdgeSteps; ++k) {
      const double t = std::lerp(edge.beside_from, edge.beside_to, static_cast<double>(k) / kEdgeSteps);
      const double d = (JetAt(edge.beside, t, 0.0).p - p).norm();
      if (d < distance) std::tie(best, distance) = std::pair(t, d);
    }
    return best;
  }
  double Length(const WallEdge& edge) const {
    constexpr int kSteps = 8;
    double length = 0.0;
    Vec3 last = JetAt(edge.wall, edge.wall_from, 0.0).p;
    for (int k = 1; k <= kSteps; ++k) {
      const double t = std::lerp(edge.wall_from, edge.wall_to, static_cast<double>(k) / kSteps);
      const Vec3 next = JetAt(edge.wall, t, 0.0).p;
      length += (next - last).norm();
      last = next;
    }
    return length;
  }

  const Surface& surface_;
  const Cylinder& cylinder_;
  double middle_;
};

struct FoundHole {
  Hole hole;
  Cylinder cylinder;
  std::array<Rim, 2> rims;
};

// Hollow cylinders of a model, and the set of joined faces of one cylinder that each belongs to.
struct HollowFaces {
  std::vector<std::optional<Cylinder>> cylinder;  // index: face
  std::vector<std::size_t> set;                   // index: face; the first face of its set
};

HollowFaces JoinCylinders(const PatchNetwork& network, std::vector<std::optional<Cylinder>> cylinders) {
  UnionFind sets(cylinders.size());
  const auto join = [&](PatchId one, PatchId two) {
    const auto &a = network.model.patches[one.index()].face, &b = network.model.patches[two.index()].face;
    if (!a || !b || !cylinders[a->index()] || !cylinders[b->index()]) return;
    const Cylinder &c = *cylinders[a->index()], &d = *cylinders[b->index()];
    if (std::abs(c.radius - d.radius) <= kSameCylinder * c.radius && SameAxis(c, d))
      sets.Join(a->index(), b->index());
  };
  for (const EdgeLink& link : network.edges) {
    if (link.neighbor) join(link.self.patch, link.neighbor->patch);
  }
  for (const PartLink& link : network.part_links) join(link.part.patch, link.whole.patch);
  HollowFaces faces{std::move(cylinders), {}};
  for (std::size_t f = 0; f < faces.cylinder.size(); ++f) faces.set.push_back(sets.Find(f));
  return faces;
}

// The edges at which the wall of each set of faces ends at another face. Index: the first face of the set.
std::map<std::size_t, std::vector<WallEdge>> WallEdges(const PatchNetwork& network,
                                                       const HollowFaces& hollow) {
  std::map<std::size_t, std::vector<WallEdge>> edges;
  const auto set_of = [&](PatchId patch) -> std::optional<std::size_t> {
    const auto& face = network.model.patches[patch.index()].face;
    if (!face || !hollow.cylinder[face->index()]) return std::nullopt;
    return hollow.set[face->index()];
  };
  const auto add = [&](const WallEdge& edge) {
    const auto set = set_of(edge.wall.patch);
    if (set && set != set_of(edge.beside.patch)) edges[*set].push_back(edge);
  };
  for (const EdgeLink& link : network.edges) {
    if (link.neighbor && !link.collapsed) add({link.self, *link.neighbor});
  }
  for (const PartLink& link : network.part_links) {
    add({.wall = link.part, .beside = link.whole, .beside_from = link.from, .beside_to = link.to});
    add({.wall = link.whole, .beside = link.part, .wall_from = link.from, .wall_to = link.to});
  }
  return edges;
}

// The first end is at the upper end of the cylinder, unless only the lower one is open.
void SetEnds(const Cover& cover, FoundHole& found) {
  Hole& hole = found.hole;
  for (const std::size_t k : {0, 1})
    hole.ends[k] = found.rims[k].closed > found.rims[k].open ? HoleEnd::kFloor : HoleEnd::kOpen;
  hole.depth = cover.high - cover.low;
  const bool turned = hole.ends[0] == HoleEnd::kFloor && hole.ends[1] == HoleEnd::kOpen;
  if (turned) {
    std::swap(hole.ends[0], hole.ends[1]);
    std::swap(found.rims[0], found.rims[1]);
  }
  const Cylinder& cylinder = found.cylinder;
  hole.mouth = cylinder.origin + (turned ? cover.low : cover.high) * cylinder.axis;
  hole.direction = turned ? cylinder.axis : Vec3(-cylinder.axis);
}

// A floor is a step where a narrower hole of the same axis begins.
void FindSteps(std::vector<FoundHole>& holes) {
  std::map<FaceId, std::vector<std::size_t>> by_mouth;  // holes that open into a face
  for (std::size_t k = 0; k < holes.size(); ++k) {
    for (const Rim& rim : holes[k].rims) {
      for (const FaceId face : rim.open_faces) by_mouth[face].push_back(k);
    }
  }
  for (FoundHole& wide : holes) {
    const auto begins_in = [&](FaceId face) {
      const auto found = by_mouth.find(face);
      return found != by_mouth.end() &&
             std::any_of(found->second.begin(), found->second.end(), [&](std::size_t k) {
               return holes[k].hole.diameter < wide.hole.diameter &&
                      SameAxis(holes[k].cylinder, wide.cylinder);
             });
    };
    for (const std::size_t k : {0, 1}) {
      const std::set<FaceId>& floor = wide.rims[k].closed_faces;
      if (wide.hole.ends[k] == HoleEnd::kFloor && std::any_of(floor.begin(), floor.end(), begins_in))
        wide.hole.ends[k] = HoleEnd::kStep;
    }
  }
}

}  // namespace

absl::StatusOr<std::vector<Hole>> FindHoles(const Surface& surface, const RunContext& run) {
  const PatchNetwork& network = surface.network;
  const std::vector<ModelFace>& faces = network.model.faces;
  const std::vector<std::vector<PieceId>> pieces = PiecesOfFaces(surface);
  std::vector<std::optional<Cylinder>> cylinders(faces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, faces.size(), [&](std::size_t f) {
    const bool may_be = faces[f].kind == SurfaceKind::kCylinder || faces[f].kind == SurfaceKind::kSpline;
    if (may_be && !faces[f].skipped) cylinders[f] = CylinderOf(faces[f], SamplesOf(surface, pieces[f]));
  }));
  const HollowFaces hollow = JoinCylinders(network, std::move(cylinders));
  std::map<std::size_t, FoundHole> sets;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (!hollow.cylinder[f]) continue;
    FoundHole& found = sets[hollow.set[f]];
    if (found.hole.faces.empty()) found.cylinder = *hollow.cylinder[f];
    found.hole.faces.emplace_back(f);
  }
  const std::map<std::size_t, std::vector<WallEdge>> edges = WallEdges(network, hollow);
  std::vector<FoundHole> holes;
  for (auto& [set, found] : sets) {
    PM_RETURN_IF_ERROR(run.Check());
    Cover cover;
    for (const FaceId face : found.hole.faces) {
      for (const PieceId piece : pieces[face.index()]) AddCover(surface.piece(piece), found.cylinder, cover);
    }
    if (!cover.turn.all()) continue;
    found.hole.diameter = 2.0 * found.cylinder.radius;
    const RimFinder finder(surface, found.cylinder, 0.5 * (cover.low + cover.high));
    if (const auto own = edges.find(set); own != edges.end()) {
      for (const WallEdge& edge : own->second) finder.Add(edge, found.rims);
    }
    SetEnds(cover, found);
    holes.push_back(std::move(found));
  }
  FindSteps(holes);
  std::vector<Hole> result;
  for (FoundHole& found : holes) result.push_back(std::move(found.hole));
  return result;
}

}  // namespace patchmill
