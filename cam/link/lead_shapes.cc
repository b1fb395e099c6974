#include "cam/link/lead_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace patchmill {
namespace {

constexpr double kBesideWallSlope = Radians(50.0);
constexpr std::array<double, 5> kRadii = {1.0, 0.7, 0.5, 0.35, 0.25};  // parts of the radius
constexpr std::array<double, 3> kSweeps = {1.0, 0.7, 0.45};            // parts of the sweep
constexpr double kMostLegs = 5.0;                                      // of a ramp

// The part of v across `along`, unit length; zero if v is nearly along it.
Vec3 Across(const Vec3& v, const Vec3& along) {
  const Vec3 across = v - v.dot(along) * along;
  const double length = across.norm();
  return length > 0.2 ? Vec3(across / length) : Vec3(Vec3::Zero());
}

// Directions from the end of the pass to the centres of arcs, the best first.
std::vector<Vec3> CenterDirections(const LeadPlace& place) {
  const Vec3 &normal = place.normal, &along = place.outwards;
  const Vec3 up = Across(Vec3::UnitZ(), along), off = Across(normal, along);
  const Vec3 level = Across(Lift(Xy(normal), 0.0), along);
  const Vec3 aslant = (off + up).norm() > 1e-3 ? Vec3((off + up).normalized()) : off;
  const Vec3 side = Across(along.cross(Vec3::UnitZ()), along);
  std::vector<Vec3> directions;
  const auto add = [&](const Vec3& d) {
    if (d.isZero()) return;
    const bool known =
        std::any_of(directions.begin(), directions.end(), [&](const Vec3& k) { return k.dot(d) > 0.999; });
    if (!known) directions.push_back(d);
  };
  if (place.steep) {
    for (const Vec3& d : {level, off, aslant, up}) add(d);
  } else {
    for (const Vec3& d : {up, off, aslant}) add(d);
    if (level.dot(side) < 0.0) {
      add(-side);
      add(side);
    } else {
      add(side);
      add(-side);
    }
  }
  return directions;
}

}  // namespace

Vec3 NormalAt(const CutterPoint& point) {
  Vec3 sum = Vec3::Zero();
  for (const auto& contact : {point.contact, point.other_contact}) {
    if (contact) sum += (point.center - contact->p).normalized();
  }
  return sum.norm() > 1e-3 ? Vec3(sum.normalized()) : Vec3(Vec3::UnitZ());
}

bool IsSteep(const Vec3& normal) { return std::acos(std::clamp(normal.z(), -1.0, 1.0)) >= kBesideWallSlope; }

bool IsSteepContact(const CutterPoint& point) {
  return point.contact && IsSteep((point.center - point.contact->p).normalized());
}

std::optional<LeadPlace> PlaceOf(const PassEnd& end) {
  const Vec3 along = end.Along();
  if (along.isZero()) return std::nullopt;
  return LeadPlace{end.center(), NormalAt(end.point()), end.is_start() ? Vec3(-along) : along,
                   IsSteepContact(end.point())};
}

std::vector<LeadArc> LeadArcs(const LeadPlace& place, const LeadParams& params, double sagitta) {
  std::vector<LeadArc> arcs;
  const std::vector<Vec3> directions = CenterDirections(place);
  for (const double part : kRadii) {
    const double radius = part * params.radius;
    if (radius < std::min(kLeastLeadRadius, params.radius)) break;
    for (const double share : kSweeps) {
      const double sweep = share * params.sweep;
      const double step = 2.0 * std::acos(1.0 - std::min(sagitta / radius, 0.5));
      const int chords = std::max(2, static_cast<int>(std::ceil(sweep / step)));
      for (const Vec3& to_center : directions) {
        LeadArc arc{radius, sweep, {place.center}};
        for (int k = 1; k <= chords; ++k) {
          const double angle = sweep * k / chords;
          arc.places.push_back(place.center + radius * (std::sin(angle) * place.outwards +
                                                        (1.0 - std::cos(angle)) * to_center));
        }
        arcs.push_back(std::move(arc));
      }
    }
  }
  return arcs;
}

std::vector<Vec3> RampAlong(const PassEnd& start, const LeadParams& params, double height) {
  const double way = height / std::tan(params.ramp_angle);
  const std::vector<Vec3> base = start.Inwards(way);
  double length = 0.0;
  for (std::size_t k = 1; k < base.size(); ++k) length += (base[k] - base[k - 1]).norm();
  const double legs = length > 0.0 ? std::max(1.0, std::ceil(way / length - 1e-9)) : kInfinity;
  if (legs > kMostLegs) return {};
  // From the start of the pass outwards: back and forth, rising.
  std::vector<Vec3> ramp = {base.front()};
  double gone = 0.0;
  for (int leg = 0; leg < static_cast<int>(legs); ++leg) {
    for (std::size_t k = 1; k < base.size(); ++k) {
      const Vec3& from = leg % 2 == 0 ? base[k - 1] : base[base.size() - k];
      const Vec3& to = leg % 2 == 0 ? base[k] : base[base.size() - 1 - k];
      gone += (to - from).norm();
      ramp.push_back(to + Vec3(0.0, 0.0, height * gone / (legs * length)));
    }
  }
  std::reverse(ramp.begin(), ramp.end());
  return ramp;
}

}  // namespace patchmill
