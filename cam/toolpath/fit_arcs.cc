#include "cam/toolpath/fit_arcs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace patchmill {
namespace {

constexpr std::size_t kMostJoined = 1 << 16;  // moves that become one
constexpr double kLeastChord = 0.01;          // mm, between the ends of an arc that is not a full circle
constexpr double kFlat = 1e-6;                // mm; a lower arc is straight
constexpr double kSame = 1e-9;                // mm; places that are nearer are the same
constexpr double kMostTurn = kPi + 1e-3;      // rad, of an arc that is not a full circle

bool StaysStraight(const Move& move, const ArcFit& fit) {
  const auto pass = static_cast<std::size_t>(move.pass);  // none: beyond all
  return pass < fit.straight_passes.size() && fit.straight_passes[pass];
}

bool MayBecomeOne(const Move& a, const Move& b, const ArcFit& fit) {
  return a.kind == fit.kind && b.kind == fit.kind && a.feed == b.feed && a.pass == b.pass &&
         a.region == b.region && !a.arc && !b.arc && !StaysStraight(a, fit);
}

struct Range {
  double low = -kInfinity, high = kInfinity;
};

// Moves that may become one, and the search for those that do.
class CutRun {
 public:
  CutRun(const Vec3& start, const std::vector<Move>& moves, std::size_t first, std::size_t count,
         const ArcFit& fit)
      : fit_(fit), fast_(moves[first].feed > fit.plunge_feed) {
    places_.reserve(count + 1);
    normals_.reserve(count + 1);
    places_.push_back(start);
    normals_.push_back(Vec3::Zero());
    for (std::size_t k = first; k < first + count; ++k) {
      places_.push_back(moves[k].to);
      normals_.push_back(moves[k].contact ? (moves[k].to - moves[k].contact->p).normalized() : Vec3::Zero());
    }
  }

  struct Piece {
    std::size_t to = 0;  // index of the place where it ends; 0 is where the run begins
    std::optional<Arc> arc;
  };
  std::vector<Piece> Pieces() const {
    const std::size_t last = places_.size() - 1;
    if (last >= 4 && last <= kMostJoined && (places_[last] - places_[0]).norm() <= kSame) {
      for (const ArcPlane plane : Enumerators<ArcPlane>()) {
        if (!fit_.planes[plane]) continue;
        if (const auto circle = FullCircle(plane)) return {{last, circle}};
      }
    }
    std::vector<Piece> pieces;
    for (std::size_t from = 0; from < last; from = pieces.back().to) pieces.push_back(Longest(from));
    return pieces;
  }

 private:
  Piece Longest(std::size_t from) const {
    Piece best;
    best.to = Farthest(from, 1, [&](std::size_t to) { return IsStraight(from, to); });
    for (const ArcPlane plane : Enumerators<ArcPlane>()) {
      if (!fit_.planes[plane] || from + 2 >= places_.size() || !ArcTo(from, from + 2, plane)) continue;
      const std::size_t to =
          Farthest(from, 2, [&](std::size_t end) { return ArcTo(from, end, plane).has_value(); });
      if (to > best.to) best = {to, ArcTo(from, to, plane)};
    }
    return best;
  }

  // A far place to which one move goes: steps are doubled while it does, then halved.
  template <class Fits>
  std::size_t Farthest(std::size_t from, std::size_t least, const Fits& fits) const {
    std::size_t to = from + least, step = 1;
    const auto further = [&] {
      return to + step < places_.size() && to + step - from <= kMostJoined && fits(to + step);
    };
    for (; further(); step *= 2) to += step;
    for (; step >= 1; step /= 2) {
      if (further()) to += step;
    }
    return to;
  }

  // True if the place k may be left out for one that is `moved` away from it.
  bool MayMove(std::size_t k, const Vec3& moved) const {
    return moved.norm() <= fit_.budget && moved.dot(normals_[k]) >= -fit_.into_surface;
  }

  bool IsStraight(std::size_t from, std::size_t to) const {
    const Vec3& a = places_[from];
    const Vec3 along = places_[to] - a;
    const double length2 = along.squaredNorm();
    double before = 0.0;
    for (std::size_t k = from + 1; k < to; ++k) {
      const double at = (places_[k] - a).dot(along);
      if (!(at >= before && at <= length2)) return false;
      if (!MayMove(k, a + at / length2 * along - places_[k])) return false;
      before = at;
    }
    return true;
  }

  // The arc from place to place that keeps within the limits, if the search finds one.
  std::optional<Arc> ArcTo(std::size_t from, std::size_t to, ArcPlane plane) const {
    const Vec3 a = ToPlane(plane, places_[from]), b = ToPlane(plane, places_[to]);
    const Vec2 along = Xy(b) - Xy(a);
    const double half = 0.5 * along.norm();
    if (2.0 * half < kLeastChord || (!fit_.helices && std::abs(b.z() - a.z()) > kSame)) return std::nullopt;
    const Vec2 u = along / (2.0 * half), left(-u.y(), u.x()), middle = 0.5 * (Xy(a) + Xy(b));
    // Coordinates along the chord and to its left, from its middle.
    const auto local = [&](const Vec3& place) {
      const Vec2 out = Xy(ToPlane(plane, place)) - middle;
      return Vec2(out.dot(u), out.dot(left));
    };
    Vec2 farthest = Vec2::Zero();
    for (std::size_t k = from + 1; k < to; ++k) {
      const Vec2 p = local(places_[k]);
      if (std::abs(p.y()) > std::abs(farthest.y())) farthest = p;
    }
    if (std::abs(farthest.y()) <= kFlat) return std::nullopt;
    // The centre lies on the perpendicular bisector, `rise` to the left of the middle.
    double rise = (farthest.squaredNorm() - half * half) / (2.0 * farthest.y());
    for (int round = 0; round < 2; ++round) {
      const double radius = std::hypot(half, rise);
      if (!(radius <= 2.0 * fit_.largest_radius)) return std::nullopt;
      Range range, of_places;
      Vec2 before(-half, 0.0);
      for (std::size_t k = from + 1; k <= to; ++k) {
        const Vec2 p = k == to ? Vec2(half, 0.0) : local(places_[k]);
        if (k < to) Narrow(of_places, p, rise, radius, Allowed(k, plane, p, rise, u));
        const Vec2 chord = p - before;
        const double t = (Vec2(0.0, rise) - before).dot(chord) / chord.squaredNorm();
        if (t > 0.0 && t < 1.0) Narrow(range, before + t * chord, rise, radius, {-fit_.budget, fit_.budget});
        before = p;
      }
      const Range both{std::max(range.low, of_places.low), std::min(range.high, of_places.high)};
      if (!(both.low <= both.high)) return std::nullopt;
      // The places lie on the exact path, the chords beside it: so the places decide where they can.
      if (std::isfinite(both.low) && std::isfinite(both.high))
        rise += std::clamp(0.5 * (of_places.low + of_places.high), both.low, both.high);
    }
    const Arc arc{plane, middle + rise * left, farthest.y() > 0.0};
    if (!(std::hypot(half, rise) <= fit_.largest_radius) || !(std::hypot(half, rise) >= kLeastArcRadius))
      return std::nullopt;
    if (Sweep(arc, {places_[from], places_[to]}) > kMostTurn || !Keeps(arc, from, to)) return std::nullopt;
    return arc;
  }

  // By how much the place k may be farther from the centre than the radius, to first order.
  Range Allowed(std::size_t k, ArcPlane plane, const Vec2& p, double rise, const Vec2& u) const {
    Range range{-fit_.budget, fit_.budget};
    const Vec2 out = (p - Vec2(0.0, rise)).normalized();
    const Vec2 radial = out.x() * u + out.y() * Vec2(-u.y(), u.x());
    const double off = Xy(ToPlane(plane, normals_[k])).dot(radial);
    if (off > 0.0) range.high = std::min(range.high, fit_.into_surface / off);
    if (off < 0.0) range.low = std::max(range.low, fit_.into_surface / off);
    return range;
  }

  // Keeps of `range`, changes of `rise`, those with which p is as far from the arc as allowed.
  static void Narrow(Range& range, const Vec2& p, double rise, double radius, const Range& allowed) {
    const double distance = std::hypot(p.x(), p.y() - rise), off = distance - radius;
    const double growth = -(p.y() - rise) / distance - rise / radius;
    if (growth == 0.0) return;
    double low = (allowed.low - off) / growth, high = (allowed.high - off) / growth;
    if (low > high) std::swap(low, high);
    range.low = std::max(range.low, low);
    range.high = std::min(range.high, high);
  }

  // The circle through the first place, by least squares through all others.
  std::optional<Arc> FullCircle(ArcPlane plane) const {
    const Vec3 origin = ToPlane(plane, places_[0]);
    // |p|^2 = 2 c . p + (r^2 - |c|^2), with the last term 0 at the origin.
    Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
    Vec2 right = Vec2::Zero();
    double area = 0.0;
    Vec2 before = Vec2::Zero();
    for (const Vec3& place : places_) {
      const Vec2 p = Xy(ToPlane(plane, place) - origin);
      matrix += p * p.transpose();
      right += 0.5 * p.squaredNorm() * p;
      area += Cross(before, p);
      before = p;
    }
    if (!(std::abs(matrix.determinant()) > 0.0)) return std::nullopt;
    const Vec2 center = matrix.inverse() * right;
    if (!(center.norm() <= fit_.largest_radius) || !(center.norm() >= kLeastArcRadius)) return std::nullopt;
    const Arc arc{plane, Xy(origin) + center, area < 0.0};
    if (!Keeps(arc, 0, places_.size() - 1)) return std::nullopt;
    return arc;
  }

  // True if the arc from place to place keeps within all limits.
  bool Keeps(const Arc& arc, std::size_t from, std::size_t to) const {
    const ArcEnds ends{places_[from], places_[to]};
    const double sweep = Sweep(arc, ends);
    const Vec3 a = ToPlane(arc.plane, ends.from), b = ToPlane(arc.plane, ends.to);
    const double radius = (Xy(a) - arc.center).norm(), climb = (b.z() - a.z()) / sweep;
    const double side = arc.clockwise ? -1.0 : 1.0;
    Vec2 before = Xy(a) - arc.center;
    double turned = 0.0, off_before = 0.0, lag_before = 0.0;
    if (!MayDescend(arc, before, climb)) return false;
    for (std::size_t k = from + 1; k <= to; ++k) {
      const Vec3 p = ToPlane(arc.plane, places_[k]);
      const Vec2 out = Xy(p) - arc.center;
      const double turn = side * std::atan2(Cross(before, out), before.dot(out));
      if (!(turn > 0.0)) return false;
      turned += turn;
      // How far the place is outside of the circle, and ahead of the helix.
      const double off = out.norm() - radius, lag = k == to ? 0.0 : p.z() - a.z() - climb * turned;
      if (k < to) {
        const Vec2 radial = out.normalized();
        if (!MayMove(k, -FromPlane(arc.plane, Vec3(off * radial.x(), off * radial.y(), lag)))) return false;
      }
      if (!MayDescend(arc, out, climb)) return false;
      // The chord from the place before: least distance from the axis, and the helix is not straight in it.
      const Vec2 chord = out - before;
      const double t = -before.dot(chord) / chord.squaredNorm();
      const double nearest = t > 0.0 && t < 1.0 ? (before + t * chord).norm() - radius : off;
      const double most = std::max({std::abs(nearest), std::abs(off), std::abs(off_before)});
      const double bend = 0.02 * std::abs(climb) * turn * turn * turn;
      if (!(std::hypot(most, std::max(std::abs(lag), std::abs(lag_before)) + bend) <= fit_.budget))
        return false;
      before = out;
      off_before = off;
      lag_before = lag;
    }
    return std::abs(turned - sweep) < 1e-6 && StaysAbove(arc, ends);
  }

  bool StaysAbove(const Arc& arc, const ArcEnds& ends) const {
    if (arc.plane == ArcPlane::kXy) return true;  // it is nowhere lower than an end of it
    double low = std::min(ends.from.z(), ends.to.z());
    for (const Vec3& place : TurningPlaces(arc, ends)) low = std::min(low, place.z());
    return low >= fit_.lowest + kAboveLowest;
  }

  // True if the arc may go on from the place `out` off its centre as it does there. `climb` is mm of the
  // third axis for each radian.
  bool MayDescend(const Arc& arc, const Vec2& out, double climb) const {
    if (!fast_) return true;
    const double side = arc.clockwise ? -1.0 : 1.0;
    const Vec3 way = FromPlane(arc.plane, Vec3(-side * out.y(), side * out.x(), climb));
    return std::atan2(-way.z(), Xy(way).norm()) <= fit_.plunge_angle;
  }

  const ArcFit& fit_;
  bool fast_;
  std::vector<Vec3> places_;
  std::vector<Vec3> normals_;  // away from the surface; zero where nothing is touched
};

}  // namespace

Toolpath FitArcs(Toolpath toolpath, const ArcFit& fit) {
  const std::vector<Move>& moves = toolpath.moves;
  std::vector<Move> fewer;
  for (std::size_t first = 0; first < moves.size();) {
    std::size_t count = 1;
    while (first + count < moves.size() && MayBecomeOne(moves[first], moves[first + count], fit)) ++count;
    if (first == 0 || count == 1) {
      fewer.insert(fewer.end(), moves.begin() + static_cast<std::ptrdiff_t>(first),
                   moves.begin() + static_cast<std::ptrdiff_t>(first + count));
    } else {
      const CutRun run(fewer.back().to, moves, first, count, fit);
      for (const CutRun::Piece& piece : run.Pieces()) {
        fewer.push_back(moves[first + piece.to - 1]);
        fewer.back().arc = piece.arc;
      }
    }
    first += count;
  }
  toolpath.moves = std::move(fewer);
  return toolpath;
}

}  // namespace patchmill
