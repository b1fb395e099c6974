#include "core/editing/split_faces.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/base/status.h"
#include "core/editing/guide_curve.h"
#include "core/editing/section_points.h"

namespace patchmill {
namespace {

using Ends = std::pair<int, int>;

absl::Status Error(const std::string& at, const std::string& text) {
  return absl::InvalidArgumentError(at + " " + text);
}

// A face of the row: the cut enters by one side and leaves by the opposite one.
struct Crossed {
  int face = 0, side = 0;  // the side by which it enters
};

// An edge that is cut, in the order of the row.
struct CutEdge {
  int edge = 0;
  int from = 0, to = 0;  // its vertices, the same bank of the cut first
  int vertex = -1;       // the new one
};

struct Row {
  std::vector<CutEdge> edges;
  std::vector<Crossed> faces;  // faces[k] lies between edges[k] and the next one
  bool closed = false;
};

class Walker {
 public:
  Walker(const JoinedNetwork& joined, const CurveNetwork& network, const std::string& at)
      : joined_(joined), network_(network), at_(at) {
    for (std::size_t e = 0; e < joined.edges.size(); ++e) {
      const TableEdge& edge = joined.edges[e].topology;
      edge_of_[std::minmax(edge.start, edge.end)] = static_cast<int>(e);
    }
  }

  absl::StatusOr<Row> Walk(const FaceSplit& split) {
    const auto found = edge_of_.find(std::minmax(split.start, split.end));
    if (found == edge_of_.end()) {
      return Error(at_, fmt::format("names the edge {} {}; there is no such edge", split.start, split.end));
    }
    if (!(split.at >= kMinLedPlace && split.at <= 1.0 - kMinLedPlace)) {
      return Error(at_ + ".parameter", fmt::format("= {:g}; must be in [{:g}, {:g}]", split.at, kMinLedPlace,
                                                   1.0 - kMinLedPlace));
    }
    Row row;
    const CutEdge first{found->second, split.start, split.end};
    PM_RETURN_IF_ERROR(CheckEdge(first));
    const auto& sides = joined_.edges[At(first.edge)].topology.faces;
    row.edges = {first};
    PM_RETURN_IF_ERROR(Follow(sides[0], row));
    if (row.closed || sides.size() < 2) return row;
    // The other way; then all in one order.
    Row back;
    back.edges = {first};
    PM_RETURN_IF_ERROR(Follow(sides[1], back));
    Row whole;
    for (std::size_t k = back.edges.size(); k-- > 1;) whole.edges.push_back(back.edges[k]);
    for (std::size_t k = back.faces.size(); k-- > 0;) {
      Crossed turned = back.faces[k];
      turned.side = (turned.side + 2) % 4;
      whole.faces.push_back(turned);
    }
    whole.edges.insert(whole.edges.end(), row.edges.begin(), row.edges.end());
    whole.faces.insert(whole.faces.end(), row.faces.begin(), row.faces.end());
    return whole;
  }

 private:
  absl::Status CheckEdge(const CutEdge& cut) const {
    const JoinedEdge& edge = joined_.edges[At(cut.edge)];
    const auto fault = [&](const std::string& text) {
      return Error(at_, fmt::format("crosses the edge {} {}, {}", cut.from, cut.to, text));
    };
    if (edge.topology.divided || edge.topology.part)
      return fault("which has vertices on it or is a part of one");
    if (edge.curve.spans() > 1) return fault("whose curve has several spans");
    return absl::OkStatus();
  }

  absl::Status Follow(FaceSide side, Row& row) const {
    for (;;) {
      const NetworkFace* face =
          At(side.face) < network_.faces.size() ? &network_.faces[At(side.face)] : nullptr;
      if (face == nullptr || face->vertices.size() != 4 || !face->cuts.empty()) {
        return Error(at_,
                     fmt::format("crosses face {}, which is no quad or has cuts; end the row of quads at a "
                                 "border",
                                 joined_.face_of[At(side.face)]));
      }
      if (!face->bulges.empty()) {
        return Error(at_, fmt::format("crosses face {}, which has bulges; split it before its places move",
                                      side.face));
      }
      for (const Crossed& before : row.faces) {
        if (before.face == side.face) {
          return Error(at_, fmt::format("crosses face {} both ways; split another row first", side.face));
        }
      }
      row.faces.push_back({side.face, side.side});
      const auto& loop = face->vertices;
      const int a = loop[At(side.side)];
      const bool first = a == row.edges.back().from;
      // Seen from the side a b, the opposite one is c d, and d lies on the bank of a.
      const int c = loop[At((side.side + 2) % 4)], d = loop[At((side.side + 3) % 4)];
      const CutEdge next{edge_of_.at(std::minmax(c, d)), first ? d : c, first ? c : d};
      if (next.edge == row.edges.front().edge) {
        if (next.from != row.edges.front().from) {
          return Error(at_, "comes back on the other bank of its first edge; the row is a Moebius band");
        }
        row.closed = true;
        return absl::OkStatus();
      }
      PM_RETURN_IF_ERROR(CheckEdge(next));
      row.edges.push_back(next);
      const auto& sides = joined_.edges[At(next.edge)].topology.faces;
      const auto other = std::ranges::find_if(sides, [&](const FaceSide& s) { return s.face != side.face; });
      if (other == sides.end()) return absl::OkStatus();
      side = *other;
    }
  }

  const JoinedNetwork& joined_;
  const CurveNetwork& network_;
  const std::string& at_;
  std::map<Ends, int> edge_of_;
};

class Splitter {
 public:
  Splitter(const JoinedNetwork& joined, const Row& row, double at, CurveNetwork& network)
      : joined_(joined), before_(network), row_(row), at_(at), network_(network) {}

  std::vector<DividedFace> Run() {
    for (CutEdge& cut : row_.edges) Cut(cut);
    AddLines();
    for (std::size_t k = 0; k < row_.faces.size(); ++k) {
      Divide(row_.faces[k], row_.edges[k], row_.edges[(k + 1) % row_.edges.size()]);
    }
    AddControls();
    HoldNeighbours();
    return std::move(divided_);
  }

 private:
  // Makes the vertex and the two halves of the curve, exact.
  void Cut(CutEdge& cut) {
    const JoinedEdge& edge = joined_.edges[At(cut.edge)];
    const bool forward = cut.from == edge.topology.start;
    BezierCurve curve = SpanOf(edge.curve, 0);
    if (!forward) curve = Reversed(curve);
    BezierCurve low = Part(curve, 0.0, at_), high = Part(curve, at_, 1.0);
    cut.vertex = static_cast<int>(network_.vertices.size());
    network_.vertices.emplace_back().position = low.points.back();
    high.points.front() = low.points.back();
    NetworkEdge first, second;
    const auto old = std::ranges::find_if(network_.edges, [&](const NetworkEdge& e) {
      return Ends(std::minmax(e.start, e.end)) == Ends(std::minmax(cut.from, cut.to));
    });
    if (old != network_.edges.end()) first.id = old->id;
    first.start = cut.from, first.end = cut.vertex, first.shape = CurveEdge{std::move(low)};
    second.start = cut.vertex, second.end = cut.to, second.shape = CurveEdge{std::move(high)};
    first.crease = second.crease = edge.topology.crease;
    if (old != network_.edges.end()) {
      *old = std::move(first);
    } else {
      network_.edges.push_back(std::move(first));
    }
    network_.edges.push_back(std::move(second));
  }

  // The derivative of a face across its side at the cut, into it.
  Vec3 Across(const Crossed& crossed, bool entry) const {
    const PatchShape& shape = joined_.model.patches[At(crossed.face)].shape;
    const int side = entry ? crossed.side : (crossed.side + 2) % 4;
    const NetworkFace& face = network_.faces[At(crossed.face)];
    const CutEdge* cut = nullptr;
    const Ends ends = std::minmax(face.vertices[At(side)], face.vertices[At((side + 1) % 4)]);
    for (const CutEdge& edge : row_.edges) {
      if (Ends(std::minmax(edge.from, edge.to)) == ends) cut = &edge;
    }
    const double along = cut->from == face.vertices[At(side)] ? at_ : 1.0 - at_;
    const double u[4] = {along, 1.0, 1.0 - along, 0.0}, v[4] = {0.0, along, 1.0, 1.0 - along};
    const SurfaceJet s = Evaluate(shape, u[side], v[side]);
    const double inward = side == 0 || side == 3 ? 1.0 : -1.0;
    return inward * (side % 2 == 0 ? s.dv : s.du);
  }

  bool IsG2(const Crossed& crossed) const {
    return network_.faces[At(crossed.face)].scheme == PatchScheme::kG2Gregory;
  }

  // The new edges. Through G2-Gregory faces they are splines, so that curvatures stay equal; through others
  // they have the tangents of the surface.
  void AddLines() {
    const std::size_t count = row_.faces.size();
    const auto parted = [&](std::size_t k) {  // whether a spline ends at edge k
      if (!row_.closed && (k == 0 || k == count)) return true;
      const Crossed &before = row_.faces[(k + count - 1) % count], &after = row_.faces[k % count];
      return joined_.edges[At(row_.edges[k % row_.edges.size()].edge)].topology.crease || !IsG2(before) ||
             !IsG2(after);
    };
    std::size_t start = 0;
    while (start < count && !parted(start)) ++start;
    if (start == count) {  // a closed row without an end
      AddSpline(0, count, true);
      return;
    }
    for (std::size_t done = 0; done < count;) {
      const std::size_t first = (start + done) % count;
      std::size_t length = 1;
      while (done + length < count && !parted((first + length) % (row_.closed ? count : count + 1))) ++length;
      AddSpline(first, length, false);
      done += length;
    }
  }

  // New edges through `length` faces: the spline of [editing, section 5], which lies on a bicubic surface.
  void AddSpline(std::size_t first, std::size_t length, bool closed) {
    const auto cut = [&](std::size_t k) { return row_.edges[(first + k) % row_.edges.size()].vertex; };
    std::vector<Vec3> places;
    std::vector<GuideSpan> spans;
    for (std::size_t k = 0; k < length + (closed ? 0 : 1); ++k) {
      places.push_back(network_.vertices[At(cut(k))].position);
    }
    for (std::size_t k = 0; k < length; ++k) {
      const Crossed& face = row_.faces[(first + k) % row_.faces.size()];
      spans.push_back({Across(face, true), Across(face, false)});
    }
    const auto guide = GuideThrough(places, spans, {});
    for (std::size_t k = 0; k < length; ++k) {
      const Vec3 from = guide.ok() ? (*guide)[k].from.d : spans[k].from,
                 to = guide.ok() ? (*guide)[k].to.d : spans[k].to;
      NetworkEdge& edge = network_.edges.emplace_back();
      edge.start = cut(k), edge.end = cut(k + 1);
      edge.shape = TangentsEdge{from, to};
    }
  }

  void Divide(const Crossed& crossed, const CutEdge& in, const CutEdge& out) {
    DividedFace done;
    const int old = done.face = crossed.face, made = done.made = static_cast<int>(network_.faces.size());
    const std::vector<int> loop = network_.faces[At(old)].vertices;
    done.along_u = crossed.side % 2 == 0;
    std::vector<int> near, far;  // with the first corner, and the other one
    for (int k = 0; k < 4; ++k) {
      const int v = loop[At(k)], next = loop[At((k + 1) % 4)];
      const auto is_from = [&](int vertex) { return vertex == in.from || vertex == out.from; };
      (is_from(v) == is_from(loop[0]) ? near : far).push_back(v);
      for (const CutEdge* cut : {&in, &out}) {
        if (Ends(std::minmax(v, next)) != Ends(std::minmax(cut->from, cut->to))) continue;
        near.push_back(cut->vertex), far.push_back(cut->vertex);
      }
    }
    done.at = loop[0] == in.from || loop[0] == out.from ? at_ : 1.0 - at_;
    if (!done.along_u) std::rotate(far.begin(), far.end() - 1, far.end());  // so that u runs as before
    NetworkFace first = network_.faces[At(old)];
    first.pushes.clear(), first.twists.clear();
    NetworkFace second = first;
    if (!first.id.empty()) second.id = FreeId(first.id);
    first.vertices = near, second.vertices = far;
    if (TakesTwists(first)) {
      for (const bool low : {true, false}) {
        for (int side = 0; side < 4; ++side) AddTwists(done, side, low, low ? first : second);
      }
    }
    network_.faces[At(old)] = std::move(first);
    network_.faces.push_back(std::move(second));
    for (const int v : far) {
      for (NetworkVertex::Normal& normal : network_.vertices[At(v)].normals) {
        std::ranges::replace(normal.faces, old, made);
      }
    }
    const Ends entry = std::minmax(in.from, in.to), exit = std::minmax(out.from, out.to);
    std::erase_if(network_.controls, [&](const CrossControl& c) {
      const Ends ends = std::minmax(c.start, c.end);
      return ends == entry || ends == exit;
    });
    const auto is_far = [&](int v) { return std::ranges::count(far, v) > 0; };
    for (CrossControl& c : network_.controls) {
      if (c.face == old && is_far(c.start) && is_far(c.end)) c.face = made;
    }
    divided_.push_back(done);
  }

  static bool TakesTwists(const NetworkFace& face) {
    return face.scheme != PatchScheme::kG2Gregory && face.scheme != PatchScheme::kHosaka;
  }

  // The tangents of a face across one of its sides, along the side.
  std::optional<BezierChain> TangentsOf(int face, int side) const {
    for (const JoinedEdge& edge : joined_.edges) {
      for (std::size_t k = 0; k < edge.topology.faces.size() && k < edge.tangents.size(); ++k) {
        const FaceSide& s = edge.topology.faces[k];
        if (s.face != face || s.side != side) continue;
        if (edge.kind == EdgeKind::kFollowing || edge.kind == EdgeKind::kLeading) return std::nullopt;
        const std::vector<int>& loop = before_.faces[At(face)].vertices;
        return edge.topology.start == loop[At(side)] ? edge.tangents[k] : Reversed(edge.tangents[k]);
      }
    }
    return std::nullopt;
  }

  static SideTwists TwistsOf(const BezierChain& tangents, const Ends& ends) {
    return {ends.first, ends.second, Evaluate(tangents, 0.0).d, Vec3(-Evaluate(tangents, 1.0).d)};
  }

  // The twists that the surface has along a side of a half. So the half begins as the surface does.
  void AddTwists(const DividedFace& done, int side, bool low, NetworkFace& half) const {
    const Ends ends(half.vertices[At(side)], half.vertices[At((side + 1) % 4)]);
    const double share = low ? done.at : 1.0 - done.at;
    const bool crossing = (side % 2 == 0) == done.along_u;  // the side is a half of an edge that was cut
    const int inner = done.along_u ? (low ? 1 : 3) : (low ? 2 : 0);
    if (side == inner) {
      const PatchShape& shape = joined_.model.patches[At(done.face)].shape;
      const double inward = (low ? -1.0 : 1.0) * share, u = done.at;
      const auto at = [&](double t) {
        return done.along_u ? Evaluate(shape, u, t).duv : Evaluate(shape, t, u).duv;
      };
      const bool forward = side == 0 || side == 1;  // the side runs with the parameter
      const Vec3 from = inward * at(forward ? 0.0 : 1.0), to = inward * at(forward ? 1.0 : 0.0);
      const double run = forward ? 1.0 : -1.0;
      half.twists.push_back({ends.first, ends.second, Vec3(run * from), Vec3(-run * to)});
      return;
    }
    const auto whole = TangentsOf(done.face, side);
    if (!whole) return;
    BezierChain tangents = *whole;
    if (crossing) {
      const bool from_start = low == (side == 0 || side == 1);
      tangents = Part(*whole, from_start ? 0.0 : 1.0 - share, from_start ? share : 1.0);
    } else {
      for (Vec3& p : tangents.points) p *= share;
    }
    half.twists.push_back(TwistsOf(tangents, ends));
  }

  // How the surface crosses the middle of a side of a half, with the parameter of the half.
  CrossControl ControlOf(const DividedFace& done, int side, bool low) const {
    const NetworkFace& half = network_.faces[At(low ? done.face : done.made)];
    const double share = low ? done.at : 1.0 - done.at, from = low ? 0.0 : done.at;
    const double us[4] = {0.5, 1.0, 0.5, 0.0}, vs[4] = {0.0, 0.5, 1.0, 0.5};
    const double u = done.along_u ? from + share * us[side] : us[side],
                 v = done.along_u ? vs[side] : from + share * vs[side];
    const SurfaceJet s = Evaluate(joined_.model.patches[At(done.face)].shape, u, v);
    const bool across_u = side % 2 == 1;
    const double scale = across_u == done.along_u ? share : 1.0;
    const double inward = side == 0 || side == 3 ? scale : -scale;
    return {half.vertices[At(side)], half.vertices[At((side + 1) % 4)], low ? done.face : done.made,
            Vec3(inward * (across_u ? s.du : s.dv)), Vec3(scale * scale * (across_u ? s.duu : s.dvv))};
  }

  void SetControl(const CrossControl& control) {
    const Ends ends = std::minmax(control.start, control.end);
    std::erase_if(network_.controls, [&](const CrossControl& c) {
      return c.face == control.face && Ends(std::minmax(c.start, c.end)) == ends;
    });
    network_.controls.push_back(control);
  }

  // G2-Gregory faces keep their first and second derivatives in the middle of all sides. Of the two faces
  // at an edge that was cut, one is prescribed and the other follows.
  void AddControls() {
    std::set<Ends> prescribed;
    for (const DividedFace& done : divided_) {
      if (network_.faces[At(done.face)].scheme != PatchScheme::kG2Gregory) continue;
      for (const bool low : {true, false}) {
        for (int side = 0; side < 4; ++side) {
          const CrossControl control = ControlOf(done, side, low);
          const bool crossing = (side % 2 == 0) == done.along_u;
          if (crossing && !prescribed.insert(std::minmax(control.start, control.end)).second) continue;
          SetControl(control);
        }
      }
    }
  }

  // The faces beside the row keep the twists that they have.
  void HoldNeighbours() {
    for (const DividedFace& done : divided_) {
      for (int side = done.along_u ? 1 : 0; side < 4; side += 2) {
        const Ends ends = std::minmax(before_.faces[At(done.face)].vertices[At(side)],
                                      before_.faces[At(done.face)].vertices[At((side + 1) % 4)]);
        for (const JoinedEdge& edge : joined_.edges) {
          if (edge.kind != EdgeKind::kSmooth ||
              Ends(std::minmax(edge.topology.start, edge.topology.end)) != ends) {
            continue;
          }
          for (const FaceSide& s : edge.topology.faces) {
            if (s.face != done.face && At(s.face) < before_.faces.size()) Hold(s, ends);
          }
        }
      }
    }
  }

  void Hold(const FaceSide& side, const Ends& ends) {
    NetworkFace& face = network_.faces[At(side.face)];
    const bool inside =
        std::ranges::any_of(divided_, [&](const DividedFace& d) { return d.face == side.face; });
    if (!inside && face.scheme == PatchScheme::kG2Gregory) {
      const MiddleCross cross = AcrossMiddle(joined_.model.patches[At(side.face)].shape, side.side);
      SetControl({ends.first, ends.second, side.face, cross.first, cross.second});
      return;
    }
    if (inside || !TakesTwists(face) || !face.pushes.empty() || !face.cuts.empty()) return;
    const auto tangents = TangentsOf(side.face, side.side);
    if (!tangents) return;
    std::erase_if(face.twists,
                  [&](const SideTwists& w) { return Ends(std::minmax(w.start, w.end)) == ends; });
    const std::size_t n = face.vertices.size();
    face.twists.push_back(
        TwistsOf(*tangents, {face.vertices[At(side.side)], face.vertices[(At(side.side) + 1) % n]}));
  }

  std::string FreeId(const std::string& id) const {
    for (int k = 2;; ++k) {
      std::string made = fmt::format("{}/{}", id, k);
      if (std::ranges::none_of(network_.faces, [&](const NetworkFace& f) { return f.id == made; }))
        return made;
    }
  }

  const JoinedNetwork& joined_;
  const CurveNetwork before_;
  Row row_;
  double at_;
  CurveNetwork& network_;
  std::vector<DividedFace> divided_;
};

}  // namespace

absl::StatusOr<std::vector<int>> CrossedEdges(const FaceSplit& split, const JoinedNetwork& joined,
                                              const CurveNetwork& network, const std::string& at) {
  PM_ASSIGN_OR_RETURN(const Row row, Walker(joined, network, at).Walk(split));
  std::vector<int> edges;
  for (const CutEdge& cut : row.edges) edges.push_back(cut.edge);
  return edges;
}

absl::StatusOr<std::vector<DividedFace>> SplitFaces(const FaceSplit& split, const JoinedNetwork& joined,
                                                    const std::string& at, CurveNetwork& network) {
  PM_ASSIGN_OR_RETURN(const Row row, Walker(joined, network, at).Walk(split));
  return Splitter(joined, row, split.at, network).Run();
}

}  // namespace patchmill
