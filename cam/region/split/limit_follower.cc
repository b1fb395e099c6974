#include "cam/region/split/limit_follower.h"

#include <algorithm>
#include <cmath>

#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

constexpr double kFreeBand = 0.7;       // of `exact`: distance from the limit where freedom is checked
constexpr double kFreeBandHeld = 0.05;  // the same if the border of its piece holds the obstacle back
constexpr double kWell = 0.05;          // of `exact`: accuracy of an obstacle's limit
constexpr double kSame = 0.1;           // of `exact`: clearance up to which a chord's end is on the limit
constexpr double kGrazing = 0.001;      // mm of clearance per mm; with less the limit is ill-conditioned
constexpr double kFarthest = 0.5;       // shares of `across`: limits farther away are others
constexpr int kMostSteps = 8;           // of the secant method
constexpr int kMostObstacles = 6;       // tried for one chord
constexpr std::size_t kRemembered = 4;  // obstacles before the current one

bool OnPiece(const Vec2& q) { return q.minCoeff() >= 0.0 && q.maxCoeff() <= 1.0; }

}  // namespace

bool LimitFollower::FindObstacle(const Vec2& at, const Vec2& step, double least, double most) {
  for (const double share : {0.0, 0.1, -0.1, 0.5, -0.5}) {
    if (share < least || share > most) continue;
    const SurfaceJet jet = At(at + share * step);
    double sign = 0.0;
    std::optional<SurfacePoint> obstacle;
    reach_->FreeAt({&jet, 1}, {&sign, 1}, {&obstacle, 1});
    if (!obstacle) continue;
    Take(*obstacle);
    return true;
  }
  return false;
}

void LimitFollower::Take(const SurfacePoint& obstacle) {
  if (obstacle_) {
    if (before_.size() < kRemembered) {
      before_.push_back(*obstacle_);
    } else {
      before_[next_++ % kRemembered] = *obstacle_;
    }
  }
  obstacle_.emplace(reach_->surface(), obstacle);
}

RaySlide* LimitFollower::InTheWay(const SurfaceJet& jet) {
  for (RaySlide& obstacle : before_) {
    if (reach_->Slide(obstacle, jet) < 0.0) return &obstacle;
  }
  return nullptr;
}

// Uses the secant method: the clearance is smooth and nearly linear over some hundredths of a mm.
std::optional<LimitFollower::LetGo> LimitFollower::FollowObstacle(const Vec2& at, const Vec2& step,
                                                                  double least, double most, double length) {
  const auto clearance = [&](double t) { return reach_->Slide(*obstacle_, At(at + t * step)); };
  double t0 = 0.0, g0 = clearance(t0);
  double t1 = std::min(most, exact_ / length);
  for (int k = 0; k < kMostSteps; ++k) {
    const double g1 = clearance(t1);
    const double rate = (g1 - g0) / (t1 - t0);
    if (!(std::abs(rate) > kGrazing * length)) return std::nullopt;
    const double next = std::clamp(t1 - g1 / rate, least, most);
    t0 = t1;
    g0 = g1;
    t1 = next;
    if (std::abs(t1 - t0) * length < kWell * exact_) {
      if (t1 == least || t1 == most) return std::nullopt;
      return LetGo{t1, rate};
    }
  }
  return std::nullopt;
}

bool LimitFollower::Joins(const ZeroSegment& chord) {
  for (const Vec2& end : {chord.from, chord.to}) {
    if (!(std::abs(reach_->Slide(*obstacle_, At(end))) < kSame * exact_)) return false;
  }
  return true;
}

std::optional<double> LimitFollower::Find(const ZeroSegment& chord, const Vec2& across, double least,
                                          double most) {
  const Vec2 at = 0.5 * (chord.from + chord.to);
  const SurfaceJet jet = At(at);
  const auto facing = FacingAt(jet);
  const double length = (across.x() * jet.du + across.y() * jet.dv).norm();
  // An obstacle on one side of a face says nothing about the ball on the other side.
  if (!facing || facing->both || !(length > 0.0)) return std::nullopt;
  // Limits that are farther away belong to other chords.
  least = std::max(least, -kFarthest);
  most = std::min(most, kFarthest);
  // The obstacle of the last chord may belong to another limit.
  const auto touches = [&](const Vec2& end) { return std::abs(reach_->Slide(*obstacle_, At(end))) < exact_; };
  if (obstacle_ && !touches(chord.from) && !touches(chord.to)) obstacle_.reset();
  bool known = obstacle_.has_value();
  if (!known && !FindObstacle(at, across, least, most)) return std::nullopt;
  for (int k = 0; k < kMostObstacles; ++k) {
    std::optional<LetGo> limit = FollowObstacle(at, across, least, most, length);
    if (!limit && known && FindObstacle(at, across, least, most))
      limit = FollowObstacle(at, across, least, most, length);
    known = false;
    if (!limit) break;
    // If the border of its piece holds the obstacle back, the branch may continue beyond the border.
    const double share = obstacle_->held_by() < 0 ? kFreeBand : kFreeBandHeld;
    const double beside = std::copysign(share * exact_ / length, limit->rate);
    const Vec2 blocked_at = at + (limit->share - beside) * across,
               free_at = at + (limit->share + beside) * across;
    if (!OnPiece(blocked_at) || !OnPiece(free_at)) break;
    if (!(reach_->Slide(*obstacle_, At(blocked_at)) < 0.0)) break;
    const SurfaceJet free = At(free_at);
    if (const auto before = InTheWay(free)) {
      std::swap(*obstacle_, *before);
      continue;
    }
    if (k == 0 && Joins(chord)) return limit->share;
    double sign = 0.0;
    std::optional<SurfacePoint> obstacle;
    reach_->FreeAt({&free, 1}, {&sign, 1}, {&obstacle, 1});
    if (sign > 0.0) return limit->share;
    if (!obstacle) break;
    Take(*obstacle);
  }
  obstacle_.reset();
  return std::nullopt;
}

}  // namespace patchmill
