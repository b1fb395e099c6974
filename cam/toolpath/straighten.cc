#include "cam/toolpath/straighten.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace patchmill {
namespace {

constexpr std::size_t kLongestRun = 1 << 16;  // moves that become one

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
    while (kept.back() < last) kept.push_back(Farthest(kept.back()));
    for (std::size_t before = kept.size() + 1; kept.size() < before;) {
      before = kept.size();
      kept = WithoutSpare(kept);
    }
    kept.erase(kept.begin());
    return kept;
  }

 private:
  // A far place to which the way is straight: steps are doubled while it is, then halved.
  std::size_t Farthest(std::size_t from) const {
    std::size_t to = from + 1, step = 1;
    const auto further = [&] {
      return to + step < places_.size() && to + step - from <= kLongestRun &&
             IsStraight(from, to + step, kStraight);
    };
    for (; further(); step *= 2) to += step;
    for (; step >= 1; step /= 2) {
      if (further()) to += step;
    }
    return to;
  }

  // Leaves out places within kStraight of the way between their neighbours, where the places that were left
  // out before allow it.
  std::vector<std::size_t> WithoutSpare(const std::vector<std::size_t>& kept) const {
    std::vector<std::size_t> fewer = {kept.front()};
    for (std::size_t k = 1; k < kept.size(); ++k) {
      const std::size_t from = fewer.back();
      const bool spare = k + 1 < kept.size() && kept[k + 1] - from <= kLongestRun &&
                         Distance(kept[k], from, kept[k + 1]) < kStraight &&
                         IsStraight(from, kept[k + 1], 2.0 * kStraight);
      if (!spare) fewer.push_back(kept[k]);
    }
    return fewer;
  }

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
