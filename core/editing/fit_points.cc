#include "core/editing/fit_points.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/QR>
#include <fmt/format.h>

#include "core/base/index.h"
#include "core/base/status.h"
#include "core/editing/move_vertex.h"
#include "core/editing/reach_points.h"
#include "core/joining/join_network.h"

namespace patchmill {
namespace {

absl::Status Error(const std::string& field, const std::string& text) {
  return absl::InvalidArgumentError(field + " " + text);
}

// A way in which the network may change. One unit is about one unit of length at the surface.
struct Unknown {
  enum class Kind { kVertex, kNormal, kMiddle };
  Kind kind = Kind::kVertex;
  int index = 0;             // vertex or face
  Vec3 axis = Vec3::Zero();  // the way of one unit; of a normal the change of its unit vector
};

// Where a point meets the surface.
struct Foot {
  int face = 0;
  Vec2 place = Vec2::Zero();
  Vec3 p = Vec3::Zero(), normal = Vec3::Zero();
};

bool IsQuad(const NetworkFace& face) { return face.vertices.size() == 4 && face.cuts.empty(); }

class Fitter {
 public:
  Fitter(const PointFit& fit, const std::string& at, const RunContext& run, CurveNetwork& network)
      : fit_(fit), at_(at), run_(run), network_(network) {}

  absl::StatusOr<std::vector<ReachedGoal>> Run() {
    constexpr int kSteps = 20;
    PM_RETURN_IF_ERROR(Check());
    PM_ASSIGN_OR_RETURN(JoinedNetwork joined, Join(network_));
    PM_ASSIGN_OR_RETURN(std::vector<Foot> feet, FeetOn(joined));
    PM_ASSIGN_OR_RETURN(const std::vector<Unknown> unknowns, Unknowns(joined, feet));
    double left = Excess(feet).norm();
    for (int k = 0; k < kSteps && left > 1e-12 * size_; ++k) {
      const double step = 1e-5 * size_;
      const auto rows = static_cast<Eigen::Index>(feet.size());
      Eigen::MatrixXd slopes(rows, static_cast<Eigen::Index>(unknowns.size()));
      for (std::size_t c = 0; c < unknowns.size(); ++c) {
        CurveNetwork moved = network_;
        Move(unknowns[c], step, moved);
        PM_ASSIGN_OR_RETURN(const JoinedNetwork there, Join(moved));
        for (std::size_t r = 0; r < feet.size(); ++r) {
          const Foot& foot = feet[r];
          const Vec3 p = Position(there.model.patches[At(foot.face)].shape, foot.place.x(), foot.place.y());
          slopes(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
              (p - foot.p).dot(foot.normal) / step;
        }
      }
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
      solver.setThreshold(1e-6);  // the slopes are no better
      const Eigen::VectorXd by = solver.compute(slopes).solve(Excess(feet));
      bool better = false;
      for (double part = 1.0; part > 1e-2 && !better; part *= 0.5) {
        CurveNetwork moved = network_;
        for (std::size_t c = 0; c < unknowns.size(); ++c) {
          Move(unknowns[c], part * by[static_cast<Eigen::Index>(c)], moved);
        }
        absl::StatusOr<JoinedNetwork> there = Join(moved);
        if (absl::IsInvalidArgument(there.status())) continue;  // too far: the faces fold
        PM_RETURN_IF_ERROR(there.status());
        PM_ASSIGN_OR_RETURN(std::vector<Foot> next, FeetOn(*there));
        const double after = Excess(next).norm();
        better = after < 0.999 * left;
        if (better) network_ = std::move(moved), feet = std::move(next), left = after;
      }
      if (!better) break;
    }
    std::vector<ReachedGoal> reached;
    for (std::size_t k = 0; k < feet.size(); ++k) {
      ReachedGoal& to = reached.emplace_back();
      to.kind = GoalKind::kFit, to.goal = static_cast<int>(k), to.place = feet[k].place;
      to.target = fit_.points[k], to.reached = feet[k].p;
      to.distance = (to.target - to.reached).norm();
      to.missed = to.distance > fit_.band + 1e-9 * size_;
    }
    return reached;
  }

 private:
  absl::Status Check() {
    if (fit_.points.empty()) return Error(at_ + ".points", "are missing");
    if (fit_.points.size() > kMaxFitPoints) {
      return Error(at_ + ".points", fmt::format("are {}; at most {}", fit_.points.size(), kMaxFitPoints));
    }
    for (std::size_t k = 0; k < fit_.points.size(); ++k) {
      if (!fit_.points[k].allFinite()) return Error(fmt::format("{}.points[{}]", at_, k), "must be finite");
    }
    if (!(fit_.band >= 0.0 && std::isfinite(fit_.band))) {
      return Error(at_ + ".band", fmt::format("= {:g}; must be finite and at least 0", fit_.band));
    }
    Box3 box;
    for (const NetworkVertex& vertex : network_.vertices) box.Add(vertex.position);
    size_ = (box.max - box.min).norm();
    if (std::ranges::none_of(network_.faces, IsQuad))
      return Error(at_, "needs faces of four sides without cuts");
    return absl::OkStatus();
  }

  absl::StatusOr<JoinedNetwork> Join(const CurveNetwork& network) const {
    PM_ASSIGN_OR_RETURN(JoinedNetwork joined, JoinNetwork(network, run_));
    if (!joined.model.patches.empty()) return joined;
    return Error(at_, "asks for the surface, which cannot be made: " + joined.findings.front().message);
  }

  // The nearest places on quads. A coarse grid tells the three faces that are asked.
  absl::StatusOr<std::vector<Foot>> FeetOn(const JoinedNetwork& joined) const {
    constexpr int kGrid = 6;
    constexpr std::size_t kAsked = 3;
    std::vector<std::pair<int, Vec3>> grid;
    for (std::size_t f = 0; f < network_.faces.size(); ++f) {
      if (!IsQuad(network_.faces[f])) continue;
      for (int i = 0; i <= kGrid; ++i) {
        for (int j = 0; j <= kGrid; ++j) {
          const double u = static_cast<double>(i) / kGrid, v = static_cast<double>(j) / kGrid;
          grid.emplace_back(static_cast<int>(f), Position(joined.model.patches[f].shape, u, v));
        }
      }
    }
    std::vector<Foot> feet;
    for (const Vec3& point : fit_.points) {
      PM_RETURN_IF_ERROR(run_.Check());
      std::vector<std::pair<double, int>> near;  // the best of each face
      for (const auto& [face, p] : grid) {
        const double d = (p - point).squaredNorm();
        if (near.empty() || near.back().second != face) near.emplace_back(d, face);
        near.back().first = std::min(near.back().first, d);
      }
      std::ranges::sort(near);
      Foot best;
      double least = kInfinity;
      for (std::size_t k = 0; k < std::min(kAsked, near.size()); ++k) {
        const PatchShape& shape = joined.model.patches[At(near[k].second)].shape;
        const Vec2 place = NearestPlace(shape, point);
        const SurfaceJet s = Evaluate(shape, place.x(), place.y());
        const double d = (s.p - point).norm();
        if (!(d < least)) continue;
        least = d;
        const Vec3 normal = s.du.cross(s.dv);
        best = {near[k].second, place, s.p, normal.norm() > 0.0 ? Vec3(normal.normalized()) : Vec3::UnitZ()};
      }
      feet.push_back(best);
    }
    return feet;
  }

  // By how much each point beyond the band has to come nearer, along the normal: a little into the band, so
  // that it does not stop at its edge.
  Eigen::VectorXd Excess(const std::vector<Foot>& feet) const {
    Eigen::VectorXd excess(static_cast<Eigen::Index>(feet.size()));
    for (std::size_t k = 0; k < feet.size(); ++k) {
      const double r = (fit_.points[k] - feet[k].p).dot(feet[k].normal);
      const bool beyond = std::abs(r) > fit_.band;
      excess[static_cast<Eigen::Index>(k)] = beyond ? std::copysign(std::abs(r) - 0.9 * fit_.band, r) : 0.0;
    }
    return excess;
  }

  absl::StatusOr<std::vector<Unknown>> Unknowns(const JoinedNetwork& joined,
                                                const std::vector<Foot>& feet) const {
    std::set<int> faces;
    for (const Foot& foot : feet) faces.insert(foot.face);
    std::vector<Unknown> unknowns;
    std::set<int> done;
    for (const int f : faces) {
      const PatchShape& shape = joined.model.patches[At(f)].shape;
      const double corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      for (int k = 0; k < 4; ++k) {
        const int v = network_.faces[At(f)].vertices[At(k)];
        const NetworkVertex& vertex = network_.vertices[At(v)];
        if (vertex.on_edge || !done.insert(v).second) continue;
        const SurfaceJet s = Evaluate(shape, corners[k][0], corners[k][1]);
        const Vec3 normal = s.du.cross(s.dv).normalized();
        unknowns.push_back({Unknown::Kind::kVertex, v, normal});
        if (!fit_.normals || vertex.normals.size() != 1) continue;
        const Vec3 given = vertex.normals[0].direction.normalized();
        const double length = 0.5 * (s.du.norm() + s.dv.norm());
        const Vec3 first = (s.du - given * given.dot(s.du)).normalized();
        unknowns.push_back({Unknown::Kind::kNormal, v, first / length});
        unknowns.push_back({Unknown::Kind::kNormal, v, given.cross(first) / length});
      }
      if (!fit_.middles) continue;
      const SurfaceJet s = Evaluate(shape, 0.5, 0.5);
      unknowns.push_back({Unknown::Kind::kMiddle, f, s.du.cross(s.dv).normalized()});
    }
    if (unknowns.size() > kMaxFitUnknowns) {
      return Error(at_ + ".points",
                   fmt::format("lie on {} faces, which have {} unknowns; at most {}; fit a part of "
                               "the faces at once",
                               faces.size(), unknowns.size(), kMaxFitUnknowns));
    }
    return unknowns;
  }

  static void Move(const Unknown& unknown, double by, CurveNetwork& network) {
    if (unknown.kind == Unknown::Kind::kVertex) {
      MoveVertexTo(network, unknown.index, network.vertices[At(unknown.index)].position + by * unknown.axis);
    } else if (unknown.kind == Unknown::Kind::kNormal) {
      Vec3& normal = network.vertices[At(unknown.index)].normals[0].direction;
      normal = (normal.normalized() + by * unknown.axis).normalized();
    } else {
      auto& bulges = network.faces[At(unknown.index)].bulges;
      const auto middle =
          std::ranges::find_if(bulges, [](const Bulge& b) { return b.u == 0.5 && b.v == 0.5; });
      if (middle != bulges.end()) {
        middle->by += by * unknown.axis;
      } else {
        bulges.push_back({0.5, 0.5, by * unknown.axis});
      }
    }
  }

  const PointFit& fit_;
  const std::string& at_;
  const RunContext& run_;
  CurveNetwork& network_;
  double size_ = 0.0;
};

}  // namespace

absl::StatusOr<std::vector<ReachedGoal>> FitPoints(const PointFit& fit, const std::string& at,
                                                   const RunContext& run, CurveNetwork& network) {
  return Fitter(fit, at, run, network).Run();
}

}  // namespace patchmill
