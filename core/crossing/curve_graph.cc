#include "core/crossing/curve_graph.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/base/union_find.h"
#include "core/spatial/box_tree.h"

namespace patchmill {
namespace {

constexpr double kSmoothTurn = 20.0;  // degrees: parts that turn by less are one edge
constexpr double kNearMiss = 10.0;    // tolerances: a free end nearer to a curve than this is named

struct Stop {
  double t = 0.0;
  int item = 0;  // of the union-find
};

// A part of a curve between two stops.
struct Stretch {
  int curve = 0;
  double from = 0.0, to = 1.0;
  int start = 0, end = 0;
};

class GraphMaker {
 public:
  GraphMaker(const std::vector<DrawnCurve>& curves, const Crossings& crossings, double tolerance,
             Diagnostics& findings)
      : curves_(curves), crossings_(crossings), tolerance_(tolerance), findings_(findings) {}

  CurveGraph Make(FreeEnds free_ends) {
    TellTouches();
    MakeStretches();
    Prune(free_ends);
    MakeEdges();
    JoinParts();
    SplitLoops();
    DropUnused();
    return std::move(graph_);
  }

 private:
  std::string Name(int curve) const { return CurveName(curves_, curve); }
  Vec3 At3(const CurvePlace& place) const { return Evaluate(curves_[At(place.curve)].chain, place.t).p; }
  static Where Place(const Vec3& point, int curve) {
    return {.point = point, .field = fmt::format("curves[{}]", curve)};
  }

  void TellTouches() {
    for (const Touch& t : crossings_.touches) {
      findings_.push_back(MakeWarning(
          "CURVES_TOUCH",
          fmt::format(
              "{} and {} touch along {:.3g} mm without crossing; no vertex is made there. Let one end "
              "on the other, or move them apart",
              Name(t.a.curve), Name(t.b.curve), t.length),
          Place(At3(t.a), t.a.curve)));
    }
    for (const DoubledStretch& d : crossings_.doubled) {
      findings_.push_back(MakeWarning(
          "DOUBLED_CURVE",
          d.whole
              ? fmt::format("{} is drawn along {} within {:g} mm and is left out", Name(d.curve), Name(d.by),
                            tolerance_)
              : fmt::format("{} runs along {} within {:g} mm from {:.3f} to {:.3f} of its parameter; that "
                            "stretch is left out",
                            Name(d.curve), Name(d.by), tolerance_, d.from, d.to),
          Place(At3({d.curve, d.from}), d.curve)));
      if (d.whole) dropped_.insert(d.curve);
    }
  }

  void MakeStretches() {
    std::vector<std::vector<Stop>> stops(curves_.size());
    std::vector<CurvePlace> places;
    const auto add = [&](const CurvePlace& place) {
      stops[At(place.curve)].push_back({place.t, static_cast<int>(places.size())});
      places.push_back(place);
      return places.size() - 1;
    };
    for (int c = 0; c < static_cast<int>(curves_.size()); ++c) {
      if (dropped_.contains(c)) continue;
      add({c, 0.0}), add({c, 1.0});
    }
    std::vector<std::array<std::size_t, 2>> met;
    for (const Meeting& m : crossings_.meetings) {
      if (dropped_.contains(m.a.curve) || dropped_.contains(m.b.curve)) continue;
      const std::size_t a = add(m.a), b = add(m.b);
      met.push_back({a, b});
    }
    UnionFind sets(places.size());
    for (const auto& [a, b] : met) sets.Join(a, b);
    for (std::size_t c = 0; c < stops.size(); ++c) {
      auto& list = stops[c];
      std::ranges::sort(
          list, [](const Stop& x, const Stop& y) { return std::tie(x.t, x.item) < std::tie(y.t, y.item); });
      for (std::size_t k = 1; k < list.size(); ++k) {
        if (LengthBetween(curves_[c].chain, list[k - 1].t, list[k].t) <= 3 * tolerance_) {
          sets.Join(At(list[k - 1].item), At(list[k].item));
        }
      }
    }
    std::map<std::size_t, int> number;
    std::vector<int> count;
    std::vector<int> node(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto [entry, is_new] = number.emplace(sets.Find(i), static_cast<int>(graph_.nodes.size()));
      if (is_new) graph_.nodes.emplace_back(), count.push_back(0);
      node[i] = entry->second;
    }
    // Ends of curves that are drawn on beyond a meeting do not pull at its place.
    std::vector<bool> has_meeting(graph_.nodes.size(), false);
    for (const auto& [a, b] : met) has_meeting[At(node[a])] = true;
    std::vector<bool> counts(places.size(), false);
    for (const auto& [a, b] : met) counts[a] = counts[b] = true;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (has_meeting[At(node[i])] && !counts[i]) continue;
      graph_.nodes[At(node[i])].position += At3(places[i]);
      ++count[At(node[i])];
    }
    for (std::size_t n = 0; n < count.size(); ++n) graph_.nodes[n].position /= count[n];
    for (std::size_t i = 0; i < places.size(); ++i) {
      double& spread = graph_.nodes[At(node[i])].spread;
      spread = std::max(spread, (At3(places[i]) - graph_.nodes[At(node[i])].position).norm());
    }
    for (std::size_t c = 0; c < stops.size(); ++c) {
      const auto& list = stops[c];
      // A run of neighbouring stops may belong to one node. Its first stop ends the stretch before the node,
      // and its last stop begins the stretch behind it.
      for (std::size_t k = 0; k + 1 < list.size(); ++k) {
        const int start = node[At(list[k].item)], end = node[At(list[k + 1].item)];
        if (start == end && LengthBetween(curves_[c].chain, list[k].t, list[k + 1].t) <= 3 * tolerance_)
          continue;
        const double middle = 0.5 * (list[k].t + list[k + 1].t);
        if (list[k + 1].t - list[k].t <= 2 * kMinBreakGap) continue;
        if (InDoubled(static_cast<int>(c), middle)) continue;
        stretches_.push_back({static_cast<int>(c), list[k].t, list[k + 1].t, start, end});
      }
    }
  }

  bool InDoubled(int curve, double t) const {
    return std::ranges::any_of(crossings_.doubled, [&](const DoubledStretch& d) {
      return d.curve == curve && d.from <= t && t <= d.to;
    });
  }

  void Prune(FreeEnds free_ends) {
    std::vector<int> degree(graph_.nodes.size(), 0);
    for (const Stretch& s : stretches_) ++degree[At(s.start)], ++degree[At(s.end)];
    std::vector<bool> gone(stretches_.size(), false);
    std::map<int, int> kept_of, all_of;
    std::vector<std::pair<std::size_t, bool>> cut;  // stretch, free at its start
    for (bool again = true; again;) {
      again = false;
      for (std::size_t i = 0; i < stretches_.size(); ++i) {
        const Stretch& s = stretches_[i];
        if (gone[i] || (degree[At(s.start)] > 1 && degree[At(s.end)] > 1)) continue;
        gone[i] = again = true;
        cut.emplace_back(i, degree[At(s.start)] <= 1);
        --degree[At(s.start)], --degree[At(s.end)];
      }
    }
    for (std::size_t i = 0; i < stretches_.size(); ++i) {
      ++all_of[stretches_[i].curve];
      if (!gone[i]) ++kept_of[stretches_[i].curve];
    }
    std::set<int> unused;
    for (const auto& [i, at_start] : cut) {
      const Stretch& s = stretches_[i];
      const double t = at_start ? s.from : s.to;
      const Vec3 p = Evaluate(curves_[At(s.curve)].chain, t).p;
      if (kept_of[s.curve] == 0) {
        if (!unused.insert(s.curve).second) continue;
        findings_.push_back(MakeDiagnostic(
            free_ends == FreeEnds::kRefuse ? Severity::kError : Severity::kWarning, "CURVE_UNUSED",
            fmt::format("{} bounds no face: it meets others in fewer than two places that hold together{}",
                        Name(s.curve), Miss(s.curve)),
            Place(p, s.curve)));
        continue;
      }
      const double length = LengthBetween(curves_[At(s.curve)].chain, s.from, s.to);
      if (free_ends == FreeEnds::kRefuse) {
        findings_.push_back(MakeError(
            "CURVE_END_FREE",
            fmt::format("{} ends free, {:.3g} mm beyond its last meeting{}; join it to a curve, or have free "
                        "ends trimmed",
                        Name(s.curve), length, Miss(s.curve)),
            Place(p, s.curve)));
      } else {
        findings_.push_back(
            MakeInfo("CURVE_END_TRIMMED",
                     fmt::format("{} is cut off at its last meeting: {:.3g} mm at its {} bound "
                                 "no face{}",
                                 Name(s.curve), length, at_start ? "start" : "end", Miss(s.curve)),
                     Place(p, s.curve)));
      }
    }
    std::vector<Stretch> kept;
    for (std::size_t i = 0; i < stretches_.size(); ++i) {
      if (!gone[i]) kept.push_back(stretches_[i]);
    }
    stretches_ = std::move(kept);
  }

  // A tree over the spans of all curves that are not dropped.
  struct SpanTree {
    std::vector<std::pair<int, int>> spans;  // curve, span
    BoxTree tree{{}};
  };
  const SpanTree& Spans() const {
    if (span_tree_) return *span_tree_;
    span_tree_.emplace();
    std::vector<Box3> boxes;
    for (int c = 0; c < static_cast<int>(curves_.size()); ++c) {
      if (dropped_.contains(c)) continue;
      const BezierChain& chain = curves_[At(c)].chain;
      for (int k = 0; k < chain.spans(); ++k) {
        Box3& box = boxes.emplace_back();
        for (int i = 0; i <= chain.degree; ++i) box.Add(chain.points[At(k * chain.degree + i)]);
        span_tree_->spans.emplace_back(c, k);
      }
    }
    span_tree_->tree = BoxTree(std::move(boxes));
    return *span_tree_;
  }

  // Says by how much the ends of a curve miss another one, if they miss it narrowly.
  std::string Miss(int curve) const {
    constexpr int kSamples = 16;  // of a span
    const SpanTree& spans = Spans();
    std::string text;
    for (const double t : {0.0, 1.0}) {
      const Vec3 p = Evaluate(curves_[At(curve)].chain, t).p;
      double best = kInfinity;
      int other = -1;
      spans.tree.Near(p, kNearMiss * tolerance_, [&](int item) {
        const auto [c, span] = spans.spans[At(item)];
        if (c == curve) return true;
        const BezierChain& chain = curves_[At(c)].chain;
        const double from = chain.breaks[At(span)], to = chain.breaks[At(span + 1)];
        double start = from, nearest = kInfinity;
        for (int i = 0; i <= kSamples; ++i) {
          const double at = std::lerp(from, to, i / double(kSamples));
          const double d = (Evaluate(chain, at).p - p).norm();
          if (d < nearest) nearest = d, start = at;
        }
        const double d = (Evaluate(chain, FootFrom(chain, start, p)).p - p).norm();
        if (d < best || (d == best && c < other)) best = d, other = c;
        return true;
      });
      if (best <= tolerance_ || best > kNearMiss * tolerance_) continue;
      text += fmt::format("; its {} misses {} by {:.3g} mm, and the tolerance is {:g}",
                          t == 0.0 ? "start" : "end", Name(other), best, tolerance_);
    }
    return text;
  }

  void MakeEdges() {
    for (const Stretch& s : stretches_) {
      graph_.edges.push_back({s.start, s.end, {Part(curves_[At(s.curve)].chain, s.from, s.to)}, {s.curve}});
    }
    FindEnds(graph_);
  }

  static void Turn(GraphEdge& edge) {
    std::swap(edge.start, edge.end);
    std::ranges::reverse(edge.parts);
    std::ranges::reverse(edge.curves);
    for (BezierChain& part : edge.parts) part = Reversed(std::move(part));
  }

  bool Linked(int a, int b) const {
    return std::ranges::any_of(
        graph_.edges, [&](const GraphEdge& e) { return std::minmax(e.start, e.end) == std::minmax(a, b); });
  }

  // Joins two edges that meet alone at a node and continue each other smoothly.
  void JoinParts() {
    for (int n = 0; n < static_cast<int>(graph_.nodes.size()); ++n) {
      if (graph_.ends[At(n)].size() != 2) continue;
      const auto [first, second] = std::pair(graph_.ends[At(n)][0], graph_.ends[At(n)][1]);
      if (first[0] == second[0]) continue;
      GraphEdge a = graph_.edges[At(first[0])], b = graph_.edges[At(second[0])];
      if (first[1] == 0) Turn(a);
      if (second[1] == 1) Turn(b);
      const double turn = Degrees(std::acos(std::clamp(-a.Tangent(false).dot(b.Tangent(true)), -1.0, 1.0)));
      if (turn > kSmoothTurn || a.start == b.end || Linked(a.start, b.end)) continue;
      a.end = b.end;
      a.parts.insert(a.parts.end(), b.parts.begin(), b.parts.end());
      a.curves.insert(a.curves.end(), b.curves.begin(), b.curves.end());
      graph_.edges[At(first[0])] = std::move(a);
      graph_.edges[At(second[0])].start = graph_.edges[At(second[0])].end = -1;  // removed below
      std::erase_if(graph_.edges, [](const GraphEdge& e) { return e.start < 0; });
      FindEnds(graph_);
    }
  }

  int Split(std::size_t e, double share) {
    GraphEdge edge = std::move(graph_.edges[e]);
    double before = 0.0;
    const double total = edge.Length(), want = share * total;
    std::size_t part = 0;
    double length = LengthBetween(edge.parts[0], 0, 1);
    while (part + 1 < edge.parts.size() && before + length < want) {
      before += length;
      length = LengthBetween(edge.parts[++part], 0, 1);
    }
    double low = 0.0, high = 1.0;
    for (int k = 0; k < 50; ++k) {
      const double middle = 0.5 * (low + high);
      (before + LengthBetween(edge.parts[part], 0, middle) < want ? low : high) = middle;
    }
    const double t = std::clamp(low, 0.01, 0.99);
    const int node = static_cast<int>(graph_.nodes.size());
    graph_.nodes.push_back({Evaluate(edge.parts[part], t).p, 0.0});
    GraphEdge first{edge.start, node, {}, {}}, second{node, edge.end, {}, {}};
    for (std::size_t k = 0; k < edge.parts.size(); ++k) {
      if (k < part) first.parts.push_back(edge.parts[k]), first.curves.push_back(edge.curves[k]);
      if (k > part) second.parts.push_back(edge.parts[k]), second.curves.push_back(edge.curves[k]);
      if (k != part) continue;
      first.parts.push_back(Part(edge.parts[k], 0.0, t)), first.curves.push_back(edge.curves[k]);
      second.parts.push_back(Part(edge.parts[k], t, 1.0)), second.curves.push_back(edge.curves[k]);
    }
    graph_.edges[e] = std::move(first);
    graph_.edges.push_back(std::move(second));
    return node;
  }

  // No edge may lead back to its node, and no two edges may join the same nodes.
  void SplitLoops() {
    for (std::size_t e = 0; e < graph_.edges.size(); ++e) {
      if (graph_.edges[e].start == graph_.edges[e].end) Split(e, 1.0 / 3.0), --e;
    }
    std::set<std::pair<int, int>> linked;
    for (std::size_t e = 0; e < graph_.edges.size(); ++e) {
      const auto ends = std::minmax(graph_.edges[e].start, graph_.edges[e].end);
      if (!linked.insert(ends).second)
        Split(e, 0.5), linked.insert(std::minmax(graph_.edges[e].start, graph_.edges[e].end));
    }
    FindEnds(graph_);
  }

  void DropUnused() {
    std::vector<int> renamed(graph_.nodes.size(), -1);
    std::vector<GraphNode> nodes;
    for (std::size_t n = 0; n < graph_.nodes.size(); ++n) {
      if (graph_.ends[n].empty()) continue;
      renamed[n] = static_cast<int>(nodes.size());
      nodes.push_back(graph_.nodes[n]);
    }
    for (GraphEdge& e : graph_.edges) e.start = renamed[At(e.start)], e.end = renamed[At(e.end)];
    graph_.nodes = std::move(nodes);
    FindEnds(graph_);
  }

  const std::vector<DrawnCurve>& curves_;
  const Crossings& crossings_;
  double tolerance_;
  Diagnostics& findings_;
  std::set<int> dropped_;
  mutable std::optional<SpanTree> span_tree_;  // made when an end is looked at first
  std::vector<Stretch> stretches_;
  CurveGraph graph_;
};

}  // namespace

Vec3 GraphEdge::Tangent(bool at_start) const {
  const BezierChain& part = at_start ? parts.front() : parts.back();
  const BezierCurve span = SpanOf(part, at_start ? 0 : part.spans() - 1);
  const Vec3 from = at_start ? span.points.front() : span.points.back();
  const int n = span.degree();
  for (int k = 1; k <= n; ++k) {
    const Vec3 d = (at_start ? span.points[At(k)] : span.points[At(n - k)]) - from;
    if (d.norm() > 1e-12 * (1.0 + from.norm())) return d.normalized();
  }
  return Vec3::Zero();
}

double GraphEdge::Length() const {
  double length = 0.0;
  for (const BezierChain& part : parts) length += LengthBetween(part, 0, 1);
  return length;
}

std::vector<Vec3> GraphEdge::Points(int steps) const {
  std::vector<Vec3> points;
  for (const BezierChain& part : parts) {
    const int count = steps * part.spans();
    for (int k = points.empty() ? 0 : 1; k <= count; ++k)
      points.push_back(Evaluate(part, k / double(count)).p);
  }
  return points;
}

Vec3 GraphEdge::PointAt(double share) const {
  const std::vector<Vec3> points = Points(16);
  double total = 0.0;
  for (std::size_t k = 1; k < points.size(); ++k) total += (points[k] - points[k - 1]).norm();
  double rest = share * total;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const double step = (points[k] - points[k - 1]).norm();
    if (rest <= step && step > 0) return points[k - 1] + rest / step * (points[k] - points[k - 1]);
    rest -= step;
  }
  return points.back();
}

void FindEnds(CurveGraph& graph) {
  graph.ends.assign(graph.nodes.size(), {});
  for (int e = 0; e < static_cast<int>(graph.edges.size()); ++e) {
    graph.ends[At(graph.edges[At(e)].start)].push_back({e, 0});
    graph.ends[At(graph.edges[At(e)].end)].push_back({e, 1});
  }
}

std::string CurveName(const std::vector<DrawnCurve>& curves, int curve) {
  const std::string& id = curves[At(curve)].id;
  return id.empty() ? fmt::format("curves[{}]", curve) : fmt::format("curves[{}] ({})", curve, id);
}

CurveGraph MakeCurveGraph(const std::vector<DrawnCurve>& curves, const Crossings& crossings, double tolerance,
                          FreeEnds free_ends, Diagnostics& findings) {
  return GraphMaker(curves, crossings, tolerance, findings).Make(free_ends);
}

}  // namespace patchmill
