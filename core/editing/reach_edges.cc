#include "core/editing/reach_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/QR>
#include <fmt/format.h>

#include "core/base/index.h"
#include "core/base/status.h"
#include "core/editing/move_vertex.h"
#include "core/joining/line_edges.h"
#include "core/math/bernstein.h"

namespace patchmill {
namespace {

using Ends = std::pair<int, int>;  // in ascending order

absl::Status Error(const std::string& field, const std::string& text) {
  return absl::InvalidArgumentError(field + " " + text);
}

// A goal with its place on the curve of the joined edge, from the edge's own start.
struct Placed {
  int goal = 0;
  double t = 0.5;
  Vec3 through = Vec3::Zero();
};

double NearestParameter(const BezierChain& curve, const Vec3& p) {
  constexpr int kSteps = 200;
  const auto away = [&](double t) { return (Evaluate(curve, t).p - p).squaredNorm(); };
  double best = 0.0;
  for (int k = 1; k <= kSteps; ++k) {
    if (away(static_cast<double>(k) / kSteps) < away(best)) best = static_cast<double>(k) / kSteps;
  }
  double low = std::max(0.0, best - 1.0 / kSteps), high = std::min(1.0, best + 1.0 / kSteps);
  for (int k = 0; k < 100; ++k) {  // thirds: the distance has one minimum here
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    (away(a) <= away(b) ? high : low) = away(a) <= away(b) ? b : a;
  }
  return 0.5 * (low + high);
}

// The first line with the edge as one of its spans, and the span.
struct Span {
  int line = 0, span = 0;
  bool forward = true;  // the line runs from the smaller vertex to the larger one
};
std::optional<Span> SpanOn(const std::vector<NetworkLine>& lines, const Ends& ends) {
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const auto& v = lines[k].vertices;
    for (std::size_t i = 0; i + (lines[k].closed ? 0 : 1) < v.size(); ++i) {
      const int a = v[i], b = v[(i + 1) % v.size()];
      if (Ends(std::minmax(a, b)) == ends) return Span{static_cast<int>(k), static_cast<int>(i), a < b};
    }
  }
  return std::nullopt;
}

// Columns: directions in which an end tangent of the edge may change.
struct Free {
  std::vector<Vec3> start, end;
};

class Reacher {
 public:
  Reacher(const JoinedNetwork& joined, CurveNetwork& network, const EditPlace& place)
      : joined_(joined), network_(network), place_(place) {}

  absl::Status Add(const EdgeGoal& goal, int k) {
    const std::string field = fmt::format("{}.edges[{}]", place_.at, k);
    const Ends ends = std::minmax(goal.start, goal.end);
    const auto found = std::ranges::find_if(joined_.edges, [&](const JoinedEdge& e) {
      return Ends(std::minmax(e.topology.start, e.topology.end)) == ends;
    });
    if (found == joined_.edges.end()) {
      return Error(field, fmt::format("names the edge {} {}; there is no such edge", goal.start, goal.end));
    }
    if (found->topology.part) {
      const TableEdge& whole = joined_.edges[At(found->topology.part->whole)].topology;
      return Error(field,
                   fmt::format("names the edge {} {}, which is a part of the edge {} {}; name that one",
                               goal.start, goal.end, whole.start, whole.end));
    }
    if (found->curve.spans() > 1) {
      return Error(field, fmt::format("names the edge {} {}, whose curve has {} spans; give it another curve",
                                      goal.start, goal.end, found->curve.spans()));
    }
    if (!goal.through.allFinite()) return Error(field + ".through", "must be finite");
    const bool forward = goal.start == found->topology.start;
    double t = goal.parameter ? (forward ? *goal.parameter : 1.0 - *goal.parameter)
                              : NearestParameter(found->curve, goal.through);
    if (!(t >= kMinLedPlace && t <= 1.0 - kMinLedPlace)) {
      return Error(
          field + (goal.parameter ? ".parameter" : ".through"),
          fmt::format("gives the parameter {:g}; must be in [{:g}, {:g}]; move the vertex for a place "
                      "nearer to it",
                      forward ? t : 1.0 - t, kMinLedPlace, 1.0 - kMinLedPlace));
    }
    goals_[static_cast<int>(found - joined_.edges.begin())].push_back({k, t, goal.through});
    return absl::OkStatus();
  }

  absl::StatusOr<std::vector<ReachedGoal>> Solve() {
    std::map<int, std::vector<Placed>> on_lines;
    for (const auto& [edge, placed] : goals_) {
      const TableEdge& here = joined_.edges[At(edge)].topology;
      if (SpanOn(network_.lines, std::minmax(here.start, here.end))) {
        on_lines.emplace(edge, placed);
      } else {
        PM_RETURN_IF_ERROR(BendEdge(edge, placed));
      }
    }
    PM_RETURN_IF_ERROR(MoveLines(on_lines));
    std::ranges::sort(reached_, {}, &ReachedGoal::goal);
    return std::move(reached_);
  }

 private:
  // The unit normal of a face beside the edge at one of its ends.
  Vec3 NormalAt(const JoinedEdge& edge, bool start) const {
    const FaceSide& side = edge.topology.faces[0];
    const PatchShape& shape = joined_.model.patches[At(side.face)].shape;
    const int vertex = start ? edge.topology.start : edge.topology.end;
    const double corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const double triangle[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    const Vec3 p = network_.vertices[At(vertex)].position;
    const bool three = IsTriangle(shape);
    Vec2 best = Vec2::Zero();
    double least = kInfinity;
    for (int k = 0; k < (three ? 3 : 4); ++k) {
      const Vec2 at(three ? triangle[k][0] : corners[k][0], three ? triangle[k][1] : corners[k][1]);
      const double d = (Position(shape, at.x(), at.y()) - p).squaredNorm();
      if (d < least) least = d, best = at;
    }
    const SurfaceJet s = Evaluate(shape, best.x(), best.y());
    return s.du.cross(s.dv).normalized();
  }

  std::vector<Vec3> Directions(const JoinedEdge& edge, bool start) const {
    const CurveJet jet = Evaluate(edge.curve, start ? 0.0 : 1.0);
    if (!(jet.d.norm() > 0.0)) return {};
    const Vec3 along = jet.d.normalized();
    if (edge.topology.crease) return {along};
    const Vec3 normal = NormalAt(edge, start);
    Vec3 first = along - normal * normal.dot(along);
    if (!(first.norm() > 0.5)) return {along};
    first.normalize();
    return {first, normal.cross(first)};
  }

  bool TakesQuartic(const JoinedEdge& edge) const {
    return std::ranges::all_of(edge.topology.faces, [&](const FaceSide& s) {
      using enum PatchScheme;
      const int face = joined_.face_of[At(s.face)];
      const PatchScheme scheme = network_.faces[At(face)].scheme;
      return scheme == kAuto || scheme == kBrown || scheme == kHosaka || scheme == kLoftTriangle;
    });
  }

  void Report(const Placed& goal, const BezierCurve& curve) {
    ReachedGoal& to = reached_.emplace_back();
    to.kind = GoalKind::kEdge, to.goal = goal.goal, to.place = Vec2(goal.t, 0.0);
    to.target = goal.through, to.reached = Evaluate(curve, goal.t).p;
    to.distance = (to.reached - to.target).norm();
    to.missed = to.distance > kReachedShare * (curve.points.back() - curve.points.front()).norm();
  }

  void Write(const TableEdge& here, const EdgeShape& shape) {
    for (NetworkEdge& edge : network_.edges) {
      if (Ends(std::minmax(edge.start, edge.end)) != Ends(std::minmax(here.start, here.end))) continue;
      edge.start = here.start, edge.end = here.end, edge.shape = shape;
      return;
    }
    NetworkEdge& edge = network_.edges.emplace_back();
    edge.start = here.start, edge.end = here.end, edge.shape = shape, edge.crease = here.crease;
  }

  absl::Status BendEdge(int e, const std::vector<Placed>& goals) {
    const JoinedEdge& edge = joined_.edges[At(e)];
    const BezierCurve curve = SpanOf(edge.curve, 0);
    const double chord = (curve.points.back() - curve.points.front()).norm();
    const auto rows = static_cast<Eigen::Index>(3 * goals.size());
    Eigen::VectorXd rest(rows);
    for (std::size_t k = 0; k < goals.size(); ++k) {
      rest.segment<3>(static_cast<Eigen::Index>(3 * k)) = goals[k].through - Evaluate(curve, goals[k].t).p;
    }
    if (curve.degree() == 3) {
      const std::vector<Vec3> start = Directions(edge, true), end = Directions(edge, false);
      Eigen::MatrixXd columns(rows, static_cast<Eigen::Index>(start.size() + end.size()));
      for (std::size_t k = 0; k < goals.size(); ++k) {
        double b[4];
        AllBernstein(3, goals[k].t, b);
        for (std::size_t c = 0; c < start.size() + end.size(); ++c) {
          const bool first = c < start.size();
          columns.block<3, 1>(static_cast<Eigen::Index>(3 * k), static_cast<Eigen::Index>(c)) =
              first ? b[1] * start[c] : b[2] * end[c - start.size()];
        }
      }
      const Eigen::VectorXd x = columns.completeOrthogonalDecomposition().solve(rest);
      BezierCurve bent = curve;
      for (std::size_t c = 0; c < start.size() + end.size(); ++c) {
        const double by = x[static_cast<Eigen::Index>(c)];
        if (c < start.size()) {
          bent.points[1] += by * start[c];
        } else {
          bent.points[2] += by * end[c - start.size()];
        }
      }
      const bool near = x.lpNorm<Eigen::Infinity>() <= chord / 6.0;  // a tangent is 3 times this
      const bool reached = (columns * x - rest).norm() <= kReachedShare * chord;
      if ((near && reached) || !TakesQuartic(edge) || goals.size() > 1) {
        if (!near) {
          return Error(
              place_.at + fmt::format(".edges[{}].through", goals[0].goal),
              fmt::format("lies too far from the edge {} {}: its end tangents would change by more than "
                          "half of its length; move its vertices first",
                          edge.topology.start, edge.topology.end));
        }
        Write(edge.topology,
              TangentsEdge{3.0 * (bent.points[1] - bent.points[0]), 3.0 * (bent.points[2] - bent.points[3])});
        for (const Placed& goal : goals) Report(goal, bent);
        return absl::OkStatus();
      }
    }
    // d t^2 (1-t)^2: the best d for all goals, each coordinate by itself.
    double square = 0.0;
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < goals.size(); ++k) {
      const double t = goals[k].t, w = t * t * (1.0 - t) * (1.0 - t);
      square += w * w;
      sum += w * rest.segment<3>(static_cast<Eigen::Index>(3 * k));
    }
    const int degree = std::max(4, curve.degree());
    BezierCurve bent = Elevated(curve, degree);
    BezierCurve term;
    term.points.assign(5, Vec3::Zero());
    term.points[2] = sum / square / 6.0;
    term = Elevated(term, degree);
    for (std::size_t i = 0; i < bent.points.size(); ++i) bent.points[i] += term.points[i];
    Write(edge.topology, CurveEdge{bent});
    for (const Placed& goal : goals) Report(goal, bent);
    return absl::OkStatus();
  }

  // The curve of each goal's edge, which is a span of a line, in the direction of the joined edge.
  absl::StatusOr<std::vector<BezierCurve>> SpanCurves(const CurveNetwork& network,
                                                      const std::map<int, std::vector<Placed>>& goals) const {
    Diagnostics findings;
    const CurveNetwork edges = WithLinesAsEdges(network, findings);
    if (!findings.empty()) return absl::InvalidArgumentError(place_.at + ": " + findings[0].message);
    std::vector<BezierCurve> curves;
    for (const auto& [e, placed] : goals) {
      const TableEdge& here = joined_.edges[At(e)].topology;
      for (const NetworkEdge& edge : edges.edges) {
        if (Ends(std::minmax(edge.start, edge.end)) != Ends(std::minmax(here.start, here.end))) continue;
        PM_ASSIGN_OR_RETURN(BezierCurve curve, ToBezier(std::get<CurveEdge>(edge.shape).curve));
        curves.push_back(edge.start == here.start ? curve : Reversed(curve));
        break;
      }
    }
    return curves;
  }

  // Gauss-Newton over the positions of the vertices at the ends of the edges.
  absl::Status MoveLines(const std::map<int, std::vector<Placed>>& goals) {
    if (goals.empty()) return absl::OkStatus();
    constexpr int kIterations = 30;
    std::set<int> ends;
    Eigen::Index rows = 0;
    double size = 0.0;
    for (const auto& [e, placed] : goals) {
      const TableEdge& here = joined_.edges[At(e)].topology;
      ends.insert({here.start, here.end});
      rows += static_cast<Eigen::Index>(3 * placed.size());
      size = std::max(
          size,
          (network_.vertices[At(here.start)].position - network_.vertices[At(here.end)].position).norm());
    }
    const std::vector<int> vertices(ends.begin(), ends.end());
    const auto rest = [&](const CurveNetwork& network) -> absl::StatusOr<Eigen::VectorXd> {
      PM_ASSIGN_OR_RETURN(const std::vector<BezierCurve> curves, SpanCurves(network, goals));
      Eigen::VectorXd r(rows);
      Eigen::Index row = 0;
      std::size_t k = 0;
      for (const auto& [e, placed] : goals) {
        for (const Placed& goal : placed) {
          r.segment<3>(row) = goal.through - Evaluate(curves[k], goal.t).p;
          row += 3;
        }
        ++k;
      }
      return r;
    };
    CurveNetwork moved;  // what lines are made of
    moved.vertices = network_.vertices;
    moved.lines = network_.lines;
    const double step = 1e-5 * size;
    PM_ASSIGN_OR_RETURN(Eigen::VectorXd now, rest(moved));
    for (int i = 0; i < kIterations && now.norm() > 1e-13 * size; ++i) {
      Eigen::MatrixXd slopes(rows, static_cast<Eigen::Index>(3 * vertices.size()));
      for (std::size_t c = 0; c < 3 * vertices.size(); ++c) {
        PM_RETURN_IF_ERROR(place_.run.Check());
        CurveNetwork plus = moved, minus = moved;
        plus.vertices[At(vertices[c / 3])].position[static_cast<Eigen::Index>(c % 3)] += step;
        minus.vertices[At(vertices[c / 3])].position[static_cast<Eigen::Index>(c % 3)] -= step;
        PM_ASSIGN_OR_RETURN(const Eigen::VectorXd a, rest(plus));
        PM_ASSIGN_OR_RETURN(const Eigen::VectorXd b, rest(minus));
        slopes.col(static_cast<Eigen::Index>(c)) = (b - a) / (2.0 * step);
      }
      const Eigen::VectorXd x = slopes.completeOrthogonalDecomposition().solve(now);
      bool better = false;
      for (double part = 1.0; part > 1e-3 && !better; part *= 0.5) {
        CurveNetwork next = moved;
        for (std::size_t v = 0; v < vertices.size(); ++v) {
          const Vec3 by = part * x.segment<3>(static_cast<Eigen::Index>(3 * v));
          next.vertices[At(vertices[v])].position += by;
        }
        const auto after = rest(next);
        better = after.ok() && after->norm() < now.norm();
        if (better) now = *after, moved = std::move(next);
      }
      if (!better) break;
    }
    PM_ASSIGN_OR_RETURN(const std::vector<BezierCurve> curves, SpanCurves(moved, goals));
    for (const int v : vertices) MoveVertexTo(network_, v, moved.vertices[At(v)].position);
    std::size_t k = 0;
    for (const auto& [e, placed] : goals) {
      for (const Placed& goal : placed) Report(goal, curves[k]);
      ++k;
    }
    return absl::OkStatus();
  }

  const JoinedNetwork& joined_;
  CurveNetwork& network_;
  const EditPlace& place_;
  std::map<int, std::vector<Placed>> goals_;  // by edge of joined_
  std::vector<ReachedGoal> reached_;
};

}  // namespace

absl::StatusOr<std::vector<ReachedGoal>> ReachEdges(const std::vector<EdgeGoal>& goals,
                                                    const JoinedNetwork& joined, CurveNetwork& network,
                                                    const EditPlace& place) {
  Reacher reacher(joined, network, place);
  for (std::size_t k = 0; k < goals.size(); ++k) {
    PM_RETURN_IF_ERROR(reacher.Add(goals[k], static_cast<int>(k)));
  }
  return reacher.Solve();
}

}  // namespace patchmill
