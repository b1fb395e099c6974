#include "cam/region/reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cam/location/heights.h"
#include "core/diffgeo/forms.h"
#include "core/surface/closest.h"

namespace patchmill {

namespace {

// The constants of docs/reach.md.
constexpr double kVertical = 1e-6;    // |e_z| below this: no side is the upper one
constexpr double kNearer = 0.02;      // of the radius: what blocks above is nearer by this
constexpr double kFloorSlack = 1e-6;  // mm

constexpr double kProof = 0.004;  // of the radius: how exactly distances are known here

}  // namespace

bool ReachTest::Free(const Vec3& p, const Vec3& normal) const {
  return free_ball_.Free(p + params_.radius * normal) ||
         (normal.z() < kVertical && free_ball_.Free(p - params_.radius * normal));
}

namespace {

// Signs of balls asked for in turn, neighbours one after the other: what was in the way of the last ones is
// mostly in the way of the next, which then needs no search. What is left goes in packets.
class FreeSigns {
 public:
  FreeSigns(const Locator& ball, std::span<double> signs) : ball_(ball), signs_(signs) {}

  void Ask(std::size_t i, const Vec3& center) {
    for (const Vec3& obstacle : last_) {
      if (!InTheWay(obstacle, center)) continue;
      signs_[i] = -1.0;
      return;
    }
    asked_.push_back(i);
    centers_.push_back(center);
    if (centers_.size() == kPacket) Search();
  }
  void Search() {
    obstacles_.resize(centers_.size());
    FindObstacles(ball_, centers_, obstacles_);
    for (std::size_t k = 0; k < asked_.size(); ++k) {
      signs_[asked_[k]] = obstacles_[k] ? -1.0 : 1.0;
      if (obstacles_[k]) last_[next_++ % last_.size()] = *obstacles_[k];
    }
    asked_.clear();
    centers_.clear();
  }

 private:
  static constexpr std::size_t kPacket = 8, kRemembered = 8;

  // Deeper in the ball, or in its way upwards, than rounding.
  bool InTheWay(const Vec3& p, const Vec3& center) const {
    const double r2 = ball_.radius() * ball_.radius() * (1.0 - kRounding);
    const Vec3 d = p - center;
    return Plan(d).squaredNorm() + (d.z() < 0.0 ? d.z() * d.z() : 0.0) < r2;
  }

  static constexpr double kRounding = 1e-9;
  const Locator& ball_;
  std::span<double> signs_;
  std::array<Vec3, kRemembered> last_ = Nowhere();
  std::size_t next_ = 0;
  std::vector<std::size_t> asked_;
  std::vector<Vec3> centers_;
  std::vector<std::optional<Vec3>> obstacles_;

  static std::array<Vec3, kRemembered> Nowhere() {
    std::array<Vec3, kRemembered> nowhere;
    nowhere.fill(Vec3::Constant(kInfinity));
    return nowhere;
  }
};

}  // namespace

void ReachTest::FreeAt(std::span<const SurfaceJet> jets, std::span<double> signs) const {
  std::fill(signs.begin(), signs.end(), 0.0);
  const auto ask = [&](const auto& wanted, double side) {
    FreeSigns free(free_ball_, signs);
    for (std::size_t i = 0; i < jets.size(); ++i) {
      const auto normal = UpwardNormal(jets[i]);
      if (normal && wanted(i, *normal)) free.Ask(i, jets[i].p + side * params_.radius * *normal);
    }
    free.Search();
  };
  ask([](std::size_t, const Vec3&) { return true; }, 1.0);
  ask([&](std::size_t i, const Vec3& n) { return signs[i] < 0.0 && n.z() < kVertical; }, -1.0);
}

bool ReachTest::BlockedAbove(const Vec3& p, const Vec3& normal) const {
  return CenterBlockedAbove(p + params_.radius * normal) &&
         (normal.z() >= kVertical || CenterBlockedAbove(p - params_.radius * normal));
}

bool ReachTest::Allowed(const Vec3& p, const Vec3& normal) const {
  if (params_.keep_in == nullptr) return true;
  return params_.keep_in->Allows(p + params_.radius * normal) ||
         (normal.z() < kVertical && params_.keep_in->Allows(p - params_.radius * normal));
}

double ReachTest::OverFloor(const Vec3& p, const Vec3& normal) const {
  return p.z() + params_.radius * (normal.z() - 1.0) - (params_.floor_z - kFloorSlack);
}

bool ReachTest::CenterBlockedAbove(const Vec3& center) const {
  const Surface& surface = free_ball_.surface();
  const double proof = kProof * params_.radius;
  const auto shank = ClosestToUpwardRay(surface, center, free_ball_.radius() + proof, proof);
  return shank && shank->at.p.z() > center.z() &&
         !ClosestToPoint(surface, center, shank->distance + kNearer * params_.radius, proof);
}

double ReachTest::LeftoverAbove(const Vec3& p) const {
  const auto above = free_ball_.Height(Plan(p));
  if (!above) return 0.0;
  const double center = std::max(above->z, params_.floor_z + params_.radius);
  return std::max(0.0, center - p.z() - params_.radius);
}

double LargestFreeRadius(const Surface& surface, const Vec3& p, const Vec3& normal, double limit,
                         double tolerance) {
  double low = 0.0, high = limit;
  for (int i = 0; i < 12; ++i) {
    const double r = 0.5 * (low + high);
    const bool free =
        r <= tolerance || !AnythingNearUpwardRay(surface, p + r * normal, r - tolerance, 0.1 * tolerance);
    (free ? low : high) = r;
  }
  return low;
}

}  // namespace patchmill
