#include "core/lines/flow_lines.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "core/lines/flow_step.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kNear = 0.5;       // share of the spacing; lines end this near to others
constexpr double kShortest = 0.5;   // share of the spacing; shorter lines are left out
constexpr double kLongest = 100.0;  // in diagonals of the box
constexpr int kMostBorders = 100;   // less than a whole step apart: such a line makes no progress

// Points of all lines, in cells as large as the spacing.
class Neighbors {
 public:
  explicit Neighbors(const FlowParams& params)
      : spacing_(params.spacing), least_align_(params.kind == FlowKind::kAlongCurvature ? 0.7071 : -1.0) {}

  void Add(const FlowPlace& place) { cells_[Key(place.at.p)].push_back(place); }

  // True if a point of a line on the same side of the surface is nearer than `distance` <= spacing to
  // place.at.p. Of lines of curvature, only those of the same family count.
  bool Any(const FlowPlace& place, double distance) const {
    const Vec3& p = place.at.p;
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        for (int k = -1; k <= 1; ++k) {
          const auto cell = cells_.find(Key(p + spacing_ * Vec3(i, j, k)));
          if (cell == cells_.end()) continue;
          for (const FlowPlace& other : cell->second) {
            if ((other.at.p - p).squaredNorm() < distance * distance &&
                other.normal.dot(place.normal) > 0.0 &&
                std::abs(other.tangent.dot(place.tangent)) > least_align_) {
              return true;
            }
          }
        }
      }
    }
    return false;
  }

 private:
  std::uint64_t Key(const Vec3& p) const {
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k) {
      const auto cell = static_cast<std::int64_t>(std::floor(p[k] / spacing_));
      key = key * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(cell);
    }
    return key;
  }
  double spacing_, least_align_;
  std::unordered_map<std::uint64_t, std::vector<FlowPlace>> cells_;  // looked up, never iterated
};

class FlowTracer {
 public:
  FlowTracer(const Surface& surface, const FlowParams& params, const RunContext& run)
      : surface_(surface), params_(params), run_(run), neighbors_(params) {}

  absl::StatusOr<FlowLines> Run() {
    for (std::size_t k = 0; k < surface_.pieces.size(); ++k) {
      run_.Progress("flow lines", static_cast<double>(k) / static_cast<double>(surface_.pieces.size()));
      const PieceId piece(k);
      const int n = SeedsAcross(surface_.pieces[k]);
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          seeds_.push_back({piece, (i + 0.5) / n, (j + 0.5) / n, Vec3::Zero()});
          while (!seeds_.empty()) {
            const SurfacePoint seed = seeds_.front();
            seeds_.pop_front();
            BeginAll(seed);
            if (run_.Cancelled()) return run_.Check();
            if (point_count_ > params_.max_points) {
              return absl::ResourceExhaustedError(fmt::format(
                  "flow lines: more than {} points; a wider spacing has fewer", params_.max_points));
            }
          }
        }
      }
    }
    return std::move(made_);
  }

 private:
  // About one seed per half spacing.
  int SeedsAcross(const Piece& piece) const {
    double size = 0.0;
    for (const double t : {0.0, 0.5, 1.0}) {
      size = std::max({size,
                       (Position(piece, t, 0.0) - Position(piece, t, 0.5)).norm() +
                           (Position(piece, t, 0.5) - Position(piece, t, 1.0)).norm(),
                       (Position(piece, 0.0, t) - Position(piece, 0.5, t)).norm() +
                           (Position(piece, 0.5, t) - Position(piece, 1.0, t)).norm()});
    }
    return std::clamp(static_cast<int>(std::ceil(2.0 * size / params_.spacing)), 1, 1000);
  }

  // Begins the lines of all families at a seed.
  void BeginAll(const SurfacePoint& seed) {
    const auto start = PlaceOn({surface_, params_, 1.0}, seed.piece, seed.u, seed.v);
    if (!start) return;
    made_.all_singular = false;
    Begin(*start);
    if (params_.kind != FlowKind::kAlongCurvature) return;
    const Vec3 across = start->normal.cross(start->tangent);
    if (const auto other = PlaceOn({surface_, params_, 1.0, across}, seed.piece, seed.u, seed.v)) {
      Begin(*other);
    }
  }

  void Begin(const FlowPlace& start) {
    if (neighbors_.Any(start, params_.spacing)) return;
    const Way up = Follow(start, 1.0);
    std::vector<FlowPlace> line;
    if (!up.closed) {
      FlowPlace back = start;
      back.tangent = -back.tangent;
      line = Follow(back, -1.0).places;
    }
    std::reverse(line.begin(), line.end());
    line.push_back(start);
    line.insert(line.end(), up.places.begin(), up.places.end());
    double length = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) length += (line[i].at.p - line[i - 1].at.p).norm();
    if (length < kShortest * params_.spacing) return;
    ZeroCurve curve;
    curve.closed = up.closed;
    for (const FlowPlace& place : line) {
      neighbors_.Add(place);
      curve.points.push_back(place.at);
    }
    point_count_ += line.size();
    made_.curves.push_back(std::move(curve));
    Seed(line);
  }

  // Adds seeds on both sides of the line, one spacing away.
  void Seed(const std::vector<FlowPlace>& line) {
    double since = kInfinity;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (i > 0) since += (line[i].at.p - line[i - 1].at.p).norm();
      if (since < params_.spacing) continue;
      since = 0.0;
      const Vec3 across = line[i].normal.cross(line[i].tangent);
      for (const double side : {1.001, -1.001}) {
        FlowPlace beside = line[i];
        beside.at.p += side * params_.spacing * across;
        if (neighbors_.Any(beside, 0.9 * params_.spacing)) continue;
        const auto near =
            ClosestToPoint(surface_, beside.at.p, 0.5 * params_.spacing, 0.01 * params_.spacing);
        if (near) seeds_.push_back(near->at);
      }
    }
  }

  struct Way {
    std::vector<FlowPlace> places;  // without the start
    bool closed = false;            // the last place joins the start
  };

  // A line of curvature may come back to places where it has been. Nothing is done for other lines, along
  // which a function grows.
  class OwnWay {
   public:
    OwnWay(const FlowPlace& start, const FlowParams& params)
        : start_(start), params_(params), passed_(params), behind_({{start, 0.0}}) {}

    enum class Meets { kNothing, kStart, kItself };
    // `place` is the next place after `from`, `length` mm from the start.
    Meets Add(const FlowPlace& from, const FlowPlace& place, double length) {
      if (params_.kind != FlowKind::kAlongCurvature) return Meets::kNothing;
      while (!behind_.empty() && behind_.front().second < length - 2.0 * params_.spacing) {
        passed_.Add(behind_.front().first);
        behind_.pop_front();
      }
      behind_.emplace_back(place, length);
      const Vec3 chord = place.at.p - from.at.p, to_start = start_.at.p - from.at.p;
      const double square = chord.squaredNorm();
      const double share = square > 0.0 ? std::clamp(chord.dot(to_start) / square, 0.0, 1.0) : 0.0;
      if (length > 2.0 * params_.spacing && (to_start - share * chord).norm() <= 2.0 * params_.tolerance &&
          place.tangent.dot(start_.tangent) > 0.0) {
        return Meets::kStart;
      }
      return passed_.Any(place, kNear * params_.spacing) ? Meets::kItself : Meets::kNothing;
    }

   private:
    const FlowPlace& start_;
    const FlowParams& params_;
    Neighbors passed_;                                 // places of this line, more than two spacings behind
    std::deque<std::pair<FlowPlace, double>> behind_;  // the others, with their lengths from the start
  };

  Way Follow(const FlowPlace& start, double sign) const {
    Way way;
    std::vector<FlowPlace>& line = way.places;
    OwnWay own(start, params_);
    // The number of places at which the line came beside itself. It may be about to reach its start, so it
    // goes on for one spacing.
    std::optional<std::size_t> beside;
    double beside_length = 0.0;
    FlowPlace at = start;
    double step = 0.1 * params_.spacing, length = 0.0;
    int borders = 0;  // borders met one after the other
    const double longest = kLongest * surface_.box.Diagonal();
    while (length < longest && line.size() <= params_.max_points && !run_.Cancelled()) {
      const auto next = Advance({surface_, params_, sign}, at, &step);
      if (!next) break;
      length += (next->place.at.p - at.at.p).norm();
      if (neighbors_.Any(next->place, kNear * params_.spacing)) break;
      const auto meets = own.Add(at, next->place, length);
      if (meets == OwnWay::Meets::kStart) {
        way.closed = true;
        return way;
      }
      if (meets == OwnWay::Meets::kItself && !beside) {
        beside = line.size();
        beside_length = length;
      }
      if (beside && length > beside_length + params_.spacing) break;
      at = next->place;
      line.push_back(at);
      borders = next->at_border ? borders + 1 : 0;
      if (!next->at_border) continue;
      if (borders > kMostBorders) break;
      const auto beyond = CrossBorder({surface_, params_, sign}, at);
      if (!beyond) break;
      length += (beyond->at.p - at.at.p).norm();
      if (own.Add(at, *beyond, length) == OwnWay::Meets::kStart) {
        way.closed = true;
        return way;
      }
      at = *beyond;
      line.push_back(at);
    }
    if (beside) line.resize(*beside);
    return way;
  }

  const Surface& surface_;
  const FlowParams& params_;
  const RunContext& run_;
  Neighbors neighbors_;
  std::deque<SurfacePoint> seeds_;
  FlowLines made_;
  std::size_t point_count_ = 0;
};

}  // namespace

absl::StatusOr<FlowLines> TraceFlowLines(const Surface& surface, const FlowParams& params,
                                         const RunContext& run) {
  if (!(params.spacing > 0.0) || !(params.tolerance > 0.0)) {
    return absl::InvalidArgumentError("flow lines: spacing and tolerance must be > 0");
  }
  return FlowTracer(surface, params, run).Run();
}

}  // namespace patchmill
