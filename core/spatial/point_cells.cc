#include "core/spatial/point_cells.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace patchmill {
namespace {

// A little less than 1 / sqrt(3), so that in spite of rounding any two points of one cell are within reach.
constexpr double kSideOfReach = 0.577;
// Number of cells on each side of a cell that its reach can touch.
constexpr std::int64_t kCellsAround = 2;
// Beyond this many rings of cells all points are compared.
constexpr std::int64_t kMostRings = 10;

}  // namespace

PointCells::PointCells(std::vector<Vec3> points, double reach)
    : points_(std::move(points)), reach_(reach), side_(kSideOfReach * reach) {
  entries_.reserve(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Key key = KeyOf(points_[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      low_[k] = i == 0 ? key[k] : std::min(low_[k], key[k]);
      high_[k] = i == 0 ? key[k] : std::max(high_[k], key[k]);
    }
    entries_.push_back({key, i});
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return std::pair(a.key, a.point) < std::pair(b.key, b.point);
  });
}

PointCells::Key PointCells::KeyOf(const Vec3& p) const {
  Key key;
  for (int k = 0; k < 3; ++k)
    key[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(p[k] / side_));
  return key;
}

std::pair<std::size_t, std::size_t> PointCells::Column(std::int64_t x, std::int64_t y, std::int64_t low,
                                                       std::int64_t high) const {
  const auto less = [](const Entry& entry, const Key& key) { return entry.key < key; };
  const auto first = std::lower_bound(entries_.begin(), entries_.end(), Key{x, y, low}, less);
  const auto last = std::lower_bound(first, entries_.end(), Key{x, y, high + 1}, less);
  return {static_cast<std::size_t>(first - entries_.begin()),
          static_cast<std::size_t>(last - entries_.begin())};
}

void PointCells::JoinNear(UnionFind& sets, const RunContext& run) const {
  for (std::size_t first = 0; first < entries_.size() && !run.Cancelled();) {
    const Key key = entries_[first].key;
    std::size_t last = first;
    for (; last < entries_.size() && entries_[last].key == key; ++last)
      sets.Join(entries_[first].point, entries_[last].point);
    // The cells before this one have been joined with it already. In its own column these are the cells
    // below.
    for (std::int64_t dx = -kCellsAround; dx <= 0; ++dx) {
      for (std::int64_t dy = -kCellsAround; dy <= (dx < 0 ? kCellsAround : 0); ++dy) {
        const bool own = dx == 0 && dy == 0;
        const auto [begin, end] =
            Column(key[0] + dx, key[1] + dy, key[2] - kCellsAround, key[2] + (own ? -1 : kCellsAround));
        for (std::size_t other = begin; other < end; ++other) {
          const std::size_t b = entries_[other].point;
          // The points of one cell are one set already.
          for (std::size_t one = first; one < last && sets.Find(entries_[first].point) != sets.Find(b);
               ++one) {
            const std::size_t a = entries_[one].point;
            if ((points_[a] - points_[b]).squaredNorm() <= reach_ * reach_) sets.Join(a, b);
          }
        }
      }
    }
    first = last;
  }
}

std::optional<std::size_t> PointCells::Nearest(const Vec3& place) const {
  if (entries_.empty()) return std::nullopt;
  const Key key = KeyOf(place);
  std::int64_t most = 0;
  for (std::size_t k = 0; k < 3; ++k)
    most = std::max({most, std::abs(key[k] - low_[k]), std::abs(key[k] - high_[k])});
  std::size_t best = entries_.front().point;
  double least = (points_[best] - place).squaredNorm();
  const auto look = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double distance = (points_[entries_[i].point] - place).squaredNorm();
      if (distance > least || (distance == least && entries_[i].point >= best)) continue;
      least = distance;
      best = entries_[i].point;
    }
  };
  for (std::int64_t ring = 0; ring <= most; ++ring) {
    // All points in farther rings are at least this far away.
    const double beyond = (static_cast<double>(ring) - 1.0) * side_;
    if (beyond > 0.0 && beyond * beyond > least) break;
    if (ring > kMostRings) {
      look(0, entries_.size());
      break;
    }
    for (std::int64_t dx = -ring; dx <= ring; ++dx) {
      for (std::int64_t dy = -ring; dy <= ring; ++dy) {
        const std::int64_t x = key[0] + dx, y = key[1] + dy;
        if (x < low_[0] || x > high_[0] || y < low_[1] || y > high_[1]) continue;
        if (std::max(std::abs(dx), std::abs(dy)) == ring) {
          const auto [begin, end] = Column(x, y, key[2] - ring, key[2] + ring);
          look(begin, end);
        } else {
          for (const std::int64_t dz : {-ring, ring}) {
            const auto [begin, end] = Column(x, y, key[2] + dz, key[2] + dz);
            look(begin, end);
          }
        }
      }
    }
  }
  return best;
}

}  // namespace patchmill
