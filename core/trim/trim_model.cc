#include "core/trim/trim_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>
#include <variant>

#include <absl/status/status.h>
#include <absl/strings/str_cat.h>
#include <absl/strings/str_format.h>

#include "core/base/index.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/patch/patch_figures.h"
#include "core/trim/border_trace.h"
#include "core/trim/edge_fit.h"
#include "core/trim/face_box.h"
#include "core/trim/face_cells.h"
#include "core/trim/face_trace.h"
#include "core/trim/spanned_curve.h"

namespace patchmill {
namespace {

constexpr double kLargestGap = 0.05;       // mm: what a file may be off, at least
constexpr double kLargestGapShare = 2e-3;  // of the part's size: what it may be off where that is more
constexpr double kAreaAgreement = 1e-4;    // of an area or a volume

constexpr double kWidestNeedle = 1e-4;  // mm: the widest face that may be left out
constexpr double kBoxMargin = 1e-4;     // of the part's size: by how much the box of a skipped face is larger

// One edge as a part of a face's border.
struct UsePlace {
  int face = 0, use = 0;  // `use`: over all loops of the face
};
using UsesOfEdges = std::vector<std::vector<UsePlace>>;

UsesOfEdges UsesOf(const BrepModel& part) {
  UsesOfEdges uses(part.edges.size());
  for (std::size_t f = 0; f < part.faces.size(); ++f) {
    int index = 0;
    for (const BrepLoop& loop : part.faces[f].loops) {
      for (const BrepEdgeUse& use : loop) uses[At(use.edge)].push_back({static_cast<int>(f), index++});
    }
  }
  return uses;
}

const UseTrace& TraceOf(const GridTrace& trace, int use) {
  for (const std::vector<UseTrace>& loop : trace.border.loops) {
    if (use < static_cast<int>(loop.size())) return loop[At(use)];
    use -= static_cast<int>(loop.size());
  }
  PM_CHECK(false);
}

// The fitted graphs of a face, by use over all its loops; none where the edge is iso-parametric.
using GraphsOfUses = std::vector<std::vector<FittedGraph>>;

// An edge with the faces that need graphs of it.
struct FittedEdge {
  std::vector<UsePlace> uses;
  std::vector<std::vector<FittedGraph>> graphs;  // of each of these uses
};

FittedEdge FitOne(const BrepEdge& edge, const SpannedCurve& curve, const std::vector<UsePlace>& uses,
                  const std::vector<TracedFace>& faces, double tolerance, const RunContext& run) {
  FittedEdge fitted;
  if (curve.spans.empty()) return fitted;
  std::vector<EdgeSide> sides;
  std::vector<double> breaks = SharpKnots(edge.curve);
  for (const UsePlace& place : uses) {
    const TracedFace& face = faces[At(place.face)];
    if (At(place.use) < face.breaks.size()) {
      const std::vector<double>& own = face.breaks[At(place.use)];
      breaks.insert(breaks.end(), own.begin(), own.end());
    }
    const GridTrace* trace = face.grid();
    if (trace == nullptr || TraceOf(*trace, place.use).iso >= 0) continue;
    sides.push_back({&trace->grid, &TraceOf(*trace, place.use)});
    fitted.uses.push_back(place);
  }
  fitted.graphs = FitEdge(curve, sides, std::move(breaks), tolerance, run);
  return fitted;
}

// The graphs sorted by face and use.
std::vector<GraphsOfUses> GraphsOfFaces(const BrepModel& part, std::vector<FittedEdge> edges) {
  std::vector<GraphsOfUses> graphs(part.faces.size());
  for (std::size_t f = 0; f < part.faces.size(); ++f) {
    std::size_t uses = 0;
    for (const BrepLoop& loop : part.faces[f].loops) uses += loop.size();
    graphs[f].resize(uses);
  }
  for (FittedEdge& edge : edges) {
    for (std::size_t k = 0; k < edge.uses.size(); ++k) {
      graphs[At(edge.uses[k].face)][At(edge.uses[k].use)] = std::move(edge.graphs[k]);
    }
  }
  return graphs;
}

// A straight way from one place to another, cut at the grid lines.
void AddStraight(const UseTrace& trace, std::vector<GridGraph>& border) {
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

// The patches of a face, and how well they end at its edges.
struct CutOutcome {
  absl::Status status;  // why there are none
  std::vector<BernsteinNet> nets;
  double border_error = 0.0, dropped_area = 0.0;
};

CutOutcome CutOne(const TracedFace& face, const GraphsOfUses& graphs, double tolerance,
                  const RunContext& run) {
  if (const auto* failed = std::get_if<absl::Status>(&face.result)) return {*failed, {}, 0.0, 0.0};
  if (const auto* plane = std::get_if<PlanePatches>(&face.result)) return {{}, plane->nets, 0.0, 0.0};
  const GridTrace& trace = *face.grid();
  std::vector<GridGraph> border;
  CutOutcome outcome;
  std::size_t index = 0;
  for (const std::vector<UseTrace>& loop : trace.border.loops) {
    for (const UseTrace& use : loop) {
      if (use.iso >= 0) AddStraight(use, border);
      for (const FittedGraph& fit : graphs[index]) {
        if (!(fit.graph.from < fit.graph.to)) continue;
        outcome.border_error = std::max(outcome.border_error, fit.error);
        border.push_back(fit.graph);
      }
      ++index;
    }
  }
  for (const UseTrace& side : trace.border.short_sides) AddStraight(side, border);
  absl::StatusOr<FacePatches> cut = CutFace(trace.grid, border, 0.5 * tolerance, run);
  if (!cut.ok()) return {cut.status(), {}, 0.0, 0.0};
  outcome.nets = std::move(cut->nets);
  outcome.border_error = std::max(outcome.border_error, cut->border_error);
  outcome.dropped_area = cut->dropped_area;
  return outcome;
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

Box3 BoxOf(const std::vector<CutOutcome>& faces) {
  Box3 box;
  for (const CutOutcome& face : faces) {
    for (const BernsteinNet& net : face.nets) {
      for (const Vec4& h : net.points) box.Add(Vec3(h.head<3>() / h.w()));
    }
  }
  return box;
}

// By how much the face's edges are not those of the file.
double CurveError(const BrepModel& part, const BrepFace& face) {
  double error = 0.0;
  for (const BrepLoop& loop : face.loops) {
    for (const BrepEdgeUse& use : loop) error = std::max(error, part.edges[At(use.edge)].curve_error);
  }
  return error;
}

// About: the edges as polygons.
double BorderLength(const BrepFace& face, const EdgeCurveTable& curves) {
  double length = 0.0;
  for (const BrepLoop& loop : face.loops) {
    for (const BrepEdgeUse& use : loop) {
      for (const CurveSpan& span : curves[At(use.edge)].spans) {
        for (std::size_t k = 1; k < span.points.size(); ++k) {
          length += (span.points[k].head<3>() / span.points[k].w() -
                     span.points[k - 1].head<3>() / span.points[k - 1].w())
                        .norm();
        }
      }
    }
  }
  return length;
}

// The area that a trimmed face should have.
struct JudgedArea {
  std::optional<double> stated;  // mm^2, of the file
  double slack = 0.0;            // mm^2 by which it may differ because of the face's border
  double border_length = 0.0;    // mm

  double Width() const {
    return stated && border_length > 0.0 ? 2.0 * std::abs(*stated) / border_length : kInfinity;
  }
  // A gap that its absence leaves is no wider than borders may be off, whatever tolerance the user has set.
  bool IsNeedle(double border_tolerance) const {
    return Width() <= std::min(border_tolerance, kWidestNeedle);
  }
};

// The faults of one trimmed face.
Diagnostics FaceFindings(const ModelFace& of, const TrimmedFace& face, const CutOutcome& outcome,
                         const JudgedArea& judged, const TrimParams& params) {
  Diagnostics findings;
  const Where where{.face_id = of.id};
  const std::string title = Title(of);
  if (face.patch_count == 0 && judged.IsNeedle(params.border_tolerance)) {
    findings.push_back(MakeWarning(
        "FACE_TOO_NARROW",
        absl::StrFormat("face %s is left out: it is %.2g mm wide, and borders may be off by %.3g mm", title,
                        judged.Width(), params.border_tolerance),
        where));
  } else if (face.patch_count == 0) {
    const std::string why =
        outcome.status.ok() ? "nothing lies inside its border" : std::string(outcome.status.message());
    findings.push_back(
        MakeError("FACE_LOST", absl::StrFormat("face %s could not be trimmed: %s", title, why), where));
  } else if (judged.stated && !(std::abs(face.area - *judged.stated) <=
                                kAreaAgreement * std::abs(*judged.stated) + judged.slack)) {
    findings.push_back(MakeError("FACE_AREA_DIFFERS",
                                 absl::StrFormat("face %s has %.6g mm2 in the file and %.6g mm2 as patches",
                                                 title, *judged.stated, face.area),
                                 where));
  }
  if (face.border_error > std::max(params.border_tolerance, face.gap)) {
    findings.push_back(
        MakeWarning("BORDER_COARSE",
                    absl::StrFormat("the border of face %s is off its edges by %.3g mm; %.3g mm were allowed",
                                    title, face.border_error, params.border_tolerance),
                    where));
  }
  return findings;
}

Diagnostics GapFindings(const ModelFace& of, const TrimmedFace& face, double largest, double tolerance) {
  const Where where{.face_id = of.id};
  if (face.gap > largest) {
    return {MakeError(
        "GAP",
        absl::StrFormat("an edge of face %s lies %.3g mm off its surface; at most %.3g mm are taken",
                        Title(of), face.gap, largest),
        where)};
  }
  if (face.gap <= tolerance) return {};
  return {MakeWarning(
      "GAP", absl::StrFormat("edges of face %s lie up to %.3g mm off its surface", Title(of), face.gap),
      where)};
}

// Volumes of bodies, by the patches of their faces.
class Volumes {
 public:
  explicit Volumes(std::size_t bodies) : sums_(bodies) {}

  // The volume of this face's body is not known.
  void Lose(const BrepFace& face) {
    if (face.body >= 0 && At(face.body) < sums_.size()) sums_[At(face.body)].whole = false;
  }

  // `slack`: mm^2 by which the face may be off, at `reach` mm from the origin.
  void Add(const BrepFace& face, const TrimmedFace& trimmed, double volume, double slack, double reach) {
    if (face.body < 0 || At(face.body) >= sums_.size()) return;
    Sum& sum = sums_[At(face.body)];
    sum.volume += volume;
    sum.slack += slack * reach / 3.0 + trimmed.area * trimmed.gap;
  }

  Diagnostics Findings(const std::vector<BrepBody>& bodies) const {
    Diagnostics findings;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const std::optional<double>& stated = bodies[b].volume;
      if (!stated || !sums_[b].whole) continue;
      if (std::abs(sums_[b].volume - *stated) <= kAreaAgreement * std::abs(*stated) + sums_[b].slack)
        continue;
      findings.push_back(MakeError("VOLUME_DIFFERS",
                                   absl::StrFormat("body %d has %.6g mm3 in the file and %.6g mm3 as patches",
                                                   static_cast<int>(b) + 1, *stated, sums_[b].volume)));
    }
    return findings;
  }

 private:
  struct Sum {
    double volume = 0.0, slack = 0.0;
    bool whole = true;
  };
  std::vector<Sum> sums_;
};

struct RoundSurface {
  double radius = 0.0;  // mm; 0 for a cone
  BrepFrame frame;
};
std::optional<RoundSurface> RoundSurfaceOf(const BrepSurface& surface) {
  if (const auto* s = std::get_if<BrepCylinder>(&surface)) return RoundSurface{s->radius, s->frame};
  if (const auto* s = std::get_if<BrepCone>(&surface)) return RoundSurface{0.0, s->frame};
  if (const auto* s = std::get_if<BrepSphere>(&surface)) return RoundSurface{s->radius, s->frame};
  if (const auto* s = std::get_if<BrepTorus>(&surface)) return RoundSurface{s->minor, s->frame};
  return std::nullopt;
}

SurfaceKind KindOf(const BrepSurface& surface) {
  constexpr SurfaceKind kKinds[] = {SurfaceKind::kPlane,  SurfaceKind::kCylinder, SurfaceKind::kCone,
                                    SurfaceKind::kSphere, SurfaceKind::kTorus,    SurfaceKind::kSpline};
  static_assert(std::size(kKinds) == std::variant_size_v<BrepSurface>);
  return kKinds[surface.index()];
}

// A face of the part with its name, body, colour, kind and radius.
ModelFace FaceOf(const BrepModel& part, std::size_t index) {
  const BrepFace& from = part.faces[index];
  ModelFace face;
  face.id = absl::StrCat("f", index + 1);
  face.name = from.name;
  if (from.body >= 0 && At(from.body) < part.bodies.size()) face.body = part.bodies[At(from.body)].name;
  face.layer = from.layer;
  face.rgb = from.rgb;
  face.kind = KindOf(from.surface);
  face.entity = from.entity;
  if (const std::optional<RoundSurface> round = RoundSurfaceOf(from.surface)) {
    face.radius = round->radius;
    // The normal u x v of these surfaces points away from their axis or centre, or towards it in a mirrored
    // frame.
    const bool mirrored = round->frame.x.cross(round->frame.y).dot(round->frame.z) < 0.0;
    face.hollow = from.reversed != mirrored;
  }
  return face;
}

// The borders of two faces along one edge are apart by the errors of both. Needles between two edges of one
// face may be hardly wider.
double JoinTolerance(double error, double size) {
  constexpr double kMargin = 1.2;
  constexpr double kLeastShare = 1e-6, kMostShare = 1e-3, kMost = 0.05;  // of the size; mm
  const double most = std::max(std::min(kMost, kMostShare * size), kDefaultJoinTolerance * size);
  return std::clamp(2.0 * kMargin * error, kLeastShare * size, most);
}

Diagnostics ApproximatedSurfaces(const TrimmedModel& model) {
  constexpr int kMostNamed = 12;
  std::string names;
  int count = 0;
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    if (!(model.faces[f].surface_error > 0.0)) continue;
    if (++count <= kMostNamed) absl::StrAppend(&names, count > 1 ? ", " : "", model.model.faces[f].id);
  }
  if (count == 0) return {};
  if (count > kMostNamed) absl::StrAppend(&names, " and ", count - kMostNamed, " more");
  return {MakeInfo(
      "SURFACES_APPROXIMATED",
      absl::StrFormat(
          "%d faces lie on surfaces that differ from the file's by at most %.2g mm, offsets or of high "
          "degree: %s",
          count, model.surface_error, names))};
}

bool IsSkipped(const TrimParams& params, std::size_t face) {
  return std::find(params.skipped.begin(), params.skipped.end(), FaceId(face)) != params.skipped.end();
}

std::string PatchIdOf(const ModelFace& face, std::size_t count, std::size_t k) {
  return count == 1 ? face.id : absl::StrCat(face.id, ".", k + 1);
}

// The patches of a skipped face: a box that holds it, in steps of the quantum.
std::vector<Patch> BoxPatches(const BrepModel& part, std::size_t index, const ModelFace& face, double margin,
                              double quantum) {
  Box3 box = BoxOfFace(part, part.faces[index]);
  std::vector<Patch> patches;
  if (box.Empty()) return patches;
  for (int k = 0; k < 3; ++k) {
    box.min[k] = std::floor((box.min[k] - margin) / quantum) * quantum;
    box.max[k] = std::ceil((box.max[k] + margin) / quantum) * quantum;
  }
  const std::array<BezierPatch, 6> sides = SidesOf(box);
  for (std::size_t k = 0; k < sides.size(); ++k)
    patches.push_back({PatchIdOf(face, sides.size(), k), sides[k], FaceId(index)});
  return patches;
}

// All faces one after the other, judged.
absl::StatusOr<TrimmedModel> Join(const BrepModel& part, const EdgeCurveTable& curves,
                                  const std::vector<TracedFace>& traced, const std::vector<CutOutcome>& cut,
                                  const TrimParams& params) {
  const Box3 box = BoxOf(cut);
  if (box.Empty()) {
    const auto lost =
        std::find_if(cut.begin(), cut.end(), [](const CutOutcome& c) { return !c.status.ok(); });
    return absl::FailedPreconditionError(absl::StrCat("no face of the part could be trimmed",
                                                      lost == cut.end() ? "" : ": ",
                                                      lost == cut.end() ? "" : lost->status.message()));
  }
  TrimmedModel result;
  Volumes volumes(part.bodies.size());
  const double size = box.Diagonal();
  const double quantum = std::exp2(std::ceil(std::log2(std::max(size, 1e-6))) - 40.0);
  const double largest_gap = std::max(kLargestGap, kLargestGapShare * size);
  for (std::size_t f = 0; f < cut.size(); ++f) {
    TrimmedFace face;
    result.model.faces.push_back(FaceOf(part, f));
    const ModelFace& named = result.model.faces.back();
    face.first_patch = static_cast<int>(result.model.patches.size());
    if (IsSkipped(params, f)) {
      result.model.faces.back().skipped = true;
      const double margin = std::max(params.border_tolerance, kBoxMargin * size);
      for (Patch& patch : BoxPatches(part, f, named, margin, quantum)) {
        result.model.patches.push_back(std::move(patch));
        ++face.patch_count;
      }
      if (face.patch_count == 0) {
        result.findings.push_back(MakeError(
            "FACE_LOST",
            absl::StrFormat("face %s cannot be skipped: nothing is known of where it lies", Title(named)),
            {.face_id = named.id}));
      }
      volumes.Lose(part.faces[f]);
      result.faces.push_back(std::move(face));
      continue;
    }
    face.patch_count = static_cast<int>(cut[f].nets.size());
    face.gap = traced[f].gap();
    face.surface_error = part.faces[f].surface_error;
    if (const GridTrace* trace = traced[f].grid()) face.surface_error = trace->surface_error;
    face.border_error = cut[f].border_error + CurveError(part, part.faces[f]);
    double volume = 0.0;
    for (std::size_t k = 0; k < cut[f].nets.size(); ++k) {
      Patch patch{PatchIdOf(named, cut[f].nets.size(), k),
                  PatchOf(cut[f].nets[k], part.faces[f].reversed, quantum), FaceId(f)};
      const PatchFigures figures =
          FiguresOf([&patch](double u, double v) { return Evaluate(patch.shape, u, v); }, box.Center());
      face.area += figures.area;
      volume += figures.volume;
      result.model.patches.push_back(std::move(patch));
    }
    // The border may be off by as much, all along.
    const double length = BorderLength(part.faces[f], curves);
    // The file's area is that within its own curves on the surface; the patches end at its edges in space.
    const GridTrace* trace = traced[f].grid();
    const double beside = trace == nullptr ? 0.0 : trace->border.area_beside;
    const double slack = 1e-3 + cut[f].dropped_area + beside + length * (face.border_error + face.gap);
    const JudgedArea judged{part.faces[f].area, slack, length};
    for (Diagnostic& finding : FaceFindings(named, face, cut[f], judged, params)) {
      result.findings.push_back(std::move(finding));
    }
    for (Diagnostic& finding : GapFindings(named, face, largest_gap, params.border_tolerance)) {
      result.findings.push_back(std::move(finding));
    }
    if (face.patch_count == 0 && !judged.IsNeedle(params.border_tolerance)) volumes.Lose(part.faces[f]);
    volumes.Add(part.faces[f], face, volume, slack, 0.5 * size);
    result.largest_gap = std::max(result.largest_gap, face.gap);
    result.border_error = std::max(result.border_error, face.border_error);
    result.surface_error = std::max(result.surface_error, face.surface_error);
    result.faces.push_back(std::move(face));
  }
  result.model.join_tolerance = JoinTolerance(result.largest_gap + result.border_error, size);
  for (Diagnostic& finding : volumes.Findings(part.bodies)) result.findings.push_back(std::move(finding));
  for (Diagnostic& finding : ApproximatedSurfaces(result)) result.findings.push_back(std::move(finding));
  return result;
}

}  // namespace

absl::StatusOr<TrimmedModel> TrimFaces(const BrepModel& part, const TrimParams& params,
                                       const RunContext& run) {
  EdgeCurveTable curves;
  for (const BrepEdge& edge : part.edges) {
    curves.push_back(edge.degenerate || edge.curve.points.empty() ? SpannedCurve{} : SpansOf(edge.curve));
  }
  std::vector<TracedFace> traced(part.faces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "trim.trace", traced.size(), [&](std::size_t f) {
    traced[f] = IsSkipped(params, f) ? TracedFace{absl::FailedPreconditionError("it is skipped"), {}}
                                     : TraceFace(part.faces[f], curves, run);
  }));
  const UsesOfEdges uses = UsesOf(part);
  std::vector<FittedEdge> edges(part.edges.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "trim.fit", edges.size(), [&](std::size_t e) {
    edges[e] = FitOne(part.edges[e], curves[e], uses[e], traced, params.border_tolerance, run);
  }));
  const std::vector<GraphsOfUses> graphs = GraphsOfFaces(part, std::move(edges));
  std::vector<CutOutcome> cut(part.faces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "trim.cut", cut.size(), [&](std::size_t f) {
    cut[f] = CutOne(traced[f], graphs[f], params.border_tolerance, run);
  }));
  return Join(part, curves, traced, cut, params);
}

}  // namespace patchmill
