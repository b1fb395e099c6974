#include "cam/toolpath/straighten.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace patchmill {
namespace {

constexpr std::size_t kLongestRun = 4096;  // moves that become one

bool MayJoin(const Move& a, const Move& b) {
  return a.kind != MoveKind::kRapid && a.kind == b.kind && a.feed == b.feed && a.pass == b.pass &&
         a.region == b.region;
}

// Ends of moves along a run; index 0 is where the run begins.
class Run {
 public:
  Run(const Vec3& start, const std::vector<Move>& moves, std::size_t first, std::size_t count) {
    places_.reserve(count + 1);
    places_.push_back(start);
    for (std::size_t k = 0; k < count; ++k) places_.push_back(moves[first + k].to);
  }

  // Indices of the places that stay, the last one included, the first one not.
  std::vector<std::size_t> Kept() const {
    std::vector<std::size_t> kept = {0};
    const std::size_t last = places_.size() - 1;
    while (kept.back() < last) {
      const std::size_t from = kept.back();
      std::size_t to = from + 1;
      while (to < last && to - from < kLongestRun && IsStraight(from, to + 1, kStraight)) ++to;
      kept.push_back(to);
    }
    for (bool again = true; again;) {
      again = false;
      for (std::size_t k = 1; k + 1 < kept.size(); ++k) {
        const std::size_t from = kept[k - 1], to = kept[k + 1];
        if (to - from > kLongestRun || !(Distance(kept[k], from, to) < kStraight)) continue;
        if (!IsStraight(from, to, 2.0 * kStraight)) continue;
        kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(k));
        again = true;
      }
    }
    kept.erase(kept.begin());
    return kept;
  }

 private:
  double Distance(std::size_t place, std::size_t from, std::size_t to) const {
    const Vec3 &a = places_[from], &b = places_[to];
    const Vec3 along = b - a, out = places_[place] - a;
    const double length2 = along.squaredNorm();
    const double t = length2 > 0.0 ? std::clamp(out.dot(along) / length2, 0.0, 1.0) : 0.0;
    return (out - t * along).norm();
  }

  // True if all places between lie within `most` of the straight way, one behind the other.
  bool IsStraight(std::size_t from, std::size_t to, double most) const {
    const Vec3 along = places_[to] - places_[from];
    double before = 0.0;
    for (std::size_t k = from + 1; k <= to; ++k) {
      const double at = (places_[k] - places_[from]).dot(along);
      if (!(at >= before) || (k < to && !(Distance(k, from, to) < most))) return false;
      before = at;
    }
    return true;
  }

  std::vector<Vec3> places_;
};

}  // namespace

Toolpath Straightened(Toolpath toolpath) {
  const std::vector<Move>& moves = toolpath.moves;
  std::vector<Move> fewer;
  for (std::size_t first = 0; first < moves.size();) {
    std::size_t count = 1;
    while (first + count < moves.size() && MayJoin(moves[first], moves[first + count])) ++count;
    if (first == 0 || count == 1) {
      fewer.insert(fewer.end(), moves.begin() + static_cast<std::ptrdiff_t>(first),
                   moves.begin() + static_cast<std::ptrdiff_t>(first + count));
    } else {
      for (const std::size_t k : Run(moves[first - 1].to, moves, first, count).Kept())
        fewer.push_back(moves[first + k - 1]);
    }
    first += count;
  }
  toolpath.moves = std::move(fewer);
  return toolpath;
}

}  // namespace patchmill
