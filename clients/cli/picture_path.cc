#include "clients/cli/picture_path.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "clients/cli/scene_words.h"

namespace patchmill::cli {
namespace {

constexpr std::uint8_t kAlways = 255;
constexpr std::size_t kClasses = kFirstPass + kPassNames.size();
constexpr double kRoomPx = 3.0;            // between passes
constexpr std::size_t kLongPass = 20'000;  // points: passes that are longer on the average are spirals

std::uint8_t ClassOf(const v1::PathBlock& block, int move) {
  switch (block.kind(move)) {
    case v1::MOVE_KIND_RAPID:
      return kRapid;
    case v1::MOVE_KIND_LEAD:
      return kLead;
    case v1::MOVE_KIND_LINK:
      return kLink;
    case v1::MOVE_KIND_CUT: {
      const int pass = block.pass_kind_size() > 0 ? block.pass_kind(move) : 0;
      return static_cast<std::uint8_t>(pass == 0 ? kCutOfNoPass : kFirstPass + pass - 1);
    }
    default:
      return kApproach;
  }
}

struct Arc {
  std::array<std::size_t, 3> axes;  // first and second of the plane, and the one along which it climbs
  render::Point center;
  double turns = 0.0;
};

Arc ArcOf(const v1::PathBlock& block, int move, int number) {
  Arc arc{{0, 1, 2}, {}, block.arc_turns(number)};
  if (block.arc_plane(move) == v1::ARC_PLANE_ZX) arc.axes = {2, 0, 1};
  if (block.arc_plane(move) == v1::ARC_PLANE_YZ) arc.axes = {1, 2, 0};
  for (int k = 0; k < 3; ++k) arc.center[static_cast<std::size_t>(k)] = block.arc_center_mm(3 * number + k);
  return arc;
}

render::Point OnArc(const Arc& arc, const render::Point& start, const render::Point& end, double share) {
  const std::size_t first = arc.axes[0], second = arc.axes[1], third = arc.axes[2];
  const double u = start[first] - arc.center[first], v = start[second] - arc.center[second];
  const auto turned = [&](double angle) {
    return std::array<double, 2>{arc.center[first] + u * std::cos(angle) - v * std::sin(angle),
                                 arc.center[second] + u * std::sin(angle) + v * std::cos(angle)};
  };
  const double whole = 2.0 * std::numbers::pi * arc.turns;
  const std::array<double, 2> at = turned(whole * share), last = turned(whole);
  render::Point point;
  // What rounding leaves between the end of the turn and that of the move is spread along the arc.
  point[first] = at[0] + share * (end[first] - last[0]);
  point[second] = at[1] + share * (end[second] - last[1]);
  point[third] = start[third] + share * (end[third] - start[third]);
  return point;
}

int ChordsOf(const Arc& arc, const render::Point& start, double chord) {
  const auto [first, second, third] = arc.axes;
  const double radius = std::hypot(start[first] - arc.center[first], start[second] - arc.center[second]);
  const double step = radius > chord ? 2.0 * std::acos(1.0 - chord / radius) : 0.5 * std::numbers::pi;
  return std::clamp(static_cast<int>(std::ceil(2.0 * std::numbers::pi * std::abs(arc.turns) / step)), 1, 720);
}

double Length(const render::Point& a, const render::Point& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

// Counts passes and gives them their ranks. A spiral is one pass: each full turn of it counts as one.
class Ranks {
 public:
  explicit Ranks(bool by_turns) : by_turns_(by_turns) {}

  std::uint8_t Next(std::uint8_t path_class, std::int32_t pass, const render::Point& from,
                    const render::Point& to) {
    if (by_turns_) Turn(to[0] - from[0], to[1] - from[1]);
    if (pass != last_ || std::abs(turned_) >= 2.0 * std::numbers::pi) {
      const std::uint32_t number = counts_[path_class]++;
      rank_ = number == 0 ? std::uint8_t{kAlways - 1} : static_cast<std::uint8_t>(std::countr_zero(number));
      last_ = pass;
      turned_ = 0.0;
    }
    return rank_;
  }

 private:
  void Turn(double x, double y) {
    if (x == 0.0 && y == 0.0) return;
    turned_ += std::atan2(heading_[0] * y - heading_[1] * x, heading_[0] * x + heading_[1] * y);
    heading_ = {x, y};
  }

  bool by_turns_;
  std::array<std::uint32_t, kClasses> counts_{};
  std::int32_t last_ = -1;
  std::uint8_t rank_ = kAlways;
  double turned_ = 0.0;  // rad, since the pass or its last turn began
  std::array<double, 2> heading_{};
};

bool IsJoint(std::uint8_t path_class) { return path_class == kLead || path_class == kLink; }

}  // namespace

PicturePath MakePicturePath(const std::vector<v1::PathBlock>& blocks, double chord_mm, double area_mm2) {
  PicturePath path;
  std::vector<std::int32_t> passes;  // of each point
  for (const v1::PathBlock& block : blocks) {
    int arcs = 0;
    for (int move = 0; move < block.kind_size(); ++move) {
      const render::Point end = {block.tip_mm(3 * move), block.tip_mm(3 * move + 1),
                                 block.tip_mm(3 * move + 2)};
      const std::uint8_t path_class = ClassOf(block, move);
      const std::int32_t pass = block.pass_index_size() > 0 ? block.pass_index(move) : -1;
      const auto add = [&](const render::Point& tip) {
        path.points.push_back({tip, path_class, kAlways});
        passes.push_back(pass);
      };
      if (block.arc_plane(move) != v1::ARC_PLANE_UNSPECIFIED) {
        const Arc arc = ArcOf(block, move, arcs++);
        if (!path.points.empty()) {
          const render::Point start = path.points.back().tip;
          const int chords = ChordsOf(arc, start, chord_mm);
          for (int k = 1; k < chords; ++k) add(OnArc(arc, start, end, static_cast<double>(k) / chords));
        }
      }
      add(end);
    }
  }

  std::size_t pass_count = 0;
  for (std::size_t k = 1; k < passes.size(); ++k)
    if (passes[k] >= 0 && passes[k] != passes[k - 1]) ++pass_count;
  Ranks ranks(pass_count * kLongPass < path.points.size());
  std::vector<double> lengths(kClasses, 0.0);
  std::size_t joints = 1;  // first point of the moves between passes
  for (std::size_t k = 1; k < path.points.size(); ++k) {
    PathPoint& point = path.points[k];
    const render::Point& from = path.points[k - 1].tip;
    lengths[point.path_class] += Length(from, point.tip);
    if (point.path_class < kCutOfNoPass || passes[k] < 0) continue;
    point.rank = ranks.Next(point.path_class, passes[k], from, point.tip);
    for (; joints < k; ++joints)
      if (IsJoint(path.points[joints].path_class)) path.points[joints].rank = point.rank;
    joints = k + 1;
  }
  path.spacing_mm.assign(kClasses, std::numeric_limits<double>::infinity());
  for (std::size_t k = kCutOfNoPass; k < kClasses; ++k)
    if (lengths[k] > 0.0) path.spacing_mm[k] = area_mm2 / lengths[k];
  return path;
}

std::vector<std::uint8_t> LeastRanks(const PicturePath& path, double pixel_mm) {
  std::vector<std::uint8_t> least(kClasses, 0);
  for (std::size_t k = kCutOfNoPass; k < kClasses; ++k) {
    const double px = path.spacing_mm[k] / pixel_mm;
    if (px < kRoomPx)
      least[k] =
          static_cast<std::uint8_t>(std::min(30.0, std::ceil(std::log2(kRoomPx / std::max(px, 1e-9)))));
    least[kLead] = least[kLink] = std::max(least[kLead], least[k]);
  }
  return least;
}

render::Rgb PathColor(std::uint8_t path_class) {
  // The light theme of clients/viewer/src/themes.ts.
  static constexpr std::array<const char*, kClasses> kColors = {"#d03b4b", "#2d9150", "#0c93a6", "#8450c4",
                                                                "#1f5fbf", "#1f5fbf", "#0a6f55", "#b35309",
                                                                "#a5146c", "#6b6a00"};
  return render::FromHex(kColors[std::min<std::size_t>(path_class, kClasses - 1)]);
}

std::string PathName(std::uint8_t path_class) {
  static constexpr std::array<const char*, kFirstPass> kNames = {"rapids", "approach and retract", "leads",
                                                                 "links", "feed moves"};
  if (path_class < kFirstPass) return kNames[path_class];
  const auto pass = std::min<std::size_t>(path_class - kFirstPass, kPassNames.size() - 1);
  return std::string(kPassNames[pass]) + " passes";
}

}  // namespace patchmill::cli
