// Heights of many places. The tree is walked once for eight neighbours, and each leaf is tested against all
// eight at once (lane_kernel.h).
#include "cam/location/simd/heights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cam/location/locator_impl.h"
#include "cam/location/simd/lane_kernel.h"
#include "cam/location/tree_walk.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

using internal::Ball;
using internal::Contact;
using internal::kLanes;
using internal::LaneKernel;
using internal::LaneLeaf;
using internal::LaneLimits;
using internal::LanePacket;
using internal::LaneStart;

internal::LaneNet NetOf(const Piece& piece) {
  internal::LaneNet net{.known = piece.shape == nullptr,
                        .degree_u = piece.net.degree_u,
                        .degree_v = piece.net.degree_v,
                        .rational = piece.net.rational,
                        .points = piece.net.points.front().data()};
  if (piece.gregory) {
    net.gregory = piece.gregory->points.front().data();
    net.edge_blend = piece.gregory->blend == GregoryPatch::Blend::kEdge;
    net.rational = false;
  }
  return net;
}

LaneLimits LimitsOf(const Locator::Impl& impl) {
  return {impl.radius, impl.rounding, impl.BallAt(Vec2::Zero()).FreeF()};
}

LaneLeaf ViewOf(const Surface& surface, std::int32_t piece, const internal::Rect& rect,
                const internal::LeafBox& box, const internal::LeafModel& m) {
  return {.piece = piece,
          .u0 = rect.u0,
          .u1 = rect.u1,
          .v0 = rect.v0,
          .v1 = rect.v1,
          .center = box.center.data(),
          .axis = box.axis.data(),
          .half = box.half.data(),
          .s = m.s.data(),
          .a = m.a.data(),
          .b = m.b.data(),
          .uu = m.uu.data(),
          .uv = m.uv.data(),
          .vv = m.vv.data(),
          .errors = &m,
          .net = NetOf(surface.pieces[static_cast<std::size_t>(piece)])};
}

Contact ContactOf(const LanePacket& p, int k) {
  return {p.z[k], static_cast<int>(p.piece[k]),    p.u[k],
          p.v[k], Vec3(p.px[k], p.py[k], p.pz[k]), Vec2(p.slope_u[k], p.slope_v[k])};
}

void PutContact(const Contact& c, LanePacket& p, int k) {
  p.z[k] = c.z;
  p.u[k] = c.u;
  p.v[k] = c.v;
  p.px[k] = c.p.x();
  p.py[k] = c.p.y();
  p.pz[k] = c.p.z();
  p.slope_u[k] = c.slope.x();
  p.slope_v[k] = c.slope.y();
  p.piece[k] = c.piece;
}

// Walks the tree for one packet.
class PacketSearch {
 public:
  PacketSearch(const Locator::Impl& impl, const LaneKernel& kernel, LanePacket& packet)
      : impl_(impl), kernel_(kernel), limits_(LimitsOf(impl)), packet_(packet) {
    for (auto& open : open_) open.clear();
  }

  // Newton's method on whole pieces, from the places where the contacts are expected.
  void Approach(const LaneStart& start);
  void Run();
  // For balls that stand at the packet's heights. Lanes that find a contact are done.
  void RunFree();
  // The leaves that a lane's search left unproven.
  const Locator::Impl::OpenLeaves& open(std::size_t lane) const { return open_[lane]; }

 private:
  template <class Meets, class OnLeaf>
  void Walk(const Meets& meets, const OnLeaf& on_leaf);
  void Visit(std::int32_t index, const internal::LeafBox& box);
  void VisitScalar(std::int32_t index, int lane);
  static std::array<Locator::Impl::OpenLeaves, kLanes>& Scratch() {
    thread_local std::array<Locator::Impl::OpenLeaves, kLanes> open;
    return open;
  }

  const Locator::Impl& impl_;
  const LaneKernel& kernel_;
  const LaneLimits limits_;
  LanePacket& packet_;
  Locator::Impl::Aim aim_ = Locator::Impl::Aim::kHighest;
  std::array<Locator::Impl::OpenLeaves, kLanes>& open_ = Scratch();
};

// As Locator::Impl::Search, for all lanes at the lowest height of any lane.
template <class Meets, class OnLeaf>
void PacketSearch::Walk(const Meets& meets, const OnLeaf& on_leaf) {
  const internal::WalkLimits limits = impl_.Limits();
  const auto [x0, x1] = std::minmax_element(packet_.qx, packet_.qx + kLanes);
  const auto [y0, y1] = std::minmax_element(packet_.qy, packet_.qy + kLanes);
  const internal::XyBox at{static_cast<float>(*x0), static_cast<float>(*x1), static_cast<float>(*y0),
                           static_cast<float>(*y1)};
  internal::WalkTree(
      impl_.tree, {at, limits},
      [&] { return static_cast<float>(*std::min_element(packet_.z, packet_.z + kLanes)); },
      [&](const internal::SearchNode& node, int k) { return meets(node, k, limits); },
      [&](std::int32_t leaf) {
        on_leaf(leaf);
        return true;
      });
}

void PacketSearch::Run() {
  Walk([](const internal::SearchNode&, int, const internal::WalkLimits&) { return true; },
       [&](std::int32_t leaf) { Visit(leaf, impl_.tree.leaves[leaf].Box(impl_.tree.grid)); });
}

namespace {

// The packet's balls in floats, as the boxes of the tree are stored.
struct FloatLanes {
  static constexpr std::size_t kGroups = kLanes / 4;
  Float4 x[kGroups], y[kGroups], z[kGroups];

  explicit FloatLanes(const LanePacket& packet) {
    for (int k = 0; k < kLanes; ++k) {
      x[k / 4][k % 4] = static_cast<float>(packet.qx[k]);
      y[k / 4][k % 4] = static_cast<float>(packet.qy[k]);
    }
    SetHeights(packet);
  }
  void SetHeights(const LanePacket& packet) {
    for (int k = 0; k < kLanes; ++k) z[k / 4][k % 4] = static_cast<float>(packet.z[k]);
  }
  // WalkTree's test of child k, for each lane.
  bool Meet(const internal::SearchNode& node, int k, const internal::WalkLimits& limits) const {
    const Float4 up_x = Splat(node.up_x[k]), up_y = Splat(node.up_y[k]), up_z = Splat(node.up_z[k]),
                 top = Splat(node.top[k] + limits.radius);
    std::array<unsigned, kGroups> out;
    unsigned all = 0xF;
    for (std::size_t g = 0; g < kGroups; ++g)
      all &= out[g] = BelowBits(top, up_x * x[g] + up_y * y[g] + up_z * z[g]);
    if (all == 0xF) return false;
    const Float4 zero{}, min_x = Splat(node.min_x[k]), max_x = Splat(node.max_x[k]),
                         min_y = Splat(node.min_y[k]), max_y = Splat(node.max_y[k]),
                         max_z = Splat(node.max_z[k]);
    unsigned meeting = 0;
    for (std::size_t g = 0; g < kGroups; ++g) {
      const Float4 dx = Max(Max(min_x - x[g], x[g] - max_x), zero),
                   dy = Max(Max(min_y - y[g], y[g] - max_y), zero), below = Max(z[g] - max_z, zero);
      meeting |= ~out[g] & BelowBits(dx * dx + dy * dy + below * below, Splat(limits.square));
    }
    return meeting != 0;
  }
};

}  // namespace

// Balls do not rise here, and they lie less close together than those of neighbouring heights. So boxes are
// tested against each ball. Most leaves are out of the way of all balls, and this is known before more is
// done.
void PacketSearch::RunFree() {
  aim_ = Locator::Impl::Aim::kAny;
  FloatLanes lanes(packet_);
  Walk([&](const internal::SearchNode& node, int k,
           const internal::WalkLimits& limits) { return lanes.Meet(node, k, limits); },
       [&](std::int32_t leaf) {
         const internal::LeafBox box = impl_.tree.leaves[leaf].Box(impl_.tree.grid);
         LaneLeaf bounds{};
         bounds.center = box.center.data();
         bounds.axis = box.axis.data();
         bounds.half = box.half.data();
         if (kernel_.meets(bounds, limits_, packet_) == 0) return;
         Visit(leaf, box);
         // A ball above everything meets nothing.
         for (int k = 0; k < kLanes; ++k) {
           if (packet_.piece[k] >= 0) packet_.z[k] = impl_.surface.box.max.z() + 2.0 * impl_.radius;
         }
         lanes.SetHeights(packet_);
       });
}

void PacketSearch::Approach(const LaneStart& start) {
  for (int k = 0; k < kLanes; ++k) {
    const std::int64_t piece = start.piece[k];
    if (piece < 0 || std::find(start.piece, start.piece + k, piece) != start.piece + k) continue;
    LaneLeaf whole{};
    whole.piece = piece;
    whole.u1 = whole.v1 = 1.0;
    whole.net = NetOf(impl_.surface.pieces[static_cast<std::size_t>(piece)]);
    if (!whole.net.known) continue;
    kernel_.approach(whole, limits_, start, packet_);
  }
}

void PacketSearch::Visit(std::int32_t index, const internal::LeafBox& box) {
  const internal::SearchLeaf& leaf = impl_.tree.leaves[index];
  const internal::LeafModel model = leaf.Model(impl_.tree.grid);
  const unsigned unresolved =
      kernel_.visit(ViewOf(impl_.surface, leaf.piece(), leaf.rect(), box, model), limits_, packet_);
  for (int k = 0; k < kLanes; ++k) {
    if ((unresolved >> k & 1U) != 0) VisitScalar(index, k);
  }
}

void PacketSearch::VisitScalar(std::int32_t index, int k) {
  Contact best = ContactOf(packet_, k);
  impl_.VisitLeaf(index, impl_.BallAt({packet_.qx[k], packet_.qy[k]}), aim_, best,
                  open_[static_cast<std::size_t>(k)]);
  PutContact(best, packet_, k);
}

// Predicts the start of a packet from the two packets before it, lane by lane. This helps if the places are
// evenly spaced.
class Forecast {
 public:
  void Start(const Locator::Impl& impl, std::span<const Vec2> q, LanePacket& packet, LaneStart& start) const;
  void Learn(const LanePacket& packet) {
    before_ = last_;
    last_ = packet;
    known_ = std::min(known_ + 1, 2);
  }

 private:
  LanePacket last_, before_;
  int known_ = 0;
};

// Fills in the packet's places; the last one is repeated. Each ball starts at the height at which it touches
// the last contact of its lane.
void Forecast::Start(const Locator::Impl& impl, std::span<const Vec2> q, LanePacket& packet,
                     LaneStart& start) const {
  const double graze = LimitsOf(impl).graze();
  for (int k = 0; k < kLanes; ++k) {
    const Vec2& at = q[std::min<std::size_t>(static_cast<std::size_t>(k), q.size() - 1)];
    packet.qx[k] = at.x();
    packet.qy[k] = at.y();
    Contact contact;
    contact.z = impl.Lowest();
    start.piece[k] = -1;
    start.u[k] = start.v[k] = 0.0;
    if (known_ > 0 && last_.piece[k] >= 0) {
      const Contact last = ContactOf(last_, k);
      const double rim = impl.radius * impl.radius - (Xy(last.p) - at).squaredNorm();
      if (rim >= graze * graze) {
        contact = last;
        contact.z = last.p.z() + std::sqrt(rim);
        contact.slope = Vec2::Constant(std::numeric_limits<double>::quiet_NaN());
        const bool moving = known_ > 1 && before_.piece[k] == last_.piece[k];
        start.piece[k] = last.piece;
        start.u[k] = moving ? 2.0 * last.u - before_.u[k] : last.u;
        start.v[k] = moving ? 2.0 * last.v - before_.v[k] : last.v;
      }
    }
    PutContact(contact, packet, k);
  }
}

}  // namespace

void Heights(const Locator& locator, std::span<const Vec2> q, std::span<std::optional<CenterPoint>> heights,
             double gap) {
  PM_CHECK(q.size() == heights.size());
  const LaneKernel& kernel = internal::UsedLaneKernel();
  const Locator::Impl& impl = locator.impl();
  LanePacket packet;
  LaneStart start;
  Forecast forecast;
  for (std::size_t i = 0; i < q.size(); i += kLanes) {
    const std::size_t count = std::min<std::size_t>(kLanes, q.size() - i);
    forecast.Start(impl, q.subspan(i, count), packet, start);
    PacketSearch search(impl, kernel, packet);
    search.Approach(start);
    search.Run();
    forecast.Learn(packet);
    for (std::size_t k = 0; k < count; ++k) {
      Contact c = ContactOf(packet, static_cast<int>(k));
      impl.Certify(impl.BallAt(q[i + k]), search.open(k), gap, Locator::Impl::Aim::kHighest, c);
      heights[i + k].reset();
      if (c.piece >= 0) heights[i + k] = CenterPoint{c.z, impl.PointOf(c)};
    }
  }
}

namespace {

// Fewer balls are searched one by one.
constexpr std::size_t kWorthLanes = 2;

std::optional<SurfacePoint> FindObstacle(const Locator::Impl& impl, const Vec3& center) {
  thread_local Locator::Impl::OpenLeaves open;
  const auto found = impl.TryFree(impl.BallAt(Xy(center)), center.z(), kProofGap, open);
  if (!found.contact) return std::nullopt;
  return impl.PointOf(*found.contact);
}

}  // namespace

void FindObstacles(const Locator& locator, std::span<const Vec3> centers,
                   std::span<std::optional<SurfacePoint>> obstacles) {
  PM_CHECK(centers.size() == obstacles.size());
  const LaneKernel& kernel = internal::UsedLaneKernel();
  const Locator::Impl& impl = locator.impl();
  LanePacket packet;
  for (std::size_t i = 0; i < centers.size(); i += kLanes) {
    const std::size_t count = std::min<std::size_t>(kLanes, centers.size() - i);
    if (count < kWorthLanes) {
      for (std::size_t k = i; k < i + count; ++k) obstacles[k] = FindObstacle(impl, centers[k]);
      continue;
    }
    for (std::size_t k = 0; k < kLanes; ++k) {
      const Vec3& at = centers[i + std::min(k, count - 1)];
      packet.qx[k] = at.x();
      packet.qy[k] = at.y();
      Contact none;
      none.z = std::max(at.z(), impl.Lowest());
      PutContact(none, packet, static_cast<int>(k));
    }
    PacketSearch search(impl, kernel, packet);
    search.RunFree();
    for (std::size_t k = 0; k < count; ++k) {
      obstacles[i + k].reset();
      if (packet.piece[k] >= 0) {
        obstacles[i + k] = impl.PointOf(ContactOf(packet, static_cast<int>(k)));
        continue;
      }
      const Vec3& at = centers[i + k];
      const auto found = impl.ProveFree(impl.BallAt(Xy(at)), at.z(), kProofGap, search.open(k));
      if (found.contact) obstacles[i + k] = impl.PointOf(*found.contact);
    }
  }
}

}  // namespace patchmill
