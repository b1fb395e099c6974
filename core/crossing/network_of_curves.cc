#include "core/crossing/network_of_curves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include <Eigen/Eigenvalues>
#include <absl/strings/match.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/index.h"
#include "core/base/status.h"
#include "core/crossing/choose_cuts.h"
#include "core/crossing/edge_fit.h"
#include "core/crossing/embed_faces.h"
#include "core/joining/network_findings.h"

namespace patchmill {
namespace {

constexpr double kMostTurn = 30.0;  // degrees by which an edge's end may be turned into its tangent plane
constexpr int kMostRounds = 40;

using NodePair = std::pair<int, int>;
NodePair Ordered(int a, int b) { return std::minmax(a, b); }

// A face of the network: a face of the graph, or a piece of one.
struct NetPiece {
  std::string id;
  std::vector<int> nodes;
  std::vector<int> curves;  // around the whole face
  bool gone = false;

  int Count() const { return static_cast<int>(nodes.size()); }
  int Next(int corner) const { return nodes[At((corner + 1) % Count())]; }
  int Previous(int corner) const { return nodes[At((corner + Count() - 1) % Count())]; }
};

struct PieceCorner {
  int piece = 0, corner = 0;
};

// Faces that meet smoothly around a node.
struct CornerGroup {
  std::vector<PieceCorner> corners;
  std::set<int> ends;  // far nodes of all edges of the group
  Vec3 normal = Vec3::Zero();
};

class NetworkMaker {
 public:
  NetworkMaker(const std::vector<DrawnCurve>& curves, const CrossingOptions& options, const RunContext& run)
      : curves_(curves), options_(options), run_(run) {}

  absl::StatusOr<NetworkOfCurves> Make() {
    PM_ASSIGN_OR_RETURN(const Crossings crossings, FindCrossings(curves_, options_.tolerance, run_));
    graph_ = MakeCurveGraph(curves_, crossings, options_.tolerance, options_.free_ends, result_.findings);
    PM_RETURN_IF_ERROR(run_.Check());
    embedding_ = EmbedFaces(graph_, options_.direction);
    if (embedding_.groups > 1) {
      result_.findings.push_back(MakeWarning(
          "CURVES_APART", fmt::format("the curves form {} groups that do not meet; each becomes a "
                                      "surface of its own",
                                      embedding_.groups)));
    }
    for (int e = 0; e < static_cast<int>(graph_.edges.size()); ++e) {
      edge_of_[Ordered(graph_.edges[At(e)].start, graph_.edges[At(e)].end)] = e;
    }
    MakePieces();
    for (int round = 0; round < kMostRounds; ++round) {
      PM_RETURN_IF_ERROR(run_.Check());
      KeepOneFan();
      FindCreases();
      FitGroups();
      FillNetwork();
      if (result_.network.faces.empty()) break;
      PM_ASSIGN_OR_RETURN(result_.joined, JoinNetwork(result_.network, run_));
      if (!HasError(result_.joined.findings)) break;
      if (round + 1 == kMostRounds || !Repair(result_.joined.findings)) {
        result_.findings.insert(result_.findings.end(), result_.joined.findings.begin(),
                                result_.joined.findings.end());
        return std::move(result_);
      }
    }
    if (result_.network.faces.empty()) {
      result_.findings.push_back(MakeError(
          "NO_FACE",
          fmt::format(
              "the curves close no face. A larger tolerance lets curves meet that lie apart, a smaller one "
              "keeps vertices apart that are nearer than three times of it; now it is {:g} mm",
              options_.tolerance)));
      return std::move(result_);
    }
    TellMoved();
    return std::move(result_);
  }

 private:
  const GraphEdge* EdgeOf(int a, int b) const {
    const auto found = edge_of_.find(Ordered(a, b));
    return found == edge_of_.end() ? nullptr : &graph_.edges[At(found->second)];
  }

  // The direction of the line from node a to b, unit: that of an edge, or the chord of a cut.
  Vec3 Direction(int a, int b) const {
    if (const GraphEdge* edge = EdgeOf(a, b)) return edge->Tangent(edge->start == a);
    return (graph_.nodes[At(b)].position - graph_.nodes[At(a)].position).normalized();
  }

  std::string Around(const std::vector<int>& curves) const {
    std::vector<std::string> names;
    for (const int c : curves) names.push_back(CurveName(curves_, c));
    return fmt::format("{}", fmt::join(names, ", "));
  }

  void LeaveOut(NetPiece& piece, std::string_view why) {
    piece.gone = true;
    if (!reported_.insert(piece.id.substr(0, piece.id.find('/')) + std::string(why)).second) return;
    Vec3 middle = Vec3::Zero();
    for (const int n : piece.nodes) middle += graph_.nodes[At(n)].position / piece.Count();
    result_.findings.push_back(MakeWarning(
        "FACE_LEFT_OUT",
        fmt::format("the face {} between {} is left open: {}", piece.id, Around(piece.curves), why),
        {.point = middle, .field = fmt::format("curves[{}]", piece.curves.front())}));
  }

  void MakePieces() {
    std::set<NodePair> linked;
    for (const auto& [ends, edge] : edge_of_) linked.insert(ends);
    int number = 0;
    for (const GraphFace& face : embedding_.faces) {
      NetPiece whole;
      whole.id = fmt::format("f{}", ++number);
      std::set<int> names;
      for (const GraphSide& side : face.sides) {
        whole.nodes.push_back(StartOf(graph_, side));
        names.insert(graph_.edges[At(side.edge)].curves.begin(), graph_.edges[At(side.edge)].curves.end());
      }
      whole.curves.assign(names.begin(), names.end());
      const std::set<int> distinct(whole.nodes.begin(), whole.nodes.end());
      if (distinct.size() != whole.nodes.size()) {
        LeaveOut(whole, "its border meets itself");
        continue;
      }
      if (whole.Count() < 3 || whole.Count() > kMaxCornersToCut) {
        LeaveOut(whole,
                 fmt::format("it has {} corners, and must have 3 to {}", whole.Count(), kMaxCornersToCut));
        continue;
      }
      std::vector<CutCorner> corners;
      for (int k = 0; k < whole.Count(); ++k) {
        corners.push_back(
            {graph_.nodes[At(whole.nodes[At(k)])].position, embedding_.normals[At(whole.nodes[At(k)])],
             Direction(whole.nodes[At(k)], whole.Next(k)), Direction(whole.nodes[At(k)], whole.Previous(k))});
      }
      const auto pieces = ChooseCuts(corners, [&](int i, int j) {
        return !linked.contains(Ordered(whole.nodes[At(i)], whole.nodes[At(j)]));
      });
      if (pieces.empty()) {
        LeaveOut(whole,
                 "no cuts from corner to corner make it pieces of three and four sides whose corners stay "
                 "below 180 degrees");
        continue;
      }
      for (std::size_t p = 0; p < pieces.size(); ++p) {
        NetPiece piece{p == 0 ? whole.id : fmt::format("{}/{}", whole.id, p + 1), {}, whole.curves};
        for (const int c : pieces[p]) piece.nodes.push_back(whole.nodes[At(c)]);
        for (int k = 0; k < piece.Count(); ++k) linked.insert(Ordered(piece.nodes[At(k)], piece.Next(k)));
        pieces_.push_back(std::move(piece));
      }
    }
  }

  std::map<NodePair, std::vector<PieceCorner>> Sides() const {
    std::map<NodePair, std::vector<PieceCorner>> sides;
    for (int p = 0; p < static_cast<int>(pieces_.size()); ++p) {
      for (int k = 0; k < pieces_[At(p)].Count() && !pieces_[At(p)].gone; ++k) {
        sides[Ordered(pieces_[At(p)].nodes[At(k)], pieces_[At(p)].Next(k))].push_back({p, k});
      }
    }
    return sides;
  }

  std::vector<std::vector<PieceCorner>> CornersOfNodes() const {
    std::vector<std::vector<PieceCorner>> corners(graph_.nodes.size());
    for (int p = 0; p < static_cast<int>(pieces_.size()); ++p) {
      for (int k = 0; k < pieces_[At(p)].Count() && !pieces_[At(p)].gone; ++k) {
        corners[At(pieces_[At(p)].nodes[At(k)])].push_back({p, k});
      }
    }
    return corners;
  }

  // The corners at a node in sets that are connected across edges which `joins` accepts.
  template <class Joins>
  std::vector<std::vector<PieceCorner>> Fans(int node, const std::vector<PieceCorner>& corners,
                                             const Joins& joins) const {
    std::vector<std::vector<PieceCorner>> fans;
    std::vector<bool> taken(corners.size(), false);
    for (std::size_t first = 0; first < corners.size(); ++first) {
      if (taken[first]) continue;
      std::vector<std::size_t> open = {first};
      taken[first] = true;
      auto& fan = fans.emplace_back();
      while (!open.empty()) {
        const PieceCorner at = corners[open.back()];
        open.pop_back();
        fan.push_back(at);
        for (const int far :
             {pieces_[At(at.piece)].Next(at.corner), pieces_[At(at.piece)].Previous(at.corner)}) {
          if (!joins(Ordered(node, far))) continue;
          for (std::size_t other = 0; other < corners.size(); ++other) {
            const NetPiece& piece = pieces_[At(corners[other].piece)];
            if (taken[other] ||
                (piece.Next(corners[other].corner) != far && piece.Previous(corners[other].corner) != far))
              continue;
            taken[other] = true;
            open.push_back(other);
          }
        }
      }
    }
    return fans;
  }

  // A vertex belongs to one fan of faces. Of several the largest stays.
  void KeepOneFan() {
    for (bool again = true; again;) {
      again = false;
      const auto corners = CornersOfNodes();
      for (int n = 0; n < static_cast<int>(corners.size()) && !again; ++n) {
        auto fans = Fans(n, corners[At(n)], [](const NodePair&) { return true; });
        if (fans.size() < 2) continue;
        std::ranges::stable_sort(fans, [](const auto& a, const auto& b) { return a.size() > b.size(); });
        for (std::size_t k = 1; k < fans.size(); ++k) {
          for (const PieceCorner& c : fans[k]) {
            LeaveOut(pieces_[At(c.piece)], "it meets the others in one point only");
          }
        }
        again = true;
      }
    }
  }

  Vec3 CornerNormal(const PieceCorner& at) const {
    const NetPiece& piece = pieces_[At(at.piece)];
    const int node = piece.nodes[At(at.corner)];
    const Vec3 n = Direction(node, piece.Next(at.corner)).cross(Direction(node, piece.Previous(at.corner)));
    return n.norm() > 0.05 ? Vec3(n.normalized()) : embedding_.normals[At(node)];
  }

  // A face meets its neighbour in a crease if their planes differ too much at an end of the edge.
  void FindCreases() {
    for (const auto& [ends, sides] : Sides()) {
      if (sides.size() != 2 || !EdgeOf(ends.first, ends.second)) continue;
      for (const int node : {ends.first, ends.second}) {
        Vec3 normals[2];
        for (const int k : {0, 1}) {
          const NetPiece& piece = pieces_[At(sides[At(k)].piece)];
          const auto corner = std::ranges::find(piece.nodes, node) - piece.nodes.begin();
          normals[k] = CornerNormal({sides[At(k)].piece, static_cast<int>(corner)});
        }
        const double angle = std::atan2(normals[0].cross(normals[1]).norm(), normals[0].dot(normals[1]));
        if (angle > options_.crease_angle) creases_.insert(ends);
      }
    }
  }

  void FitGroups() {
    for (bool again = true; again;) {
      again = false;
      groups_.assign(graph_.nodes.size(), {});
      turned_.clear();
      const auto corners = CornersOfNodes();
      for (int n = 0; n < static_cast<int>(corners.size()); ++n) {
        for (auto& fan : Fans(n, corners[At(n)], [&](const NodePair& e) { return !creases_.contains(e); })) {
          CornerGroup group{std::move(fan), {}};
          for (const PieceCorner& c : group.corners) {
            group.ends.insert(pieces_[At(c.piece)].Next(c.corner));
            group.ends.insert(pieces_[At(c.piece)].Previous(c.corner));
          }
          if (group.corners.size() > 1) group.normal = GroupNormal(n, group);
          groups_[At(n)].push_back(std::move(group));
        }
        again = LayEnds(n) || again;
      }
    }
  }

  Vec3 GroupNormal(int node, const CornerGroup& group) const {
    Vec3 mean = Vec3::Zero();
    for (const PieceCorner& c : group.corners) mean += CornerNormal(c);
    if (mean.norm() < 1e-3) mean = embedding_.normals[At(node)];
    Mat3 sum = Mat3::Zero();
    int count = 0;
    for (const int far : group.ends) {
      if (!EdgeOf(node, far)) continue;
      const Vec3 t = Direction(node, far);
      sum += t * t.transpose();
      ++count;
    }
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(sum);
    Vec3 normal = solver.eigenvectors().col(0);
    if (solver.eigenvalues()[1] < 0.02 * count) {  // all in one line: any plane through it
      const Vec3 line = solver.eigenvectors().col(2);
      normal = (mean - line * line.dot(mean)).normalized();
    }
    return normal.dot(mean) < 0 ? Vec3(-normal) : normal;
  }

  // Turns the ends of edges at a node into the planes of the groups there. True if that would turn one too
  // far: all edges there are creases then.
  bool LayEnds(int node) {
    std::map<int, std::vector<Vec3>> planes;
    for (const CornerGroup& group : groups_[At(node)]) {
      if (group.normal.isZero()) continue;
      for (const int far : group.ends) planes[far].push_back(group.normal);
    }
    for (const auto& [far, normals] : planes) {
      if (!EdgeOf(node, far)) continue;
      const Vec3 t = Direction(node, far);
      Vec3 laid = t - normals[0] * normals[0].dot(t);
      if (normals.size() > 1) {
        const Vec3 line = normals[0].cross(normals[1]);
        laid = line.norm() > 0.1 ? Vec3(line * line.dot(t)) : Vec3::Zero();
      }
      if (laid.norm() < 1e-9 ||
          std::acos(std::clamp(laid.normalized().dot(t), -1.0, 1.0)) > Radians(kMostTurn)) {
        bool changed = false;
        for (const CornerGroup& group : groups_[At(node)]) {
          for (const int end : group.ends) {
            if (EdgeOf(node, end) && creases_.insert(Ordered(node, end)).second) changed = true;
          }
        }
        if (changed) return true;
        laid = t;
      }
      turned_[{node, far}] = laid.normalized();
    }
    return false;
  }

  void FillNetwork() {
    result_.network = CurveNetwork();
    result_.max_moved = 0.0;
    moved_.clear();
    vertex_of_.assign(graph_.nodes.size(), -1);
    std::vector<int> face_of(pieces_.size(), -1);
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      if (pieces_[p].gone) continue;
      face_of[p] = static_cast<int>(result_.network.faces.size());
      NetworkFace& face = result_.network.faces.emplace_back();
      face.id = pieces_[p].id;
      for (const int n : pieces_[p].nodes) {
        if (vertex_of_[At(n)] < 0) {
          vertex_of_[At(n)] = static_cast<int>(result_.network.vertices.size());
          result_.network.vertices.emplace_back().position = graph_.nodes[At(n)].position;
        }
        face.vertices.push_back(vertex_of_[At(n)]);
      }
    }
    for (std::size_t n = 0; n < graph_.nodes.size(); ++n) {
      if (vertex_of_[n] < 0) continue;
      for (const CornerGroup& group : groups_[n]) {
        if (group.normal.isZero()) continue;
        NetworkVertex::Normal normal{group.normal, {}};
        if (groups_[n].size() > 1) {
          for (const PieceCorner& c : group.corners) normal.faces.push_back(face_of[At(c.piece)]);
          std::ranges::sort(normal.faces);
        }
        result_.network.vertices[At(vertex_of_[n])].normals.push_back(std::move(normal));
      }
    }
    for (const auto& [ends, sides] : Sides()) {
      const GraphEdge* edge = EdgeOf(ends.first, ends.second);
      const bool crease = creases_.contains(ends);
      if (!edge && !crease) continue;  // a cut: from the normals
      NetworkEdge& to = result_.network.edges.emplace_back();
      to.start = vertex_of_[At(ends.first)], to.end = vertex_of_[At(ends.second)];
      to.crease = crease && sides.size() == 2;
      moved_.push_back({-1, 0.0});
      if (!edge) continue;
      to.start = vertex_of_[At(edge->start)], to.end = vertex_of_[At(edge->end)];
      const int curve = edge->curves.front();
      to.id = curves_[At(curve)].id.empty() ? fmt::format("curve {}", curve) : curves_[At(curve)].id;
      EdgeWish wish{graph_.nodes[At(edge->start)].position,
                    graph_.nodes[At(edge->end)].position,
                    EndDirection(edge->start, edge->end),
                    EndDirection(edge->end, edge->start),
                    false,
                    options_.tolerance};
      for (const PieceCorner& s : sides)
        wish.beside_triangle = wish.beside_triangle || pieces_[At(s.piece)].Count() == 3;
      FittedEdge fitted = FitGraphEdge(*edge, wish);
      to.shape = CurveEdge{std::move(fitted.curve)};
      moved_.back() = {curve, fitted.moved};
      result_.max_moved = std::max(result_.max_moved, fitted.moved);
    }
  }

  Vec3 EndDirection(int node, int far) const {
    const auto found = turned_.find({node, far});
    return found == turned_.end() ? Direction(node, far) : found->second;
  }

  // Makes creases of edges that cannot be smooth, and leaves out faces that cannot be made. False if
  // nothing helps.
  bool Repair(const Diagnostics& findings) {
    bool changed = false;
    std::vector<int> piece_of, node_of(result_.network.vertices.size(), -1);
    for (int p = 0; p < static_cast<int>(pieces_.size()); ++p) {
      if (!pieces_[At(p)].gone) piece_of.push_back(p);
    }
    for (std::size_t n = 0; n < vertex_of_.size(); ++n) {
      if (vertex_of_[n] >= 0) node_of[At(vertex_of_[n])] = static_cast<int>(n);
    }
    const auto number = [](const std::string& field, std::string_view list) -> std::optional<int> {
      const std::string start = fmt::format("network.{}[", list);
      return absl::StartsWith(field, start) ? std::optional(std::atoi(field.c_str() + start.size()))
                                            : std::nullopt;
    };
    const auto drop_beside = [&](const NodePair& ends, const std::string& why) {
      for (const int p : piece_of) {
        NetPiece& piece = pieces_[At(p)];
        for (int k = 0; k < piece.Count() && !piece.gone; ++k) {
          if (Ordered(piece.nodes[At(k)], piece.Next(k)) == ends) LeaveOut(piece, why), changed = true;
        }
      }
    };
    for (const Diagnostic& d : findings) {
      if (d.severity != Severity::kError) continue;
      const std::string why = fmt::format("it cannot be joined ({})", d.code);
      if (const auto e = number(d.where.field, "edges")) {
        const NetworkEdge& edge = result_.network.edges[At(*e)];
        const NodePair ends = Ordered(node_of[At(edge.start)], node_of[At(edge.end)]);
        if (!edge.crease && d.code != "PARALLEL_TANGENTS" && creases_.insert(ends).second) {
          changed = true;
        } else {
          drop_beside(ends, why);
        }
      } else if (const auto f = number(d.where.field, "faces")) {
        if (!pieces_[At(piece_of[At(*f)])].gone) LeaveOut(pieces_[At(piece_of[At(*f)])], why), changed = true;
      } else if (const auto v = number(d.where.field, "vertices")) {
        const int node = node_of[At(*v)];
        bool creased = false;
        for (const auto& [ends, sides] : Sides()) {
          if ((ends.first == node || ends.second == node) && sides.size() == 2) {
            creased = creases_.insert(ends).second || creased;
          }
        }
        changed = changed || creased;
        for (const int p : piece_of) {
          NetPiece& piece = pieces_[At(p)];
          if (creased || piece.gone || std::ranges::count(piece.nodes, node) == 0) continue;
          LeaveOut(piece, why), changed = true;
        }
      }
    }
    return changed;
  }

  void TellMoved() {
    for (std::size_t e = 0; e < moved_.size(); ++e) {
      const auto& [curve, moved] = moved_[e];
      if (curve < 0 || !(moved > options_.tolerance)) continue;
      const NetworkEdge& edge = result_.network.edges[e];
      result_.findings.push_back(MakeWarning(
          "EDGE_MOVED",
          fmt::format(
              "the edge from vertex {} to {} leaves {} by {:.3g} mm, more than the tolerance {:g}, because "
              "edges that meet must lie in one plane there",
              edge.start, edge.end, CurveName(curves_, curve), moved, options_.tolerance),
          {.point = result_.network.vertices[At(edge.start)].position,
           .field = fmt::format("curves[{}]", curve)}));
    }
  }

  struct Moved {
    int curve = -1;
    double by = 0.0;
  };

  const std::vector<DrawnCurve>& curves_;
  const CrossingOptions& options_;
  const RunContext& run_;
  NetworkOfCurves result_;
  CurveGraph graph_;
  Embedding embedding_;
  std::map<NodePair, int> edge_of_;
  std::vector<NetPiece> pieces_;
  std::set<NodePair> creases_;
  std::vector<std::vector<CornerGroup>> groups_;  // of each node
  std::map<NodePair, Vec3> turned_;               // (node, far node): the end direction there
  std::vector<int> vertex_of_;
  std::vector<Moved> moved_;  // of each edge of the network
  std::set<std::string> reported_;
};

}  // namespace

absl::StatusOr<NetworkOfCurves> MakeNetworkOfCurves(const std::vector<DrawnCurve>& curves,
                                                    const CrossingOptions& options, const RunContext& run) {
  return NetworkMaker(curves, options, run).Make();
}

}  // namespace patchmill
