#include "cam/region/watershed/watershed_lines.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "cam/region/watershed/mesh_cutter.h"
#include "cam/region/watershed/watershed_starts.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kStart = 0.01;           // of the spacing: first step of a flow
constexpr int kMostVertices = 5'000;      // of one line
constexpr int kMostStuck = 100;           // sides of triangles that one line follows for lack of a direction
constexpr int kMostBorders = 10;          // of pieces, met in a row; after more the line counts as stuck
constexpr std::size_t kMostPlaces = 500;  // in the triangles around one vertex; with more it is stuck, too

// Cuts the meshes of a split along lines of one kind. The adjacency of the split is not valid afterwards.
class Cutter {
 public:
  // `sign` is 1 for lines between summits, -1 for lines between pits. Keeps references.
  Cutter(const WatershedParams& params, const FlowParams& flow, double sign, const RunContext& run,
         SplitSurface& split)
      : surface_(*split.surface),
        params_(params),
        flow_(flow),
        sign_(sign),
        run_(run),
        meshes_(split.meshes),
        join_(std::max(2.0 * surface_.network.join_tolerance, 1e-7)) {}

  // Returns true if any mesh was cut.
  absl::StatusOr<bool> Run(std::vector<std::vector<WatershedStart>>& lines) {
    for (std::vector<WatershedStart>& starts : lines) {
      PM_RETURN_IF_ERROR(run_.Check());
      for (WatershedStart& start : starts) Trace(start);
    }
    std::vector<MeshCutter*> cutters;
    for (auto& [piece, cutter] : cutters_) cutters.push_back(&cutter);
    PM_RETURN_IF_ERROR(ParallelFor(run_, "regions: watersheds cut", cutters.size(),
                                   [&](std::size_t k) { cutters[k]->Finish(params_.steep_angle); }));
    return !cutters.empty();
  }

 private:
  const Vec3& PointOf(const MeshVertex& v) const {
    return meshes_[static_cast<std::size_t>(v.piece)].vertices[static_cast<std::size_t>(v.vertex)].p;
  }
  double Height(const MeshVertex& v) const { return sign_ * PointOf(v).z(); }
  MeshCutter& CutterOf(int piece) {
    const auto k = static_cast<std::size_t>(piece);
    return cutters_
        .try_emplace(piece, surface_.pieces[k], meshes_[k], sign_ > 0.0, params_.fields, params_.tolerance)
        .first->second;
  }

  // The vertex of `piece` at the place of `from`, where a line continues in that piece.
  std::optional<MeshVertex> EnterAt(PieceId piece, const MeshVertex& from) {
    if (piece.value == from.piece) return from;
    const auto vertex = CutterOf(piece.value).OnBorder(PointOf(from), join_ + params_.tolerance);
    if (!vertex) return std::nullopt;
    return MeshVertex{piece.value, *vertex};
  }

  // How a stretch of flow ended.
  enum class End { kDone, kStuck };

  void Trace(WatershedStart& start) {
    const auto at = EnterAt(start.piece, start.from);
    if (!at) return;
    MeshVertex here = *at;
    FlowTrack track = std::move(start.track);
    int vertices = 0;
    for (int stuck = 0; stuck < kMostStuck && vertices < kMostVertices && !run_.Cancelled(); ++stuck) {
      if (track.Start() && Follow(here, track, vertices) == End::kDone) return;
      // The flow is stuck here. The line takes the steepest side down and continues from its end.
      const auto next = SteepestSide(here);
      if (!next) return;
      MeshCutter& cutter = CutterOf(here.piece);
      const bool met = cutter.OnLine(*next);
      cutter.Mark(here.vertex, *next, {});
      here.vertex = *next;
      ++vertices;
      if (met) return;
      const ZeroVertex& v =
          meshes_[static_cast<std::size_t>(here.piece)].vertices[static_cast<std::size_t>(here.vertex)];
      track = FlowTrack(
          surface_, flow_, -sign_,
          PlaceOn({surface_, flow_, -sign_}, PieceId(static_cast<std::size_t>(here.piece)), v.u, v.v),
          kStart * params_.spacing);
    }
  }

  std::optional<int> SteepestSide(const MeshVertex& at) {
    std::optional<int> best;
    double steepest = 0.0;
    for (const int n : CutterOf(at.piece).Around(at.vertex)) {
      const MeshVertex next{at.piece, n};
      const double run = (PointOf(next) - PointOf(at)).norm();
      const double slope = run > 0.0 ? (Height(at) - Height(next)) / run : 0.0;
      if (slope > steepest) {
        steepest = slope;
        best = n;
      }
    }
    return best;
  }

  // Follows the flow from its start, in the triangles around the vertex `here`. Moves `here` along.
  End Follow(MeshVertex& here, FlowTrack& track, int& vertices) {
    std::vector<Vec2> places{{track.Start()->at.u, track.Start()->at.v}};
    std::size_t known = 0;
    // Cuts as far as the places lead. True if the line has ended.
    const auto walk = [&] {
      while (const auto next = CutterOf(here.piece).Advance(here.vertex, places, known)) {
        here.vertex = next->vertex;
        if (++vertices > kMostVertices || next->met) return true;
      }
      return false;
    };
    int borders = 0;  // borders of pieces met in a row
    for (std::size_t step = 0; !run_.Cancelled(); ++step) {
      if (walk()) return End::kDone;
      if (places.size() > kMostPlaces || borders > kMostBorders) return End::kStuck;
      const FlowTrack::Step* flow = track.At(step);
      if (flow == nullptr) return End::kStuck;
      const FlowPlace& place = flow->place;
      places.emplace_back(place.at.u, place.at.v);
      borders = flow->at_border ? borders + 1 : 0;
      if (!flow->at_border) continue;
      if (walk()) return End::kDone;
      MeshCutter& cutter = CutterOf(here.piece);
      const auto rim = cutter.OnBorder(place.at.p, params_.tolerance);
      if (!rim) return End::kStuck;
      if (*rim != here.vertex) {
        const std::vector<int> around = cutter.Around(here.vertex);
        if (std::find(around.begin(), around.end(), *rim) == around.end()) return End::kStuck;
        const bool met = cutter.OnLine(*rim);
        places.pop_back();
        cutter.Mark(here.vertex, *rim, std::move(places));
        here.vertex = *rim;
        if (met) return End::kDone;
      }
      const std::optional<FlowPlace>& other = flow->beyond;
      if (!other) {
        const double beyond = 10.0 * join_;
        const auto on =
            ClosestToPoint(surface_, place.at.p + beyond * place.tangent, 0.5 * beyond, 0.1 * beyond);
        return on ? End::kStuck : End::kDone;
      }
      const auto entered = EnterAt(other->at.piece, here);
      if (!entered) return End::kStuck;
      const bool moved = entered->piece != here.piece;
      here = *entered;
      if (moved && CutterOf(here.piece).OnLine(here.vertex)) return End::kDone;
      places = {{other->at.u, other->at.v}};
      known = 0;
    }
    return End::kDone;
  }

  const Surface& surface_;
  const WatershedParams& params_;
  const FlowParams& flow_;
  const double sign_;
  const RunContext& run_;
  std::vector<SplitMesh>& meshes_;
  const double join_;
  std::map<int, MeshCutter> cutters_;  // of the pieces that lines have entered
};

}  // namespace

absl::StatusOr<SplitSurface> CutWatersheds(SplitSurface split, const WatershedPasses& passes,
                                           const WatershedParams& params, const RunContext& run) {
  FlowParams flow;
  flow.spacing = params.spacing;
  flow.tolerance = params.tolerance;
  std::vector<Box3> boxes(split.meshes.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, boxes.size(), [&](std::size_t k) {
    for (const ZeroVertex& v : split.meshes[k].vertices) boxes[k].Add(v.p);
  }));
  // Flows do not depend on each other and are followed in parallel. Lines end where they meet, so they are
  // cut one after the other.
  const std::size_t down = passes.summits.size();
  std::vector<std::vector<WatershedStart>> falls(down), climbs(passes.pits.size());
  PM_RETURN_IF_ERROR(
      ParallelFor(run, "regions: watersheds", falls.size() + climbs.size(), [&](std::size_t k) {
        std::vector<WatershedStart>& starts = k < down ? falls[k] : climbs[k - down];
        starts = FindStarts(split, boxes, flow, k < down ? 1.0 : -1.0,
                            k < down ? passes.summits[k] : passes.pits[k - down]);
        for (WatershedStart& start : starts) start.track.GoAhead(run);
      }));
  PM_ASSIGN_OR_RETURN(const bool summits, Cutter(params, flow, 1.0, run, split).Run(falls));
  PM_ASSIGN_OR_RETURN(const bool pits, Cutter(params, flow, -1.0, run, split).Run(climbs));
  if (!summits && !pits) return split;
  return JoinMeshes(*split.surface, std::move(split.meshes), run);
}

}  // namespace patchmill
