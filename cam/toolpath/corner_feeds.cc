#include "cam/toolpath/corner_feeds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace patchmill {
namespace {

constexpr double kWindow = 0.5;  // ball radii, before a place and behind it
constexpr double kFeedSteps = 10.0;
constexpr double kLeastTurn = Radians(0.01);
constexpr double kSamePlace = 1e-9;  // mm

// A turn away from the contact, at a place along a pass.
struct Turn {
  double at = 0.0;     // mm along the pass
  double angle = 0.0;  // rad
};

// A stretch of a pass with one feed.
struct FeedStretch {
  double end = 0.0;   // mm along the pass
  double feed = 0.0;  // mm/min
};

// One pass of a toolpath: its moves [first, last) and the place where it starts.
class Pass {
 public:
  Pass(const std::vector<Move>& moves, std::size_t first, std::size_t last)
      : moves_(moves), first_(first), last_(last) {
    along_.push_back(0.0);
    for (std::size_t i = first; i < last; ++i)
      along_.push_back(along_.back() + (moves[i].to - moves[i - 1].to).norm());
  }

  double length() const { return along_.back(); }
  // The end of a move, mm along the pass.
  double EndOf(std::size_t move) const { return along_[move - first_ + 1]; }

  std::vector<Turn> InnerTurns() const {
    std::vector<Turn> turns;
    for (std::size_t i = first_; i + 1 < last_; ++i) Add(i, i + 1, EndOf(i), turns);
    const bool closed = (moves_[last_ - 1].to - moves_[first_ - 1].to).norm() < kSamePlace;
    if (!closed || last_ - first_ < 3) return turns;
    Add(last_ - 1, first_, length(), turns);
    // The neighbours of the seam, seen from its other side.
    const std::size_t count = turns.size();
    for (const double shift : {-length(), length()}) {
      for (std::size_t k = 0; k < count; ++k) turns.push_back({turns[k].at + shift, turns[k].angle});
    }
    std::sort(turns.begin(), turns.end(), [](const Turn& a, const Turn& b) { return a.at < b.at; });
    return turns;
  }

 private:
  // From the centre at the end of `before` to what the ball touches there, and at the ends of both moves;
  // zero if it touches nothing. In a corner between two walls that is the middle between both.
  Vec3 ToContact(std::size_t before, std::size_t after) const {
    Vec3 sum = Vec3::Zero();
    for (const std::size_t i : {before > first_ ? before - 1 : before, before, after}) {
      if (moves_[i].contact) sum += (moves_[i].contact->p - moves_[i].to).normalized();
    }
    return sum.norm() > 1e-6 ? Vec3(sum.normalized()) : Vec3(Vec3::Zero());
  }

  // Adds the turn between two moves if it leads away from the contact.
  void Add(std::size_t before, std::size_t after, double at, std::vector<Turn>& turns) const {
    const Vec3 in = moves_[before].to - moves_[before - 1].to;
    const Vec3 out = moves_[after].to - moves_[after - 1].to;
    if (in.norm() < kSamePlace || out.norm() < kSamePlace) return;
    const Vec3 a = in.normalized(), b = out.normalized(), change = b - a;
    const double angle = 2.0 * std::asin(std::min(1.0, 0.5 * change.norm()));
    if (angle < kLeastTurn) return;
    const double away = -change.normalized().dot(ToContact(before, after));
    if (away > 0.0) turns.push_back({at, angle * away});
  }

  const std::vector<Move>& moves_;
  std::size_t first_, last_;
  std::vector<double> along_;  // mm, of the start and of the ends of moves
};

// The feed where the turns within the window sum up to `turn` (rad). The window is 2 kWindow ball radii long,
// so R k of the header is turn / (2 kWindow).
double FeedAt(double turn, const CornerFeedParams& params) {
  const double share = 1.0 / (1.0 + turn / (2.0 * kWindow));
  const double steps = std::round(kFeedSteps * share);
  return steps >= kFeedSteps ? params.feed : std::max(params.least, params.feed * steps / kFeedSteps);
}

void Append(double end, double feed, std::vector<FeedStretch>& stretches) {
  if (!stretches.empty() && stretches.back().feed == feed) {
    stretches.back().end = end;
  } else {
    stretches.push_back({end, feed});
  }
}

// The feed all along a pass.
std::vector<FeedStretch> FeedsAlong(const Pass& pass, double radius, const CornerFeedParams& params) {
  const std::vector<Turn> turns = pass.InnerTurns();
  const double window = kWindow * radius;
  std::vector<FeedStretch> stretches;
  double turn = 0.0;
  std::size_t entered = 0, left = 0;
  while (entered < turns.size() || left < turns.size()) {
    const bool enters = entered < turns.size() && turns[entered].at - window <= turns[left].at + window;
    const double at = enters ? turns[entered].at - window : turns[left].at + window;
    const double before = stretches.empty() ? 0.0 : stretches.back().end;
    const double end = std::clamp(at, 0.0, pass.length());
    if (end > before + kSamePlace) Append(end, FeedAt(turn, params), stretches);
    turn += enters ? turns[entered++].angle : -turns[left++].angle;
    if (entered == left) turn = 0.0;  // no rounding is carried along
  }
  if (stretches.empty() || stretches.back().end < pass.length())
    Append(pass.length(), FeedAt(0.0, params), stretches);
  return stretches;
}

// Joins short stretches that are faster than both neighbours with the faster one of these.
std::vector<FeedStretch> WithoutShortRises(const std::vector<FeedStretch>& stretches, double shortest) {
  std::vector<FeedStretch> kept;
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    const double start = k == 0 ? 0.0 : stretches[k - 1].end;
    double feed = stretches[k].feed;
    if (k > 0 && k + 1 < stretches.size() && stretches[k].end - start < shortest)
      feed = std::min(feed, std::max(kept.back().feed, stretches[k + 1].feed));
    Append(stretches[k].end, feed, kept);
  }
  return kept;
}

// Appends the moves of a pass, divided where the feed changes. Returns the length that became slower, mm.
double AppendSlowed(const std::vector<Move>& moves, std::size_t first, std::size_t last,
                    const std::vector<FeedStretch>& stretches, std::vector<Move>& out) {
  double slowed = 0.0, at = 0.0;
  std::size_t k = 0;
  for (std::size_t i = first; i < last; ++i) {
    const Vec3 from = moves[i - 1].to, way = moves[i].to - from;
    const double length = way.norm(), start = at;
    const auto add = [&](const Vec3& to, double end, bool whole) {
      Move part = moves[i];
      part.to = to;
      if (!whole) part.contact.reset();
      if (stretches[k].feed < part.feed) {
        part.feed = stretches[k].feed;
        slowed += end - at;
      }
      out.push_back(std::move(part));
      at = end;
    };
    while (k + 1 < stretches.size() && stretches[k].end < start + length - kSamePlace) {
      // At plunge feed a division would change nothing.
      const double end = stretches[k].end;
      const bool differs =
          std::min(stretches[k].feed, moves[i].feed) != std::min(stretches[k + 1].feed, moves[i].feed);
      if (differs && end > at + kSamePlace) add(from + (end - start) / length * way, end, false);
      ++k;
    }
    add(moves[i].to, start + length, true);
  }
  return slowed;
}

}  // namespace

CornerFeedResult WithCornerFeeds(Toolpath toolpath, const CornerFeedParams& params) {
  CornerFeedResult result;
  const std::vector<Move> moves = std::move(toolpath.moves);
  const double radius = toolpath.ball_radius;
  std::vector<Move> out;
  out.reserve(moves.size());
  for (std::size_t first = 0; first < moves.size();) {
    std::size_t last = first + 1;
    if (first == 0 || moves[first].kind != MoveKind::kCut) {
      out.push_back(moves[first]);
      first = last;
      continue;
    }
    while (last < moves.size() && moves[last].kind == MoveKind::kCut && moves[last].pass == moves[first].pass)
      ++last;
    const std::vector<FeedStretch> feeds = FeedsAlong(Pass(moves, first, last), radius, params);
    result.slowed_length += AppendSlowed(moves, first, last, WithoutShortRises(feeds, kWindow * radius), out);
    first = last;
  }
  toolpath.moves = std::move(out);
  result.toolpath = std::move(toolpath);
  return result;
}

}  // namespace patchmill
