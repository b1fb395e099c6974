#include "cam/path/contour/loop_clip.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cam/path/zlevel/level_oracle.h"
#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

constexpr double kOnSide = 1e-6;     // parameter distance at which a contact lies on a side of its piece
constexpr double kEndPlace = 1e-6;   // mm: accuracy of the ends of a part
constexpr double kWallPlace = 1e-6;  // mm: how far a wall may be from vertical below a contact with the shank
// A ball at an edge touches the face, and does not roll over the edge, if the direction from the contact to
// the centre is the face's normal within these angles: at an open edge (rad), and at a crease (sine).
constexpr double kAtLimit = 1e-5, kOnFace = 1e-4;
// Sine of the angle by which a face must rise towards an open edge, so that the edge is a rim.
constexpr double kRimRise = 0.05;

// Of a place of the loop: kNone if it cannot be part of a pass; kAllowed if it can, but its slope lies
// outside of the window or it is not near a spot; kWanted if it is part of a pass.
enum class Verdict { kNone, kAllowed, kWanted };

class Clipper {
 public:
  Clipper(const LevelContext& context, const CutterPath& loop, const ClipParams& params)
      : context_(context),
        surface_(context.locator.surface()),
        oracle_(context.locator, context.sides, loop.points.front().center.z()),
        loop_(loop),
        params_(params) {
    spots_ = params.spots;
    std::sort(spots_.begin(), spots_.end(), [](const Vec3& a, const Vec3& b) {
      return std::array{a.x(), a.y(), a.z()} < std::array{b.x(), b.y(), b.z()};
    });
  }

  std::vector<CutterPath> Run() {
    const std::size_t n = loop_.points.size();
    for (std::size_t i = 0; i + (loop_.closed ? 0 : 1) < n; ++i)
      AddSegment(loop_.points[i], loop_.points[(i + 1) % n]);
    return Parts();
  }

 private:
  // A stretch of the loop, all of which has one verdict.
  struct Piece {
    CutterPoint from, to;
    Verdict verdict;
  };

  // Returns the surface point on which the ball itself rests, not its shank. This is the contact, if the
  // contact is no higher than the centre. A contact above the centre touches the shank. If it belongs to a
  // vertical wall that goes down to the height of the centre, the ball touches the wall there, and that point
  // is returned. nullopt if the wall ends above the centre.
  std::optional<SurfacePoint> RestsOn(const SurfacePoint& contact) const {
    const double z = oracle_.z();
    if (z - contact.p.z() >= -1e-9 * oracle_.radius()) return contact;
    return WallAt(contact, Lift(Xy(contact.p), z));
  }
  // Returns the unit vector from the contact to the ball's axis over q, to the centre or, if the contact is
  // higher, to the point of the axis at its height.
  Vec3 OffContact(const Vec2& q, const SurfacePoint& contact) const {
    return Lift(Vec2(q - Xy(contact.p)), std::max(0.0, oracle_.z() - contact.p.z())).normalized();
  }

  // Returns the verdict on the place q of the level, for one of the contacts of the ball there.
  Verdict Judge(const Vec2& q, const SurfacePoint& contact) const {
    const std::optional<SurfacePoint> at = RestsOn(contact);
    const Vec3 off = OffContact(q, contact);
    if (!at || BehindWall(*at, off) || !Holds(*at, off)) return Verdict::kNone;
    const double z = oracle_.z();
    const double cosine = std::max(0.0, (z - contact.p.z()) / oracle_.radius());
    const double slope = std::acos(std::min(1.0, cosine));
    if (slope < params_.window.min || slope > params_.window.max + 1e-9) return Verdict::kAllowed;
    return NearSpot(Lift(q, z)) ? Verdict::kWanted : Verdict::kAllowed;
  }

  // Returns the surface point at `place`, on the piece of `contact` or on one that meets it there.
  std::optional<SurfacePoint> WallAt(const SurfacePoint& contact, const Vec3& place) const {
    // Most pieces searched around a contact.
    constexpr std::size_t kMostPieces = 8;
    std::vector<SurfacePoint> starts = {contact};
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const SurfacePoint start = starts[i];
      if (const std::optional<SurfacePoint> wall = Descend(start, place)) return wall;
      const std::array<bool, 4> on = OnSides(start);
      for (int side = 0; side < 4 && starts.size() < kMostPieces; ++side) {
        if (!on[static_cast<std::size_t>(side)]) continue;
        const std::optional<SurfacePoint> next =
            context_.sides.Across(start.piece, side, side % 2 == 0 ? start.u : start.v);
        const bool known = next && std::any_of(starts.begin(), starts.end(),
                                               [&](const SurfacePoint& s) { return s.piece == next->piece; });
        if (next && !known) starts.push_back(*next);
      }
    }
    return std::nullopt;
  }

  static std::array<bool, 4> OnSides(const SurfacePoint& at) {
    return {at.v<kOnSide, at.u> 1.0 - kOnSide, at.v > 1.0 - kOnSide, at.u < kOnSide};
  }

  // Walks by Gauss-Newton steps over the surface from `from` towards `place`, across joints of pieces too.
  // nullopt if the surface does not come within kWallPlace of the place.
  std::optional<SurfacePoint> Descend(SurfacePoint from, const Vec3& place) const {
    // Most Gauss-Newton steps.
    constexpr int kSteps = 60;
    for (int step = 0; step < kSteps; ++step) {
      const SurfaceJet jet = Evaluate(surface_, from.piece, from.u, from.v);
      const Vec3 gap = place - jet.p;
      from.p = jet.p;
      if (gap.norm() <= kWallPlace) return from;
      const double e = jet.du.squaredNorm(), f = jet.du.dot(jet.dv), g = jet.dv.squaredNorm();
      const double a = gap.dot(jet.du), b = gap.dot(jet.dv), determinant = e * g - f * f;
      if (!(determinant > 1e-18 * e * g)) return std::nullopt;
      // The step stays inside the piece. At a side that it would cross it runs along the side.
      Vec2 way((g * a - f * b) / determinant, (e * b - f * a) / determinant);
      const bool held_u = (from.u <= 0.0 && way.x() < 0.0) || (from.u >= 1.0 && way.x() > 0.0);
      const bool held_v = (from.v <= 0.0 && way.y() < 0.0) || (from.v >= 1.0 && way.y() > 0.0);
      if (held_u) way = Vec2(0.0, b / g);
      if (held_v) way = held_u ? Vec2(0.0, 0.0) : Vec2(a / e, 0.0);
      const Vec2 to(std::clamp(from.u + way.x(), 0.0, 1.0), std::clamp(from.v + way.y(), 0.0, 1.0));
      const bool moves =
          (to.x() - from.u) * (to.x() - from.u) * e + (to.y() - from.v) * (to.y() - from.v) * g >
          0.01 * kWallPlace * kWallPlace;
      if (moves) {
        from.u = to.x();
        from.v = to.y();
        continue;
      }
      if (!held_u && !held_v) return std::nullopt;
      const int side = held_v ? (from.v <= 0.0 ? 0 : 2) : (from.u <= 0.0 ? 3 : 1);
      const std::optional<SurfacePoint> next =
          context_.sides.Across(from.piece, side, side % 2 == 0 ? from.u : from.v);
      if (!next) return std::nullopt;
      from = *next;
    }
    return std::nullopt;
  }

  // True if the ball stands behind a vertical wall: on the material side, not on the air side. `e` is the
  // unit vector from the contact `at` to the ball's axis. False if the air side is unknown.
  bool BehindWall(const SurfacePoint& at, const Vec3& e) const {
    const std::optional<Facing> facing = FacingAt(Evaluate(surface_, at.piece, at.u, at.v));
    return facing && !facing->both && (facing->upright || facing->overhangs) && facing->e.dot(e) < 0.0;
  }

  // True if the edge rule lets a pass touch the surface at `at` with a ball in the direction `e` (as for
  // BehindWall). Only contacts on open edges can be refused: the ball must touch the face in its normal
  // there, or roll over a rim.
  bool Holds(const SurfacePoint& at, const Vec3& e) const {
    if (params_.roll) return true;
    const std::array<bool, 4> on = {at.v<kOnSide, at.u> 1.0 - kOnSide, at.v > 1.0 - kOnSide, at.u < kOnSide};
    for (int side = 0; side < 4; ++side) {
      if (!on[static_cast<std::size_t>(side)]) continue;
      if (context_.sides.At(at.piece, side).kind != SideKind::kOpen) continue;
      const std::optional<Vec3> out = OutwardTangent(surface_, at.piece, side, side % 2 == 0 ? at.u : at.v);
      if (!out) continue;  // a collapsed side: the point of a cone or the pole of a dome
      const std::optional<Facing> facing = FacingAt(Evaluate(surface_, at.piece, at.u, at.v));
      if (!facing) continue;
      const Vec3 normal = facing->both && facing->e.dot(e) < 0.0 ? Vec3(-facing->e) : facing->e;
      if (std::atan2(normal.cross(e).norm(), normal.dot(e)) <= kAtLimit) continue;
      const bool highest = out->z() > kRimRise && Xy(normal).dot(Xy(e)) >= 0.0;
      if (!highest) return false;
    }
    return true;
  }

  // True if the ball over q finishes a face: if it touches one at the contact, or rolls over a crease beside
  // a face so near that the pass finishes it, within the overlap. An open edge always counts, since the ball
  // rolls over it on purpose.
  bool OnFace(const Vec2& q, const SurfacePoint& contact) const {
    const std::optional<SurfacePoint> at = RestsOn(contact);
    if (!at) return false;
    const Vec3 e = OffContact(q, contact);
    const double turn = std::max(kOnFace, params_.overlap / oracle_.radius());
    const auto along = [&](const SurfacePoint& p) {
      const std::optional<Vec3> normal = UpwardNormal(Evaluate(surface_, p.piece, p.u, p.v));
      // A place without a normal is the point of a cone or the like.
      return !normal || normal->cross(e).norm() < turn;
    };
    if (along(*at)) return true;
    const std::array<bool, 4> on = OnSides(*at);
    for (int side = 0; side < 4; ++side) {
      if (!on[static_cast<std::size_t>(side)]) continue;
      if (context_.sides.At(at->piece, side).kind != SideKind::kCrease) return true;
      const std::optional<SurfacePoint> beyond =
          context_.sides.Across(at->piece, side, side % 2 == 0 ? at->u : at->v);
      if (beyond && along(*beyond)) return true;
    }
    return false;
  }
  bool OnFace(const CutterPoint& p) const {
    const Vec2 q = Xy(p.center);
    return OnFace(q, *p.contact) || (p.other_contact && OnFace(q, *p.other_contact));
  }
  // OnFace for places between two points of the loop. They are as far apart as the overlap, within which a
  // face beside a crease counts.
  bool OnFaceBetween(const CutterPoint& a, const CutterPoint& b) const {
    const Vec2 qa = Xy(a.center), way = Xy(b.center) - qa;
    const double length = way.norm();
    if (!(length > kEndPlace)) return false;
    const Vec2 left = Vec2(-way.y(), way.x()) / length;
    // Most places looked at on one chord.
    constexpr double kMostParts = 100.0;
    const int parts = static_cast<int>(std::min(kMostParts, 1.0 + std::ceil(length / params_.overlap)));
    for (int k = 1; k < parts; ++k) {
      const std::optional<LevelPoint> root = oracle_.RootOnLine(qa + (static_cast<double>(k) / parts) * way,
                                                                left, After(a), *b.contact, {length, length});
      if (root && OnFace(root->q, root->contact)) return true;
    }
    return false;
  }
  // True if the part rolls over creases along all of its length. Such a part finishes nothing.
  bool OverEdgesAlone(const CutterPath& part) const {
    const std::size_t n = part.points.size();
    if (std::any_of(part.points.begin(), part.points.end(),
                    [&](const CutterPoint& p) { return OnFace(p); })) {
      return false;
    }
    for (std::size_t k = 0; k + (part.closed ? 0 : 1) < n; ++k) {
      if (OnFaceBetween(part.points[k], part.points[(k + 1) % n])) return false;
    }
    return true;
  }

  bool NearSpot(const Vec3& center) const {
    if (params_.spots.empty()) return true;
    auto spot = std::lower_bound(spots_.begin(), spots_.end(), center.x() - params_.near,
                                 [](const Vec3& a, double x) { return a.x() < x; });
    for (; spot != spots_.end() && spot->x() <= center.x() + params_.near; ++spot) {
      if ((*spot - center).squaredNorm() <= params_.near * params_.near) return true;
    }
    return false;
  }

  // The contact of a loop's vertex along the chord that starts at the vertex.
  static SurfacePoint After(const CutterPoint& p) { return p.other_contact ? *p.other_contact : *p.contact; }

  void AddSegment(const CutterPoint& a, const CutterPoint& b) {
    Split({a, After(a), Judge(Xy(a.center), After(a))}, {b, *b.contact, Judge(Xy(b.center), *b.contact)}, 0);
  }

  // An end of a chord with its verdict. At a corner of the loop, which has two contacts, `contact` is the one
  // that the ball has along this chord.
  struct JudgedEnd {
    CutterPoint point;
    SurfacePoint contact;
    Verdict verdict;
  };

  // Cuts a chord where the verdict changes, by halving: the chord's middle is moved onto the loop and gets a
  // verdict of its own.
  void Split(const JudgedEnd& a, const JudgedEnd& b, int depth) {
    const double length = (b.point.center - a.point.center).norm();
    if (a.verdict == b.verdict) {
      pieces_.push_back({a.point, b.point, a.verdict});
      return;
    }
    const Vec2 qa = Xy(a.point.center), qb = Xy(b.point.center);
    if (length > kEndPlace && depth < 40) {
      const Vec2 left = Vec2(qa.y() - qb.y(), qb.x() - qa.x()) / length;
      const std::optional<LevelPoint> root =
          oracle_.RootOnLine(0.5 * (qa + qb), left, a.contact, b.contact, {length, length});
      if (root && (root->q - qa).norm() < 0.9 * length && (root->q - qb).norm() < 0.9 * length) {
        const JudgedEnd middle{{oracle_.Center(root->q), root->contact, root->other},
                               root->contact,
                               Judge(root->q, root->contact)};
        Split(a, middle, depth + 1);
        Split(middle, b, depth + 1);
        return;
      }
    }
    // The chord is too short to cut. It takes the better verdict of its ends.
    pieces_.push_back({a.point, b.point, std::max(a.verdict, b.verdict)});
  }

  std::vector<CutterPath> Parts() {
    const std::size_t n = pieces_.size();
    std::vector<char> keep(n, 0);
    for (std::size_t i = 0; i < n; ++i) keep[i] = pieces_[i].verdict == Verdict::kWanted;
    Dilate(keep);
    if (std::find(keep.begin(), keep.end(), 1) == keep.end()) return {};
    const auto gap = std::find(keep.begin(), keep.end(), 0);
    if (gap == keep.end()) {
      if (OverEdgesAlone(loop_)) return {};
      return {loop_};
    }
    std::vector<CutterPath> parts;
    const std::size_t start = loop_.closed ? static_cast<std::size_t>(gap - keep.begin()) : 0;
    bool open = false;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = (start + k) % n;
      if (!keep[i]) {
        open = false;
        continue;
      }
      if (!open) {
        CutterPath part = loop_;
        part.closed = false;
        part.points = {pieces_[i].from};
        parts.push_back(std::move(part));
        open = true;
      }
      parts.back().points.push_back(pieces_[i].to);
    }
    std::erase_if(parts, [this](const CutterPath& part) { return OverEdgesAlone(part); });
    return parts;
  }

  // Extends every wanted stretch by the overlap at both ends, as far as the places are allowed.
  void Dilate(std::vector<char>& keep) {
    const std::size_t n = pieces_.size();
    const std::vector<char> wanted = keep;
    for (const bool forward : {true, false}) {
      const auto neighbor = [&](std::size_t i) { return forward ? (i + 1) % n : (i + n - 1) % n; };
      const std::size_t end = forward ? n - 1 : 0;  // of an open contour
      for (std::size_t i = 0; i < n; ++i) {
        if (!wanted[i] || (!loop_.closed && i == end) || wanted[neighbor(i)]) continue;
        double left = params_.overlap;
        for (std::size_t k = neighbor(i); left > 0.0 && !wanted[k] && pieces_[k].verdict != Verdict::kNone;
             k = neighbor(k)) {
          keep[k] = 1;
          left -= (pieces_[k].to.center - pieces_[k].from.center).norm();
          if (!loop_.closed && k == end) break;
        }
      }
    }
  }

  const LevelContext& context_;
  const Surface& surface_;
  LevelOracle oracle_;
  const CutterPath& loop_;
  const ClipParams& params_;
  std::vector<Vec3> spots_;
  std::vector<Piece> pieces_;
};

}  // namespace

std::vector<CutterPath> ClipLoop(const LevelContext& context, const CutterPath& loop,
                                 const ClipParams& params) {
  return Clipper(context, loop, params).Run();
}

}  // namespace patchmill
