#include "core/lines/zero_curves.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/progress_throttle.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr double kPole = 1e-9;  // mm; a side this short is a degenerate edge

SurfacePoint At(PieceId id, const Piece& piece, const Vec2& q) {
  return {id, q.x(), q.y(), Position(piece, q.x(), q.y())};
}

// The arcs of one piece, joined end to end where exactly two arcs meet.
class PieceCurves {
 public:
  // `params` has its run.
  PieceCurves(PieceId id, const Piece& piece, const ZeroField& field, const ZeroMeshParams& params,
              double tolerance)
      : id_(id), piece_(piece), field_(field), tolerance_(tolerance), run_(*params.run) {
    ZeroMeshParams drawn = params;
    drawn.curves_only = true;
    mesh_ = BuildZeroMesh(piece, {&field, 1}, drawn);
  }

  std::vector<ZeroCurve> Trace() {
    FindArcs();
    std::vector<ZeroCurve> curves;
    // Open curves come first, then closed ones.
    for (const bool open : {true, false}) {
      for (const auto& [from, arcs] : next_) {
        if (open && Runs(from)) continue;
        for (std::size_t i = 0; i < arcs.size(); ++i) Follow(from, i, curves);
      }
    }
    return curves;
  }

 private:
  struct Arc {
    int to = 0;
    bool used = false;
  };

  bool On(int id) const { return mesh_.vertices[static_cast<std::size_t>(id)].sign[0] == 0; }
  const Vec3& Place(int id) const { return mesh_.vertices[static_cast<std::size_t>(id)].p; }
  Vec2 Parameters(int id) const {
    const ZeroVertex& v = mesh_.vertices[static_cast<std::size_t>(id)];
    return {v.u, v.v};
  }

  // An arc is a side with both ends on the curve and the positive triangle on its left. If positive triangles
  // lie on both sides, the curve only touches there. Sides at poles have no length.
  void FindArcs() {
    std::set<std::pair<int, int>> sides;
    for (const ZeroTriangle& t : mesh_.triangles) {
      if (t.sign[0] <= 0) continue;
      for (std::size_t s = 0; s < 3; ++s) {
        const int a = t.vertex[s], b = t.vertex[(s + 1) % 3];
        if (On(a) && On(b) && (Place(a) - Place(b)).norm() > kPole) sides.insert({a, b});
      }
    }
    for (const auto& [a, b] : sides) {
      if (sides.contains({b, a})) continue;
      next_[a].push_back({b, false});
      ++arriving_[b];
      ++arcs_;
    }
  }

  // True if exactly one arc arrives and one leaves: a curve runs through the vertex.
  bool Runs(int id) const {
    const auto leaving = next_.find(id);
    const auto arriving = arriving_.find(id);
    return leaving != next_.end() && leaving->second.size() == 1 && arriving != arriving_.end() &&
           arriving->second == 1;
  }

  void Follow(int from, std::size_t arc, std::vector<ZeroCurve>& curves) {
    if (next_[from][arc].used) return;
    ZeroCurve curve;
    curve.points.push_back(At(id_, piece_, Parameters(from)));
    int at = from;
    for (std::size_t i = arc;; i = 0) {
      if (run_.Cancelled()) return;
      throttle_.ReportIfDue(run_, "curves: points", followed_++, arcs_);
      Arc& step = next_[at][i];
      step.used = true;
      for (const Vec2& q : RefineZeroArc(piece_, field_, Parameters(at), Parameters(step.to), tolerance_))
        curve.points.push_back(At(id_, piece_, q));
      at = step.to;
      if (at == from && Runs(at)) {  // a loop that begins and ends in a node is open
        curve.closed = true;
        break;
      }
      curve.points.push_back(At(id_, piece_, Parameters(at)));
      if (!Runs(at) || next_[at][0].used) break;
    }
    curves.push_back(std::move(curve));
  }

  PieceId id_;
  const Piece& piece_;
  const ZeroField& field_;
  double tolerance_;
  const RunContext& run_;
  ZeroMesh mesh_;
  std::map<int, std::vector<Arc>> next_;
  std::map<int, int> arriving_;
  std::size_t arcs_ = 0, followed_ = 0;
  ProgressThrottle throttle_;
};

bool OnPieceBorder(const SurfacePoint& p) { return p.u == 0.0 || p.u == 1.0 || p.v == 0.0 || p.v == 1.0; }

// Joins open curves whose ends lie together on piece borders, exactly two at a place. An end is joined to a
// start. If the neighbours have opposite S_u x S_v, one of the curves is reversed first.
std::vector<ZeroCurve> Join(std::vector<ZeroCurve> curves, double weld) {
  struct End {
    std::size_t curve;
    bool start;
  };
  const auto point = [&](const End& e) -> const SurfacePoint& {
    return e.start ? curves[e.curve].points.front() : curves[e.curve].points.back();
  };
  std::vector<End> ends;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    for (const bool start : {true, false}) {
      if (!curves[i].closed && OnPieceBorder(point({i, start}))) ends.push_back({i, start});
    }
  }
  std::sort(ends.begin(), ends.end(), [&](const End& a, const End& b) {
    return point(a).p.x() != point(b).p.x() ? point(a).p.x() < point(b).p.x() : a.curve < b.curve;
  });
  const auto number = [](const End& e) { return 2 * e.curve + (e.start ? 0 : 1); };
  std::vector<std::vector<End>> near(2 * curves.size());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = i + 1; j < ends.size() && point(ends[j]).p.x() - point(ends[i]).p.x() <= weld; ++j) {
      if ((point(ends[i]).p - point(ends[j]).p).norm() > weld) continue;
      near[number(ends[i])].push_back(ends[j]);
      near[number(ends[j])].push_back(ends[i]);
    }
  }
  const auto partner = [&](const End& e) -> std::optional<End> {
    const auto& list = near[number(e)];
    if (list.size() != 1 || near[number(list[0])].size() != 1) return std::nullopt;
    return list[0];
  };
  std::vector<bool> used(curves.size(), false);
  std::vector<ZeroCurve> joined;
  // A chain begins at a curve with a free start, if there is one.
  for (const bool free_start : {true, false}) {
    for (std::size_t i = 0; i < curves.size(); ++i) {
      if (used[i] || (free_start && !curves[i].closed && partner({i, true}))) continue;
      used[i] = true;
      ZeroCurve chain = curves[i];
      for (End at{i, false}; !chain.closed;) {
        const auto next = partner(at);
        if (!next) break;
        if (next->curve == i) {
          chain.closed = next->start;
          if (chain.closed) chain.points.pop_back();
          break;
        }
        if (used[next->curve]) break;
        used[next->curve] = true;
        std::vector<SurfacePoint> more = curves[next->curve].points;
        if (!next->start) std::reverse(more.begin(), more.end());
        chain.points.insert(chain.points.end(), more.begin() + 1, more.end());
        at = {next->curve, !next->start};
      }
      joined.push_back(std::move(chain));
    }
  }
  return joined;
}

}  // namespace

absl::StatusOr<std::vector<std::vector<ZeroCurve>>> TraceZeroCurves(const Surface& surface,
                                                                    std::span<const ZeroField> fields,
                                                                    const ZeroMeshParams& params,
                                                                    double tolerance, const RunContext& run) {
  const std::size_t pieces = surface.pieces.size();
  ZeroMeshParams drawn = params;
  drawn.run = &run;
  std::vector<std::vector<ZeroCurve>> parts(pieces * fields.size());  // [field][piece]
  PM_RETURN_IF_ERROR(ParallelFor(run, "curves", parts.size(), [&](std::size_t k) {
    const std::size_t i = k % pieces;
    parts[k] = PieceCurves(PieceId(i), surface.pieces[i], fields[k / pieces], drawn, tolerance).Trace();
  }));
  std::vector<std::vector<ZeroCurve>> traced(fields.size());
  const double weld = std::max(2.0 * surface.network.join_tolerance, 1e-7);
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, fields.size(), [&](std::size_t f) {
    std::vector<ZeroCurve> curves;
    for (std::size_t i = 0; i < pieces; ++i) {
      for (ZeroCurve& curve : parts[f * pieces + i]) curves.push_back(std::move(curve));
    }
    traced[f] = Join(std::move(curves), weld);
  }));
  return traced;
}

absl::StatusOr<std::vector<ZeroCurve>> TraceZeroCurves(const Surface& surface, const ZeroField& field,
                                                       const ZeroMeshParams& params, double tolerance,
                                                       const RunContext& run) {
  PM_ASSIGN_OR_RETURN(auto traced, TraceZeroCurves(surface, std::span(&field, 1), params, tolerance, run));
  return std::move(traced[0]);
}

}  // namespace patchmill
