#include "core/editing/reach_points.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <Eigen/QR>
#include <fmt/format.h>

#include "core/base/index.h"
#include "core/base/status.h"
#include "core/patch/bulge.h"

namespace patchmill {
namespace {

constexpr double kSamePlace = 1e-9;  // two places nearer than this are one

// A place that moves, and the vector by which the goal wants it to.
struct Wish {
  GoalKind kind = GoalKind::kPoint;
  int goal = 0;
  Vec2 place = Vec2::Zero();
  Vec3 from = Vec3::Zero(), target = Vec3::Zero();
};

absl::Status Error(const std::string& field, const std::string& text) {
  return absl::InvalidArgumentError(field + " " + text);
}

class Reacher {
 public:
  Reacher(const JoinedNetwork& joined, const std::vector<NetworkFace>& faces, const std::string& at)
      : joined_(joined), faces_(faces), at_(at) {}

  absl::Status Add(const PointGoal& goal, int k) {
    const std::string field = fmt::format("{}.points[{}]", at_, k);
    PM_RETURN_IF_ERROR(CheckFace(goal.face, field));
    if (goal.near && !goal.near->allFinite()) return Error(field + ".near", "must be finite");
    if (goal.to && !goal.to->allFinite()) return Error(field + ".to", "must be finite");
    if (!std::isfinite(goal.distance)) return Error(field + ".distance", "must be finite");
    const PatchShape& shape = Shape(goal.face);
    Vec2 place(goal.u, goal.v);
    if (goal.near) place = NearestPlace(shape, *goal.near);
    for (const double t : {place.x(), place.y()}) {
      if (t >= kMinBulgePlace && t <= 1.0 - kMinBulgePlace) continue;
      return Error(
          field + (goal.near ? ".near" : ".u"),
          fmt::format("gives the place ({:g}, {:g}); both must be in [{:g}, {:g}]; move the edge itself "
                      "for a place nearer to it",
                      place.x(), place.y(), kMinBulgePlace, 1.0 - kMinBulgePlace));
    }
    const SurfaceJet s = Evaluate(shape, place.x(), place.y());
    const Vec3 normal = s.du.cross(s.dv);
    if (!goal.to && !(normal.norm() > 0.0))
      return Error(field, "has no normal there; give the point in `to`");
    const Vec3 target = goal.to ? *goal.to : Vec3(s.p + goal.distance * normal.normalized());
    by_face_[goal.face].push_back({GoalKind::kPoint, k, place, s.p, target});
    return absl::OkStatus();
  }

  absl::Status Add(const FullnessGoal& goal, int k) {
    const std::string field = fmt::format("{}.fullness[{}]", at_, k);
    PM_RETURN_IF_ERROR(CheckFace(goal.face, field));
    if (!std::isfinite(goal.fullness)) return Error(field + ".fullness", "must be finite");
    const PatchShape& shape = Shape(goal.face);
    const auto at = [&shape](double u, double v) { return Position(shape, u, v); };
    const Vec3 corners = 0.25 * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1));
    const Vec3 coons = 0.5 * (at(0.5, 0) + at(0.5, 1) + at(0, 0.5) + at(1, 0.5)) - corners;
    const Vec3 rise = coons - corners;
    if (!(rise.norm() > 1e-9 * Size(goal.face))) {
      return Error(field + ".face",
                   fmt::format("= {}; its edges do not rise from the mean of its corners, so it "
                               "has no fullness; move a point of it",
                               goal.face));
    }
    const Vec3 middle = at(0.5, 0.5), axis = rise.normalized();
    const double now = (middle - corners).dot(axis) / rise.norm();
    by_face_[goal.face].push_back(
        {GoalKind::kFullness, k, Vec2(0.5, 0.5), middle, middle + (goal.fullness - now) * rise});
    return absl::OkStatus();
  }

  absl::StatusOr<std::vector<ReachedGoal>> Solve(std::vector<NetworkFace>& faces) const {
    std::vector<ReachedGoal> reached;
    for (const auto& [face, wishes] : by_face_) {
      std::vector<Vec2> places;
      for (const Wish& wish : wishes) {
        const auto same = [&](const Vec2& p) { return (p - wish.place).norm() < kSamePlace; };
        if (std::ranges::none_of(places, same)) places.push_back(wish.place);
      }
      const auto rows = static_cast<Eigen::Index>(wishes.size()),
                 columns = static_cast<Eigen::Index>(places.size());
      Eigen::MatrixXd weights(rows, columns), moves(rows, 3);
      for (Eigen::Index r = 0; r < rows; ++r) {
        const Wish& wish = wishes[static_cast<std::size_t>(r)];
        for (Eigen::Index c = 0; c < columns; ++c) {
          const Vec2& p = places[static_cast<std::size_t>(c)];
          const bool here = (p - wish.place).norm() < kSamePlace;
          weights(r, c) = here ? 1.0 : BulgeWeight(p.x(), p.y(), wish.place.x(), wish.place.y()).f;
        }
        moves.row(r) = (wish.target - wish.from).transpose();
      }
      const Eigen::MatrixXd by = weights.completeOrthogonalDecomposition().solve(moves);
      std::vector<Bulge>& bulges = faces[At(face)].bulges;
      for (Eigen::Index c = 0; c < columns; ++c) {
        const Vec2& p = places[static_cast<std::size_t>(c)];
        const auto same = [&](const Bulge& b) { return (Vec2(b.u, b.v) - p).norm() < kSamePlace; };
        const auto known = std::ranges::find_if(bulges, same);
        if (known != bulges.end()) {
          known->by += by.row(c).transpose();
        } else {
          bulges.push_back({p.x(), p.y(), by.row(c).transpose()});
        }
      }
      if (bulges.size() > kMaxBulges) {
        return Error(at_,
                     fmt::format("makes {} bulges on face {}; at most {}", bulges.size(), face, kMaxBulges));
      }
      const Eigen::MatrixXd got = weights * by;
      for (Eigen::Index r = 0; r < rows; ++r) {
        const Wish& wish = wishes[static_cast<std::size_t>(r)];
        ReachedGoal& to = reached.emplace_back();
        to.kind = wish.kind, to.goal = wish.goal, to.place = wish.place, to.target = wish.target;
        to.reached = wish.from + got.row(r).transpose();
        to.distance = (to.reached - to.target).norm();
        to.missed = to.distance > kReachedShare * Size(face);
      }
    }
    return reached;
  }

 private:
  const PatchShape& Shape(int face) const { return joined_.model.patches[At(face)].shape; }

  double Size(int face) const {
    const PatchShape& shape = Shape(face);
    return std::max((Position(shape, 1, 1) - Position(shape, 0, 0)).norm(),
                    (Position(shape, 0, 1) - Position(shape, 1, 0)).norm());
  }

  absl::Status CheckFace(int face, const std::string& field) const {
    const int count = static_cast<int>(faces_.size());
    if (face < 0 || face >= count) {
      return Error(field + ".face", fmt::format("= {}; must be in [0, {}]", face, count - 1));
    }
    if (faces_[At(face)].vertices.size() == 4 && faces_[At(face)].cuts.empty()) return absl::OkStatus();
    return Error(field + ".face", fmt::format("= {}; must be a quad without cuts; push_face moves places of "
                                              "triangles",
                                              face));
  }

  const JoinedNetwork& joined_;
  const std::vector<NetworkFace>& faces_;
  const std::string& at_;
  std::map<int, std::vector<Wish>> by_face_;
};

}  // namespace

Vec2 NearestPlace(const PatchShape& quad, const Vec3& p) {
  constexpr int kSteps = 12, kIterations = 40;
  Vec2 best(0.5, 0.5);
  double least = kInfinity;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const Vec2 at(static_cast<double>(i) / kSteps, static_cast<double>(j) / kSteps);
      const double d = (Position(quad, at.x(), at.y()) - p).squaredNorm();
      if (d < least) least = d, best = at;
    }
  }
  for (int k = 0; k < kIterations; ++k) {
    const SurfaceJet s = Evaluate(quad, best.x(), best.y());
    Eigen::Matrix<double, 3, 2> slopes;
    slopes << s.du, s.dv;
    const Vec3 rest = p - s.p;
    Eigen::Matrix2d second;
    second << s.duu.dot(rest), s.duv.dot(rest), s.duv.dot(rest), s.dvv.dot(rest);
    const Eigen::Matrix2d metric = slopes.transpose() * slopes;
    const Vec2 gradient = slopes.transpose() * rest;
    Eigen::Matrix2d newton = metric - second;
    if (!(newton.determinant() > 1e-6 * metric.determinant() && newton.trace() > 0.0)) newton = metric;
    Vec2 step = newton.completeOrthogonalDecomposition().solve(gradient);
    Vec2 next = best;
    for (double part = 1.0; part > 1e-6; part *= 0.5) {  // never farther than before
      next = (best + part * step).cwiseMax(0.0).cwiseMin(1.0);
      const double d = (Position(quad, next.x(), next.y()) - p).squaredNorm();
      if (d <= least) {
        least = d;
        break;
      }
      next = best;
    }
    if ((next - best).norm() < 1e-14) break;
    best = next;
  }
  return best;
}

absl::StatusOr<std::vector<ReachedGoal>> ReachPoints(const Goals& goals, const JoinedNetwork& joined,
                                                     std::vector<NetworkFace>& faces, const std::string& at) {
  Reacher reacher(joined, faces, at);
  for (std::size_t k = 0; k < goals.points.size(); ++k) {
    PM_RETURN_IF_ERROR(reacher.Add(goals.points[k], static_cast<int>(k)));
  }
  for (std::size_t k = 0; k < goals.fullness.size(); ++k) {
    PM_RETURN_IF_ERROR(reacher.Add(goals.fullness[k], static_cast<int>(k)));
  }
  return reacher.Solve(faces);
}

}  // namespace patchmill
