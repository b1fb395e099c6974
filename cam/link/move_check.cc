#include "cam/link/move_check.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cam/location/contact_points.h"
#include "cam/path/edge/limits_clip.h"
#include "cam/path/stepover/step_over.h"

namespace patchmill {
namespace {

// In chord tolerances: gouge that short links may have. Each is proven by itself, so the certificates' share
// of the tolerance is free.
constexpr double kProven = 1.2;
// In R: places of the surface that are farther than the nearest one by this still count as touched.
constexpr double kCornerOffset = 0.04;
constexpr double kFloorSlack = 1e-7;  // mm; rounding
constexpr double kDepthStep = 0.02;   // in R: how far apart the depths of a cut are compared
constexpr double kFineRapid = 0.1;    // mm; accuracy of the height of a low rapid

}  // namespace

MoveCheck::MoveCheck(const Locator& locator, const Locator& stock_locator, const LinkParams& params)
    : locator_(locator),
      stock_locator_(stock_locator),
      params_(params),
      // [location T2]: between two free centres this far apart a straight move gouges at most the chord
      // tolerance.
      t2_length_(2.0 *
                 std::sqrt(std::max(0.0, 2.0 * locator.radius() * params.pass.chord_tolerance -
                                             params.pass.chord_tolerance * params.pass.chord_tolerance))),
      overrun_(kOverrun * CenterStep(locator.radius(), params.pass.scallop, 0.0)) {}

double MoveCheck::StockRoom() const {
  return std::max(params_.radius, params_.tool_radius) + params_.approach_gap + params_.stock->accuracy();
}

double MoveCheck::AboveStockSolid(const Vec2& a, const Vec2& b) const {
  if (params_.stock == nullptr) return -kInfinity;
  return params_.stock->TopNear(a, b, StockRoom()) + params_.approach_gap + params_.radius;
}

bool MoveCheck::ClearOfStockSolid(const Vec3& a, const Vec3& b, double gap) const {
  if (params_.stock == nullptr) return true;
  const double room = std::max(params_.radius, params_.tool_radius) + gap;
  return !params_.stock->SegmentComesNearer(a, b, room);
}

Move MoveCheck::Feed(MoveKind kind, const Vec3& from, const Vec3& to) const {
  const Vec3 d = to - from;
  const double across = Xy(d).norm();
  const bool steep_descent = d.z() < 0.0 && std::atan2(-d.z(), across) > params_.plunge_angle;
  Move move;
  move.kind = kind;
  move.to = to;
  move.feed = params_.feed;
  if (kind == MoveKind::kLink) move.feed = params_.link_feed.value_or(params_.feed);
  if (kind == MoveKind::kLead) move.feed = params_.lead_feed.value_or(params_.feed);
  if (steep_descent && !(kind == MoveKind::kCut && params_.keep_feed)) move.feed = params_.plunge_feed;
  return move;
}

Move MoveCheck::AirMove(const Vec3& to) const {
  Move move;
  move.kind = MoveKind::kLink;
  move.to = to;
  move.feed = params_.link_feed.value_or(params_.feed);
  return move;
}

bool MoveCheck::StraightIsFree(const Vec3& a, const Vec3& b) const {
  if (!Allowed(a, b)) return false;
  // Passes in slots and holes that are a little too narrow end at centres that are not free
  // (cam/path/rest/spot_passes). [location T2] does not hold for links from there, so short links are proven,
  // too.
  const double tolerance = params_.pass.chord_tolerance;
  if ((b - a).norm() <= t2_length_) return locator_.GougeWithin(a, b, kProven * tolerance, 0.02 * tolerance);
  return locator_.GougeWithin(a, b, tolerance, 0.1 * tolerance);
}

bool MoveCheck::Allowed(const Vec3& a, const Vec3& b) const {
  const double floor = params_.pass.floor_z + locator_.radius();  // of centres
  if (std::min(a.z(), b.z()) < floor - kFloorSlack) return false;
  if (params_.stock != nullptr) {
    const double allowed = params_.radius - params_.depth_limit.Least() - params_.stock->accuracy();
    if (params_.stock->SegmentComesNearer(a, b, allowed) && CutsTooDeep(a, b)) return false;
  }
  if (params_.operation_limits == nullptr) return true;
  const OperationLimits& operation_limits = *params_.operation_limits;
  if (!operation_limits.AllowsMove(a, b, false)) return false;
  if (operation_limits.WantsAll() && operation_limits.AllowsMove(a, b, true)) return true;
  const int parts = 1 + static_cast<int>((b - a).norm() / (0.5 * overrun_));
  for (int k = 0; k <= parts; ++k) {
    if (!LeavesUnwanted(a + (static_cast<double>(k) / parts) * (b - a))) return false;
  }
  return true;
}

bool MoveCheck::CutsTooDeep(const Vec3& a, const Vec3& b) const {
  if (params_.depth_limit.IsOne()) return true;
  const StockSolid& stock = *params_.stock;
  const int parts = 1 + static_cast<int>((b - a).norm() / (kDepthStep * params_.radius));
  for (int k = 0; k <= parts; ++k) {
    const Vec3 c = a + (static_cast<double>(k) / parts) * (b - a);
    const double limit = stock.DepthAt(c, params_.depth_limit) + stock.accuracy();
    if (params_.radius - stock.Distance(c) > limit) return true;
  }
  return false;
}

bool MoveCheck::LeavesUnwanted(const Vec3& c) const {
  const OperationLimits& operation_limits = *params_.operation_limits;
  const double clear = locator_.radius() + stock_depth();
  const std::vector<SurfacePoint> touched =
      ContactPoints(locator_.surface(), c, clear, kCornerOffset * locator_.radius());
  if (touched.empty() || (touched.front().p - c).norm() >= clear) return true;
  if (!operation_limits.AllowsMove(c, c, true)) return false;  // above the highest tip
  return std::any_of(touched.begin(), touched.end(),
                     [&](const SurfacePoint& place) { return operation_limits.WantsNear(place, overrun_); });
}

bool MoveCheck::ClearOfAllowance(const Vec3& a, const Vec3& b, double slack) const {
  const Vec3 lower(0, 0, params_.allowance.Rise());
  return stock_locator_.GougeWithin(a - lower, b - lower, slack, 0.1 * slack);
}

double MoveCheck::ClearOfStock(const Vec3& place) const {
  const auto top = stock_locator_.Height(Xy(place));
  double clear = top ? std::max(top->z + params_.allowance.Rise(), place.z()) : place.z();
  clear = std::max(clear, AboveStockSolid(Xy(place), Xy(place)));
  return std::min(clear, clearance_center_z());
}

double MoveCheck::ClearOfStockBelow(const UpperCylinder& cylinder, const Vec2& a, const Vec2& b) const {
  // Over everything within the cylinder's radius the ball is at least as high as that.
  const double wider = cylinder.radius - params_.radius;
  double lower_end = std::min(stock_locator_.MaxHeight(a, b, wider, kFineRapid) + params_.allowance.Rise(),
                              params_.stock_top_z + params_.approach_gap);
  const double room = cylinder.radius + params_.approach_gap;
  if (params_.stock != nullptr) {
    const double top = params_.stock->TopNear(a, b, room + params_.stock->accuracy());
    lower_end = std::max(lower_end, top + params_.approach_gap);
  }
  return lower_end - cylinder.rise;
}

double MoveCheck::LowRapidHeight(const Vec3& a, const Vec3& b) const {
  // A wider shank counts as a wider ball if it begins no lower than the ball's centre; params_.shank_lower
  // makes up for a shank that does.
  const double wider = std::max(0.0, params_.tool_radius - params_.radius);
  const double above_all = params_.stock_top_z + params_.approach_gap + params_.radius;
  const double highest = stock_locator_.MaxHeight(Xy(a), Xy(b), wider, kFineRapid) + params_.allowance.Rise();
  double clear = std::min(highest + params_.shank_lower, above_all);
  clear = std::max(clear, AboveStockSolid(Xy(a), Xy(b)));
  for (const UpperCylinder& cylinder : params_.holder)
    clear = std::max(clear, ClearOfStockBelow(cylinder, Xy(a), Xy(b)));
  if (params_.operation_limits != nullptr)
    clear = std::max(clear, params_.operation_limits->ClearHeight(Xy(a), Xy(b)));
  return std::min(std::max({clear, a.z(), b.z()}), clearance_center_z());
}

}  // namespace patchmill
