#include "cam/region/border/border_lines.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "cam/region/watershed/catchments.h"
#include "core/base/status.h"
#include "core/base/union_find.h"
#include "core/spatial/box_grid.h"

namespace patchmill {
namespace {

// One side of a triangle that is a border.
struct Strand {
  BorderKind kind = BorderKind::kSlope;
  RegionId region = kNoRegion, other = kNoRegion;
  ComponentId component = kNoComponent, other_component = kNoComponent;
  std::vector<Vec3> points;
  std::size_t ends[2] = {0, 0};  // numbers of the places of its first and last point

  bool Continues(const Strand& s) const {
    return std::tie(kind, region, other) == std::tie(s.kind, s.region, s.other);
  }
};

BorderKind KindOf(const std::vector<SplitMesh>& meshes, const std::vector<Region>& regions,
                  const Adjacency& a, const Strand& strand) {
  if (strand.other == kNoRegion) return BorderKind::kOpenEdge;
  const Region &own = regions[strand.region.index()], &other = regions[strand.other.index()];
  if (own.reason != other.reason) {
    const bool reached = own.kind != RegionKind::kUnreachable && other.kind != RegionKind::kUnreachable;
    return reached ? BorderKind::kStrategy : BorderKind::kReach;
  }
  const bool slope = own.slope != other.slope, curvature = own.kind != other.kind;
  const bool watershed = OnWatershed(meshes, a, 0.0);
  if (!slope && !curvature && watershed) return BorderKind::kWatershed;
  const SplitMesh& mesh = meshes[static_cast<std::size_t>(a.side.piece)];
  const ZeroVertex &from = EndOf(mesh, a.side, 0), &to = EndOf(mesh, a.side, 1);
  const auto on = [&](Field field) {  // both ends lie on its zero curve: vertices there have the sign 0
    const auto k = static_cast<std::size_t>(field);
    return from.sign[k] == 0 && to.sign[k] == 0;
  };
  // A field that differs across the side is preferred. After merging, a region may also end where another
  // field changes. Then the labels of the triangles must differ, because curvature is 0 all over a plane.
  const SplitLabel &here = mesh.triangles[static_cast<std::size_t>(a.side.triangle)].label,
                   &there = meshes[static_cast<std::size_t>(a.other_piece)]
                                .triangles[static_cast<std::size_t>(a.other_triangle)]
                                .label;
  // Vertices of watersheds have no signs, so the labels of the triangles decide there, too.
  for (const bool differs : {true, false}) {
    const bool by_regions = differs && !watershed;
    if (slope == differs && (by_regions || here.steep != there.steep) && on(Field::kSlope))
      return BorderKind::kSlope;
    if (curvature != differs || (!by_regions && here.curvature == there.curvature)) continue;
    if (on(Field::kCurvature)) return BorderKind::kCurvature;
    if (on(Field::kTurn)) return BorderKind::kSilhouette;
  }
  // The border lies between two mountains or two basins, or a part of one of them has joined another region.
  // Where watershed lines do not reach, areas are divided along triangles.
  if (watershed || (!slope && !curvature) || here == there) return BorderKind::kWatershed;
  if (a.across_seam) return BorderKind::kSeam;
  return slope ? BorderKind::kSlope : BorderKind::kCurvature;
}

// The places where strands end.
class EndPlaces {
 public:
  // Ends within `weld` (mm) of each other are one place. JoinLoose looks for ends up to `reach` (mm) away.
  EndPlaces(double weld, double reach, const std::vector<Strand>& strands)
      : strands_(strands),
        reach_(std::max(weld, reach)),
        grid_(PlacesOf(strands), std::max(kCell * reach_, 4.0 * weld)),
        sets_(2 * strands.size()) {
    for (std::size_t end = 0; end < Ends(); ++end)
      ForNear(end, weld, [&](std::size_t other, double) { sets_.Join(end, other); });
  }

  // Where a seam is cut differently on its two sides, lines end close to each other without meeting. Loose
  // ends of lines that continue each other become one place, nearest pairs first. Then each other loose end
  // joins the place nearest to it.
  void JoinLoose() {
    struct Pair {
      double distance;
      std::size_t a, b;
    };
    const std::vector<int> counts = Counts();
    const auto loose = [&](std::size_t end) { return counts[sets_.Find(end)] == 1; };
    std::vector<Pair> pairs;
    for (std::size_t a = 0; a < Ends(); ++a) {
      if (!loose(a)) continue;
      ForNear(a, reach_, [&](std::size_t b, double distance) {
        if (a < b && loose(b) && a / 2 != b / 2 && strands_[a / 2].Continues(strands_[b / 2]))
          pairs.push_back({distance, a, b});
      });
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) {
      return std::tie(x.distance, x.a, x.b) < std::tie(y.distance, y.a, y.b);
    });
    std::vector<char> taken(Ends(), 0);
    for (const Pair& pair : pairs) {
      if (taken[pair.a] || taken[pair.b]) continue;
      taken[pair.a] = taken[pair.b] = 1;
      sets_.Join(pair.a, pair.b);
    }
    for (std::size_t a = 0; a < Ends(); ++a) {
      if (!loose(a) || taken[a]) continue;
      std::size_t best = a;
      double nearest = reach_;
      ForNear(a, reach_, [&](std::size_t b, double distance) {
        if (a / 2 == b / 2 || distance > nearest) return;
        if (distance == nearest && b > best) return;
        nearest = distance;
        best = b;
      });
      sets_.Join(a, best);
    }
  }

  // The number of each end's place (index 2 i and 2 i + 1 for strand i), and the number of places.
  std::pair<std::vector<std::size_t>, std::size_t> Number() {
    std::vector<std::size_t> number(Ends());
    std::size_t count = 0;
    for (std::size_t end = 0; end < number.size(); ++end) {
      const std::size_t set = sets_.Find(end);  // the smallest end at the place
      number[end] = set == end ? count++ : number[set];
    }
    return {std::move(number), count};
  }

 private:
  static constexpr double kCell = 0.25;  // of reach_: cell of the grid

  std::size_t Ends() const { return 2 * strands_.size(); }

  const Vec3& At(std::size_t end) const {
    const std::vector<Vec3>& points = strands_[end / 2].points;
    return end % 2 == 0 ? points.front() : points.back();
  }

  static std::vector<Box3> PlacesOf(const std::vector<Strand>& strands) {
    std::vector<Box3> places;
    for (const Strand& s : strands) {
      places.push_back({s.points.front(), s.points.front()});
      places.push_back({s.points.back(), s.points.back()});
    }
    return places;
  }

  // Calls visit(other, distance) for the other ends within `reach`.
  template <typename Visit>
  void ForNear(std::size_t end, double reach, const Visit& visit) const {
    const Vec3& p = At(end);
    grid_.Near(p, reach, [&](std::size_t other) {
      const double distance = (At(other) - p).norm();
      if (other != end && distance <= reach) visit(other, distance);
    });
  }

  // The number of ends in each set, at the index of its smallest end.
  std::vector<int> Counts() {
    std::vector<int> counts(Ends(), 0);
    for (std::size_t end = 0; end < Ends(); ++end) ++counts[sets_.Find(end)];
    return counts;
  }

  const std::vector<Strand>& strands_;
  double reach_;
  BoxGrid grid_;  // of the ends; 2 i and 2 i + 1 belong to strand i
  UnionFind sets_;
};

// Joins strands to lines. Lines that begin at a node come first, then closed ones.
class Chainer {
 public:
  Chainer(const std::vector<Strand>& strands, std::size_t places, double weld)
      : strands_(strands),
        weld_(weld),
        at_(places),
        where_(places),
        node_(places, -1),
        used_(strands.size(), 0) {
    for (std::size_t i = 0; i < strands.size(); ++i) {
      for (const std::size_t which : {0, 1}) {
        std::vector<std::size_t>& here = at_[strands[i].ends[which]];
        if (here.empty()) where_[strands[i].ends[which]] = EndOf(strands[i], which);
        here.push_back(i);
      }
    }
  }

  BorderNet Chain() {
    BorderNet net;
    for (std::size_t i = 0; i < strands_.size(); ++i) {
      for (const std::size_t which : {0, 1}) {
        if (!used_[i] && !Passes(strands_[i].ends[which])) net.lines.push_back(LineFrom(i, which, net.nodes));
      }
    }
    for (std::size_t i = 0; i < strands_.size(); ++i) {
      if (!used_[i]) net.lines.push_back(LineFrom(i, 0, net.nodes));
    }
    return net;
  }

 private:
  // True if a line passes through this place: exactly two strands end here, and they continue each other.
  bool Passes(std::size_t place) const {
    const std::vector<std::size_t>& here = at_[place];
    return here.size() == 2 && strands_[here[0]].Continues(strands_[here[1]]);
  }

  static const Vec3& EndOf(const Strand& strand, std::size_t which) {
    return which == 0 ? strand.points.front() : strand.points.back();
  }

  // Adds p to the line, unless the line ends there already. A line whose end is not at its node continues
  // straight to the node.
  void Append(const Vec3& p, std::vector<Vec3>& points) const {
    if (points.empty() || (points.back() - p).norm() > weld_) points.push_back(p);
  }

  int NodeAt(std::size_t place, std::vector<Vec3>& nodes) {
    if (node_[place] < 0) {
      node_[place] = static_cast<int>(nodes.size());
      nodes.push_back(where_[place]);
    }
    return node_[place];
  }

  BorderLine LineFrom(std::size_t i, std::size_t which, std::vector<Vec3>& nodes) {
    BorderLine line;
    line.kind = strands_[i].kind;
    line.region = strands_[i].region;
    line.other = strands_[i].other;
    line.component = strands_[i].component;
    line.other_component = strands_[i].other_component;
    const std::size_t start = strands_[i].ends[which];
    if (!Passes(start)) {
      line.from = NodeAt(start, nodes);
      line.points.push_back(where_[start]);
    }
    while (true) {
      used_[i] = 1;
      std::vector<Vec3> points = strands_[i].points;
      if (which == 1) std::reverse(points.begin(), points.end());
      Append(points.front(), line.points);
      line.points.insert(line.points.end(), points.begin() + 1, points.end());
      const std::size_t end = strands_[i].ends[1 - which];
      if (!Passes(end)) {
        line.to = NodeAt(end, nodes);
        Append(where_[end], line.points);
        return line;
      }
      if (end == start) break;
      i = at_[end][at_[end][0] == i ? 1 : 0];
      which = strands_[i].ends[0] == end ? 0 : 1;
    }
    line.closed = true;
    if ((line.points.back() - line.points.front()).norm() <= weld_) line.points.pop_back();
    return line;
  }

  const std::vector<Strand>& strands_;
  double weld_;
  std::vector<std::vector<std::size_t>> at_;  // [place]: strands that end there
  std::vector<Vec3> where_;                   // [place]
  std::vector<int> node_;                     // [place]: its node, or -1 while no line ends there
  std::vector<char> used_;
};

// Largest distance between the ends of a side on a seam, mm.
double LongestSeamSide(const SplitSurface& split) {
  double longest = 0.0;
  for (const AdjacencyList::Seam& seam : split.adjacency.seams) {
    const TriangleSide side = split.adjacency[seam.side].side;
    const SplitMesh& mesh = split.meshes[static_cast<std::size_t>(side.piece)];
    longest = std::max(longest, (EndOf(mesh, side, 1).p - EndOf(mesh, side, 0).p).norm());
  }
  return longest;
}

}  // namespace

absl::StatusOr<BorderNet> FindBorderLines(const SplitSurface& split, const TriangleRegions& triangles,
                                          const BorderPoints& border, const std::vector<Region>& regions,
                                          const RunContext& run) {
  const auto component = [&](int piece, int triangle) {
    if (piece < 0) return kNoComponent;
    return triangles.component_of[static_cast<std::size_t>(piece)][static_cast<std::size_t>(triangle)];
  };
  const auto region = [&](ComponentId of) {
    return of == kNoComponent ? kNoRegion : triangles.component_region[of.index()];
  };
  std::vector<Strand> strands;
  for (std::size_t k = 0; k < border.sides.size(); ++k) {
    const Adjacency a = split.adjacency[border.sides[k]];
    const ComponentId own = component(a.side.piece, a.side.triangle),
                      other = component(a.other_piece, a.other_triangle);
    if (other != kNoComponent && other < own) continue;  // the side of the other triangle stands for both
    strands.push_back({BorderKind::kOpenEdge, region(own), region(other), own, other, border.points[k], {}});
    strands.back().kind = KindOf(split.meshes, regions, a, strands.back());
  }
  const double weld = std::max(2.0 * split.surface->network.join_tolerance, 1e-7);
  EndPlaces places(weld, LongestSeamSide(split), strands);
  places.JoinLoose();
  PM_RETURN_IF_ERROR(run.Check());
  const auto [number, count] = places.Number();
  for (std::size_t i = 0; i < strands.size(); ++i) {
    strands[i].ends[0] = number[2 * i];
    strands[i].ends[1] = number[2 * i + 1];
  }
  // A short side whose ends are one place is dropped.
  std::erase_if(strands, [](const Strand& s) { return s.ends[0] == s.ends[1] && s.points.size() == 2; });
  return Chainer(strands, count, weld).Chain();
}

}  // namespace patchmill
