#include "import/occt/face_loops.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <BRepTools.hxx>
#include <BRepTools_WireExplorer.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Plane.hxx>
#include <ShapeFix_Edge.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Wire.hxx>
#include <absl/status/status.h>

#include "core/base/status.h"
#include "import/occt/convert.h"

namespace patchmill {
namespace {

constexpr int kSamplesPerSpan = 16, kMostSamples = 400;

bool IsBorder(const TopoDS_Shape& edge) {
  return edge.Orientation() == TopAbs_FORWARD || edge.Orientation() == TopAbs_REVERSED;
}

// The edges of a wire, in the order of the loop where that can be followed. `ordered` says whether it could.
std::vector<TopoDS_Edge> EdgesOf(const TopoDS_Wire& wire, const TopoDS_Face& face, bool& ordered) {
  std::vector<TopoDS_Edge> followed, all;
  for (BRepTools_WireExplorer walk(wire, face); walk.More(); walk.Next()) {
    if (IsBorder(walk.Current())) followed.push_back(walk.Current());
  }
  for (TopoDS_Iterator it(wire); it.More(); it.Next()) {
    if (IsBorder(it.Value())) all.push_back(TopoDS::Edge(it.Value()));
  }
  ordered = followed.size() == all.size();
  return ordered ? followed : all;
}

// Parameters of the edge's curve: each span between knots in equal parts, at least one.
std::vector<double> SampleParameters(const TableEdge& edge) {
  const std::vector<double>& knots = edge.part.curve.knots;
  std::vector<double> breaks;
  for (const double k : knots) {
    const double t = k - edge.part.map.shift;
    if (breaks.empty() || t > breaks.back()) breaks.push_back(t);
  }
  const auto spans = static_cast<int>(breaks.size()) - 1;
  const int parts = std::max(1, std::min(kSamplesPerSpan, kMostSamples / spans));
  std::vector<double> at;
  for (int s = 0; s < spans; ++s) {
    for (int k = 0; k < parts; ++k) {
      at.push_back(breaks[At(s)] + (breaks[At(s + 1)] - breaks[At(s)]) * k / parts);
    }
  }
  at.push_back(breaks.back());
  return at;
}

class Sampler {
 public:
  Sampler(const TopoDS_Face& face, const Handle(Geom_Surface) & bare, EdgeTable& edges)
      : face_(face), plane_(Handle(Geom_Plane)::DownCast(bare)), edges_(edges) {}

  // Without places for an edge that the loop does not need.
  absl::StatusOr<SampledUse> Sample(const TopoDS_Edge& oriented) {
    SampledUse use;
    use.edge = edges_.NumberOf(oriented);
    use.forward = oriented.Orientation() == TopAbs_FORWARD;
    const TableEdge& edge = edges_.edge(use.edge);
    if (!edge.status.ok()) return edge.status;
    use.degenerate = edge.degenerate;
    if (!plane_.IsNull()) {
      if (edge.degenerate) return use;
      double first = 0.0, last = 1.0;
      const Handle(Geom_Curve) curve = BRep_Tool::Curve(oriented, first, last);
      use.curve = PlaceCurve(curve, ToFrame(plane_->Position()), edge.first, edge.last);
      Fill(edge, use);
      return use;
    }
    use.seam = !edge.degenerate && BRep_Tool::IsClosed(oriented, face_);
    double first = 0.0, last = 1.0;
    Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(oriented, face_, first, last);
    if (curve.IsNull() && !edge.degenerate) {
      ShapeFix_Edge().FixAddPCurve(oriented, face_, use.seam, BRep_Tool::Tolerance(oriented));
      curve = BRep_Tool::CurveOnSurface(oriented, face_, first, last);
    }
    if (curve.IsNull() || !(first < last)) {
      if (edge.degenerate) return use;
      return absl::InvalidArgumentError("an edge has no curve on the surface");
    }
    use.curve = edge.degenerate ? PlaceCurve(curve, first, last, 0.0, 1.0)
                                : PlaceCurve(curve, first, last, edge.first, edge.last);
    Fill(edge, use);
    // A pole that is one place lies at a corner of its loop instead of along a side.
    if (edge.degenerate && (use.place[0] - use.place[1]).norm() < 1e-12) use.place.clear();
    return use;
  }

 private:
  static void Fill(const TableEdge& edge, SampledUse& use) {
    use.at = edge.degenerate ? std::vector<double>{0.0, 1.0} : SampleParameters(edge);
    for (const double t : use.at) use.place.push_back(use.curve.At(t).place);
  }

  const TopoDS_Face& face_;
  const Handle(Geom_Plane) plane_;
  EdgeTable& edges_;
};

// Where a surface repeats or closes.
class Turns {
 public:
  explicit Turns(const Geom_Surface& s) {
    s.Bounds(low_[0], high_[0], low_[1], high_[1]);
    periodic_[0] = s.IsUPeriodic();
    periodic_[1] = s.IsVPeriodic();
    if (periodic_[0]) length_[0] = s.UPeriod();
    if (periodic_[1]) length_[1] = s.VPeriod();
    if (!periodic_[0] && std::isfinite(high_[0] - low_[0]) && s.IsUClosed()) length_[0] = high_[0] - low_[0];
    if (!periodic_[1] && std::isfinite(high_[1] - low_[1]) && s.IsVClosed()) length_[1] = high_[1] - low_[1];
  }

  bool Any() const { return length_[0] > 0.0 || length_[1] > 0.0; }

  // The whole turns that bring `from` closest to `to`.
  Vec2 Between(const Vec2& from, const Vec2& to) const {
    Vec2 shift = Vec2::Zero();
    for (int axis = 0; axis < 2; ++axis) {
      if (length_[axis] > 0.0)
        shift[axis] = length_[axis] * std::round((to[axis] - from[axis]) / length_[axis]);
    }
    return shift;
  }

  // Shifts the use, but not out of a surface that is closed and does not repeat.
  void Shift(SampledUse& use, Vec2 shift) const {
    constexpr double kSlack = 1e-3;
    for (int axis = 0; axis < 2; ++axis) {
      if (periodic_[axis] || shift[axis] == 0.0) continue;
      for (const Vec2& p : use.place) {
        const double x = p[axis] + shift[axis], slack = kSlack * length_[axis];
        if (x < low_[axis] - slack || x > high_[axis] + slack) shift[axis] = 0.0;
      }
    }
    for (Vec2& p : use.place) p += shift;
    use.curve.Shift(shift);
  }

 private:
  bool periodic_[2] = {false, false};
  double low_[2] = {0.0, 0.0}, high_[2] = {0.0, 0.0};
  double length_[2] = {0.0, 0.0};  // 0 where it neither repeats nor closes
};

// Orders the uses so that each begins near the end of the one before.
void Follow(SampledLoop& loop, const Turns& turns) {
  for (std::size_t k = 1; k < loop.size(); ++k) {
    std::size_t best = k;
    double least = kInfinity;
    for (std::size_t j = k; j < loop.size(); ++j) {
      const Vec2 off = loop[k - 1].end() - loop[j].begin();
      const double apart = (off - turns.Between(Vec2::Zero(), off)).norm();
      if (apart < least) {
        least = apart;
        best = j;
      }
    }
    std::rotate(loop.begin() + static_cast<std::ptrdiff_t>(k),
                loop.begin() + static_cast<std::ptrdiff_t>(best),
                loop.begin() + static_cast<std::ptrdiff_t>(best) + 1);
  }
}

void JoinUp(SampledLoop& loop, const Turns& turns) {
  for (std::size_t k = 1; k < loop.size(); ++k) {
    turns.Shift(loop[k], turns.Between(loop[k].begin(), loop[k - 1].end()));
  }
}

struct PlaceBox {
  Vec2 low = Vec2::Constant(kInfinity), high = Vec2::Constant(-kInfinity);
  Vec2 Center() const { return 0.5 * (low + high); }
};
PlaceBox BoxOf(const SampledLoop& loop) {
  PlaceBox box;
  for (const SampledUse& use : loop) {
    for (const Vec2& p : use.place) {
      box.low = box.low.cwiseMin(p);
      box.high = box.high.cwiseMax(p);
    }
  }
  return box;
}

}  // namespace

absl::StatusOr<std::vector<SampledLoop>> SampleLoops(const TopoDS_Face& given,
                                                     const Handle(Geom_Surface) & bare, EdgeTable& edges) {
  const TopoDS_Face face = TopoDS::Face(given.Oriented(TopAbs_FORWARD));
  const TopoDS_Wire outer = BRepTools::OuterWire(face);
  std::vector<TopoDS_Wire> wires;
  for (TopoDS_Iterator it(face); it.More(); it.Next()) {
    if (it.Value().ShapeType() != TopAbs_WIRE) continue;
    const TopoDS_Wire wire = TopoDS::Wire(it.Value());
    wires.insert(wire.IsSame(outer) ? wires.begin() : wires.end(), wire);
  }
  const Turns turns(*bare);
  Sampler sampler(face, bare, edges);
  std::vector<SampledLoop> loops;
  for (const TopoDS_Wire& wire : wires) {
    bool ordered = true;
    SampledLoop loop;
    for (const TopoDS_Edge& edge : EdgesOf(wire, face, ordered)) {
      PM_ASSIGN_OR_RETURN(SampledUse use, sampler.Sample(edge));
      if (!use.place.empty()) loop.push_back(std::move(use));
    }
    if (loop.empty()) continue;
    if (!ordered) Follow(loop, turns);
    if (turns.Any()) {
      JoinUp(loop, turns);
      if (!loops.empty()) {
        const Vec2 shift = turns.Between(BoxOf(loop).Center(), BoxOf(loops.front()).Center());
        for (SampledUse& use : loop) turns.Shift(use, shift);
      }
    }
    loops.push_back(std::move(loop));
  }
  if (loops.empty()) return absl::InvalidArgumentError("the face has no border");
  return loops;
}

NeededParameters ParametersOf(const std::vector<SampledLoop>& loops) {
  PlaceBox all;
  for (const SampledLoop& loop : loops) {
    const PlaceBox box = BoxOf(loop);
    all.low = all.low.cwiseMin(box.low);
    all.high = all.high.cwiseMax(box.high);
  }
  // An edge this close to an end of the range runs along it.
  constexpr double kAlong = 1e-6;
  const Vec2 near = kAlong * (all.high - all.low);
  bool along_low[2] = {false, false}, along_high[2] = {false, false};
  for (const SampledLoop& loop : loops) {
    for (const SampledUse& use : loop) {
      const PlaceBox box = BoxOf({use});
      for (int axis = 0; axis < 2; ++axis) {
        along_low[axis] |= box.high[axis] <= all.low[axis] + near[axis];
        along_high[axis] |= box.low[axis] >= all.high[axis] - near[axis];
      }
    }
  }
  return {{all.low.x(), all.high.x(), along_low[0], along_high[0]},
          {all.low.y(), all.high.y(), along_low[1], along_high[1]}};
}

}  // namespace patchmill
