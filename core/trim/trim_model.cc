#include "core/trim/trim_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>

#include <absl/status/status.h>
#include <absl/strings/str_cat.h>
#include <absl/strings/str_format.h>

#include "core/base/index.h"
#include "core/base/parallel.h"
#include "core/trim/border_trace.h"
#include "core/trim/carrier_grid.h"
#include "core/trim/face_cells.h"
#include "core/trim/plane_strips.h"
#include "core/trim/spanned_curve.h"
#include "core/trim/strip_net.h"

namespace patchmill {
namespace {

constexpr int kMaxRounds = 14;  // halvings of a part of an edge
constexpr double kSameBreak = 1e-10;

// A face on its way to patches. Each stage fills a field of its own.
struct FaceWork {
  absl::Status failed;
  std::optional<CarrierGrid> grid;  // absent for planes
  BorderTrace border;
  std::vector<std::vector<double>> breaks;  // by use, over all loops
  std::vector<BernsteinNet> nets;
  double gap = 0.0, border_error = 0.0, dropped_area = 0.0;
};

struct UseId {
  int face = 0, index = 0;  // index over all loops of the face
};

// The parts of an edge, and the graphs of its uses.
struct EdgeWork {
  std::vector<UseId> uses;
  std::vector<double> breaks;
};

// The file's parameters that the loops reach.
struct HintBox {
  Vec2 low = Vec2::Constant(kInfinity), high = Vec2::Constant(-kInfinity);
};
HintBox BoxOfHints(const BrepFace& face) {
  HintBox box;
  for (const BrepLoop& loop : face.loops) {
    for (const BrepEdgeUse& use : loop) {
      for (const Vec2& h : use.hint) {
        box.low = box.low.cwiseMin(h);
        box.high = box.high.cwiseMax(h);
      }
    }
  }
  return box;
}

int UseCount(const BrepFace& face) {
  int count = 0;
  for (const BrepLoop& loop : face.loops) count += static_cast<int>(loop.size());
  return count;
}

// Knots at which the curve is not twice differentiable, and its ends.
std::vector<double> SharpKnots(const BrepCurve& curve) {
  std::vector<double> sharp;
  const auto p = static_cast<std::size_t>(curve.degree);
  const double first = curve.knots[p], last = curve.knots[curve.knots.size() - 1 - p];
  sharp.push_back(first);
  for (std::size_t k = p + 1; k + p + 1 < curve.knots.size();) {
    std::size_t end = k;
    while (end < curve.knots.size() && curve.knots[end] == curve.knots[k]) ++end;
    if (end - k + 1 >= p && curve.knots[k] > first && curve.knots[k] < last) sharp.push_back(curve.knots[k]);
    k = end;
  }
  sharp.push_back(last);
  return sharp;
}

// A border that is no line of the parameters needs strips, and their degrees have a limit.
absl::Status DegreesFit(const CarrierGrid& grid, const BorderTrace& border) {
  const BernsteinNet& net = grid.carriers.front().net;
  if (LargestStripDegree(net, true) > 0 || LargestStripDegree(net, false) > 0) return absl::OkStatus();
  for (const std::vector<UseTrace>& loop : border.loops) {
    for (const UseTrace& trace : loop) {
      if (trace.iso >= 0) continue;
      return absl::FailedPreconditionError(absl::StrFormat(
          "the surface has the degrees %d and %d, whose sum may be at most %d where a border is no "
          "line of the parameters",
          net.degree_u, net.degree_v, kMaxDegree));
    }
  }
  return absl::OkStatus();
}

class Trimmer {
 public:
  Trimmer(const BrepModel& part, const TrimParams& params, const RunContext& run)
      : part_(part), params_(params), run_(run), faces_(part.faces.size()), edges_(part.edges.size()) {}

  absl::StatusOr<TrimmedModel> Run() {
    for (const BrepEdge& edge : part_.edges) {
      curves_.push_back(edge.degenerate || edge.curve.points.empty() ? SpannedCurve{} : SpansOf(edge.curve));
    }
    using Stage = void (Trimmer::*)(std::size_t);
    const auto each = [this](const char* name, std::size_t count, Stage stage) {
      return ParallelFor(run_, name, count, [this, stage](std::size_t i) { (this->*stage)(i); });
    };
    if (const absl::Status s = each("trim.trace", faces_.size(), &Trimmer::TraceFace); !s.ok()) return s;
    CollectUses();
    graphs_.resize(edges_.size());
    if (const absl::Status s = each("trim.fit", edges_.size(), &Trimmer::FitEdge); !s.ok()) return s;
    if (const absl::Status s = each("trim.cut", faces_.size(), &Trimmer::CutGridFace); !s.ok()) return s;
    return Joined();
  }

 private:
  void TraceFace(std::size_t f) {
    const BrepFace& face = part_.faces[f];
    FaceWork& work = faces_[f];
    work.breaks.resize(At(UseCount(face)));
    if (const auto* plane = std::get_if<BrepPlane>(&face.surface)) {
      absl::StatusOr<PlanePatches> cut = CutPlane(plane->frame, face.loops, curves_, run_);
      if (!cut.ok()) {
        work.failed = cut.status();
        return;
      }
      work.nets = std::move(cut->nets);
      work.breaks = std::move(cut->breaks);
      work.gap = cut->gap;
      return;
    }
    const HintBox box = BoxOfHints(face);
    if (!(box.low.x() <= box.high.x())) {
      work.failed = absl::FailedPreconditionError("the face has no border");
      return;
    }
    work.grid = CarriersOf(face.surface, box.low, box.high);
    absl::StatusOr<BorderTrace> border = TraceBorder(face, curves_, *work.grid, 1e-7);
    if (!border.ok()) {
      work.failed = border.status();
      return;
    }
    work.border = *std::move(border);
    work.gap = work.border.gap;
    if (const absl::Status fits = DegreesFit(*work.grid, work.border); !fits.ok()) {
      work.failed = fits;
      return;
    }
    std::size_t index = 0;
    for (const std::vector<UseTrace>& loop : work.border.loops) {
      for (const UseTrace& trace : loop) {
        if (!trace.degenerate && trace.iso < 0) {
          work.breaks[index] = NaturalBreaks(*work.grid, curves_[At(trace.edge)], trace);
        }
        ++index;
      }
    }
  }

  void CollectUses() {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (!curves_[e].spans.empty()) edges_[e].breaks = SharpKnots(part_.edges[e].curve);
    }
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (!faces_[f].failed.ok()) continue;
      int index = 0;
      for (const BrepLoop& loop : part_.faces[f].loops) {
        for (const BrepEdgeUse& use : loop) {
          EdgeWork& edge = edges_[At(use.edge)];
          edge.uses.push_back({static_cast<int>(f), index});
          const std::vector<double>& own = faces_[f].breaks[At(index)];
          edge.breaks.insert(edge.breaks.end(), own.begin(), own.end());
          ++index;
        }
      }
    }
  }

  const UseTrace* TraceOf(const UseId& use) const {
    int index = use.index;
    for (const std::vector<UseTrace>& loop : faces_[At(use.face)].border.loops) {
      if (index < static_cast<int>(loop.size())) return &loop[At(index)];
      index -= static_cast<int>(loop.size());
    }
    return nullptr;
  }

  // Cuts the edge until every face beside it follows every part within the tolerance.
  void FitEdge(std::size_t e) {
    EdgeWork& edge = edges_[e];
    const SpannedCurve& curve = curves_[e];
    graphs_[e].resize(edge.uses.size());
    if (curve.spans.empty()) return;
    std::vector<std::size_t> fitted;
    for (std::size_t u = 0; u < edge.uses.size(); ++u) {
      const UseTrace* trace = TraceOf(edge.uses[u]);
      if (trace != nullptr && trace->iso < 0) fitted.push_back(u);
    }
    if (fitted.empty()) return;
    const double first = curve.first(), last = curve.last(), same = kSameBreak * (last - first);
    std::sort(edge.breaks.begin(), edge.breaks.end());
    std::vector<double> breaks = {first};
    for (const double t : edge.breaks) {
      if (t > breaks.back() + same && t < last - same) breaks.push_back(t);
    }
    breaks.push_back(last);
    for (std::size_t k = 0; k + 1 < breaks.size(); ++k) FitPart(e, fitted, breaks[k], breaks[k + 1], 0);
  }

  void FitPart(std::size_t e, const std::vector<std::size_t>& fitted, double from, double to, int round) {
    std::vector<FittedGraph> fits;
    // An edge that is off its surfaces itself is followed to half of that.
    double error = 0.0, tolerance = 0.5 * params_.border_tolerance;
    for (const std::size_t u : fitted) {
      const UseId& use = edges_[e].uses[u];
      const UseTrace& trace = *TraceOf(use);
      tolerance = std::max(tolerance, 0.5 * trace.gap);
      fits.push_back(FitGraph(*faces_[At(use.face)].grid, curves_[e], trace, from, to));
      error = std::max(error, fits.back().error);
    }
    if (error > tolerance && round < kMaxRounds && !run_.Cancelled()) {
      const double middle = 0.5 * (from + to);
      FitPart(e, fitted, from, middle, round + 1);
      FitPart(e, fitted, middle, to, round + 1);
      return;
    }
    for (std::size_t k = 0; k < fitted.size(); ++k) graphs_[e][fitted[k]].push_back(std::move(fits[k]));
  }

  // A straight use from begin to end, cut at the grid lines.
  static void AddStraight(const UseTrace& trace, std::vector<GridGraph>& border) {
    const GridGraph whole = StraightGraph(trace.places.front(), trace.places.back());
    if (!(whole.from < whole.to)) return;
    GridGraph rest = whole;
    const int axis = whole.along_u ? 0 : 1;
    for (double line = std::floor(whole.from) + 1.0; line < whole.to; line += 1.0) {
      GraphParts parts = CutGraph(rest, axis, line);
      border.push_back(std::move(parts.low));
      rest = std::move(parts.high);
    }
    border.push_back(std::move(rest));
  }

  void CutGridFace(std::size_t f) {
    FaceWork& work = faces_[f];
    if (!work.failed.ok() || !work.grid) return;
    std::vector<GridGraph> border;
    int index = 0;
    for (const std::vector<UseTrace>& loop : work.border.loops) {
      for (const UseTrace& trace : loop) {
        if (trace.iso >= 0) {
          AddStraight(trace, border);
        } else {
          const EdgeWork& edge = edges_[At(trace.edge)];
          for (std::size_t u = 0; u < edge.uses.size(); ++u) {
            if (edge.uses[u].face != static_cast<int>(f) || edge.uses[u].index != index) continue;
            for (const FittedGraph& fit : graphs_[At(trace.edge)][u]) {
              if (!(fit.graph.from < fit.graph.to)) continue;
              work.border_error = std::max(work.border_error, fit.error);
              border.push_back(fit.graph);
            }
          }
        }
        ++index;
      }
    }
    absl::StatusOr<FacePatches> cut = CutFace(*work.grid, border, 0.5 * params_.border_tolerance, run_);
    if (!cut.ok()) {
      work.failed = cut.status();
      return;
    }
    work.nets = std::move(cut->nets);
    work.dropped_area = cut->dropped_area;
  }

  absl::StatusOr<TrimmedModel> Joined();

  const BrepModel& part_;
  const TrimParams& params_;
  const RunContext& run_;
  EdgeCurveTable curves_;
  std::vector<FaceWork> faces_;
  std::vector<EdgeWork> edges_;
  std::vector<std::vector<std::vector<FittedGraph>>> graphs_;  // by edge, by use
};

// Gauss's rule with eight points on [0,1].
constexpr std::array<double, 8> kNodes = {0.019855071751231884, 0.101666761293186630, 0.237233795041835507,
                                          0.408282678752175098, 0.591717321247824902, 0.762766204958164493,
                                          0.898333238706813370, 0.980144928248768116};
constexpr std::array<double, 8> kWeights = {0.050614268145188130, 0.111190517226687235, 0.156853322938943644,
                                            0.181341891689180991, 0.181341891689180991, 0.156853322938943644,
                                            0.111190517226687235, 0.050614268145188130};

// The area by parts x parts Gauss squares.
double AreaOf(const PatchShape& shape, int parts) {
  const auto nodes = static_cast<int>(kNodes.size());
  double area = 0.0;
  for (int i = 0; i < nodes * parts; ++i) {
    for (int j = 0; j < nodes * parts; ++j) {
      const double u = (i / nodes + kNodes[At(i % nodes)]) / parts,
                   v = (j / nodes + kNodes[At(j % nodes)]) / parts;
      const SurfaceJet jet = Evaluate(shape, u, v);
      area += kWeights[At(i % nodes)] * kWeights[At(j % nodes)] * jet.du.cross(jet.dv).norm();
    }
  }
  return area / (parts * parts);
}

// The area to about 1e-9 of it.
double AreaOf(const BezierPatch& patch) {
  const PatchShape shape = patch;
  double area = AreaOf(shape, 1);
  for (int parts = 2; parts <= 16; parts *= 2) {
    const double finer = AreaOf(shape, parts);
    const bool settled = std::abs(finer - area) <= 1e-9 * finer;
    area = finer;
    if (settled) break;
  }
  return area;
}

BezierPatch PatchOf(const BernsteinNet& net, bool reversed, double quantum) {
  BezierPatch patch;
  patch.degree_u = reversed ? net.degree_v : net.degree_u;
  patch.degree_v = reversed ? net.degree_u : net.degree_v;
  const double w0 = net.points.front().w();
  const bool rational = std::any_of(net.points.begin(), net.points.end(), [w0](const Vec4& p) {
    return std::abs(p.w() - w0) > 1e-14 * std::abs(w0);
  });
  for (int i = 0; i <= patch.degree_u; ++i) {
    for (int j = 0; j <= patch.degree_v; ++j) {
      const int k = reversed ? j * (net.degree_v + 1) + i : i * (net.degree_v + 1) + j;
      const Vec4& h = net.points[At(k)];
      Vec3 p = h.head<3>() / h.w();
      for (double& x : p) x = std::nearbyint(x / quantum) * quantum;
      patch.points.push_back(p);
      if (rational) patch.weights.push_back(h.w() / w0);
    }
  }
  return patch;
}

absl::StatusOr<TrimmedModel> Trimmer::Joined() {
  TrimmedModel result;
  Box3 box;
  for (const FaceWork& work : faces_) {
    for (const BernsteinNet& net : work.nets) {
      for (const Vec4& h : net.points) box.Add(Vec3(h.head<3>() / h.w()));
    }
  }
  if (box.Empty()) {
    const auto lost =
        std::find_if(faces_.begin(), faces_.end(), [](const FaceWork& work) { return !work.failed.ok(); });
    return absl::FailedPreconditionError(absl::StrCat("no face of the part could be trimmed",
                                                      lost == faces_.end() ? "" : ": ",
                                                      lost == faces_.end() ? "" : lost->failed.message()));
  }
  const double quantum = std::exp2(std::ceil(std::log2(std::max(box.Diagonal(), 1e-6))) - 40.0);
  // Edges farther off their surfaces say that the file is broken.
  const double coarsest = std::max(0.05, 2e-3 * box.Diagonal());
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const FaceWork& work = faces_[f];
    TrimmedFace face;
    face.id = absl::StrCat("f", f + 1);
    face.first_patch = static_cast<int>(result.model.patches.size());
    face.patch_count = static_cast<int>(work.nets.size());
    face.gap = work.gap;
    face.border_error = work.border_error;
    for (std::size_t k = 0; k < work.nets.size(); ++k) {
      BezierPatch patch = PatchOf(work.nets[k], part_.faces[f].reversed, quantum);
      face.area += AreaOf(patch);
      std::string id = work.nets.size() == 1 ? face.id : absl::StrCat(face.id, ".", k + 1);
      result.model.patches.push_back({std::move(id), std::move(patch)});
    }
    const Where where{.patch_id = face.id};
    const std::optional<double>& stated = part_.faces[f].area;
    if (face.patch_count == 0) {
      const std::string why =
          work.failed.ok() ? "nothing lies inside its border" : std::string(work.failed.message());
      result.findings.push_back(
          MakeError("FACE_LOST", absl::StrFormat("face %s could not be trimmed: %s", face.id, why), where));
    } else if (stated && !(std::abs(face.area - *stated) <=
                           1e-4 * std::abs(*stated) + 1e-3 + work.dropped_area +
                               4.0 * std::sqrt(std::abs(*stated)) * (work.border_error + work.gap))) {
      result.findings.push_back(
          MakeError("FACE_AREA_DIFFERS",
                    absl::StrFormat("face %s has %.6g mm2 in the file and %.6g mm2 as patches", face.id,
                                    *stated, face.area),
                    where));
    }
    if (work.border_error > std::max(params_.border_tolerance, work.gap)) {
      result.findings.push_back(MakeWarning(
          "BORDER_COARSE",
          absl::StrFormat("the border of face %s is off its edges by %.3g mm; %.3g mm were allowed", face.id,
                          work.border_error, params_.border_tolerance),
          where));
    }
    if (work.gap > coarsest) {
      result.findings.push_back(MakeError(
          "GAP",
          absl::StrFormat("an edge of face %s lies %.3g mm off its surface; at most %.3g mm are taken",
                          face.id, work.gap, coarsest),
          where));
    } else if (work.gap > params_.border_tolerance) {
      result.findings.push_back(MakeWarning(
          "GAP", absl::StrFormat("edges of face %s lie up to %.3g mm off its surface", face.id, work.gap),
          where));
    }
    result.largest_gap = std::max(result.largest_gap, work.gap);
    result.border_error = std::max(result.border_error, work.border_error);
    result.faces.push_back(std::move(face));
  }
  return result;
}

}  // namespace

absl::StatusOr<TrimmedModel> TrimFaces(const BrepModel& part, const TrimParams& params,
                                       const RunContext& run) {
  return Trimmer(part, params, run).Run();
}

}  // namespace patchmill
