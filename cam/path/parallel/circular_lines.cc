#include "cam/path/parallel/circular_lines.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

// Flat step-overs looked at beyond one full turn: more than a line overruns what is wanted.
constexpr double kOverlap = 6.0;
constexpr double kWhole = 1e-9;  // mm: a turn is whole up to this

}  // namespace

FrameExtent ExtentOfCircles(const CircularLines& around, double margin, double flat) {
  const Interval y{std::max(around.inner - margin, 0.25 * flat), around.outer + margin};
  const double once = LineFrame::Around(around.center, y.end).period();
  return {{0.0, once + std::min(once, kOverlap * flat * y.end / y.begin)}, y};
}

std::vector<Interval> RemoveOverlapTurn(const std::vector<Interval>& keep, const Interval& looked,
                                        double once) {
  std::vector<Interval> rest;
  if (looked.end - looked.begin <= once + kWhole) {
    for (const Interval& i : keep) {
      if (i.end - i.begin >= once - kWhole) return {{0.0, once}};
      rest.push_back(i);
    }
    return rest;
  }
  std::vector<Interval> twice = keep;
  for (const Interval& i : keep) twice.push_back({i.begin + once, i.end + once});
  twice = Union(std::move(twice), 0.0);
  for (const Interval& i : twice) {
    if (i.end - i.begin >= once) return {{0.0, once}};
    if (i.begin >= looked.end - once && i.begin < looked.end) rest.push_back(i);
  }
  // A beginning is found twice, at places that differ a little. If these lie on both sides of a limit, both
  // are in the list.
  while (rest.size() > 1 && rest.back().end - once >= rest.front().end) rest.erase(rest.begin());
  return rest;
}

std::vector<Vec2> ArcPlaces(const LineFrame& frame, double y, const Interval& t, double sagitta) {
  const double length = t.end - t.begin, turn = 2.0 * kPi * length / frame.period();
  const double most = 2.0 * std::acos(std::clamp(1.0 - sagitta / y, 0.5, 1.0));
  const int count = std::max(1, static_cast<int>(std::ceil(turn / most)));
  std::vector<Vec2> places;
  for (int i = 0; i <= count; ++i)
    places.push_back(frame.At(i == count ? t.end : t.begin + length * i / count, y));
  if (length >= frame.period() - kWhole) places.back() = places.front();
  return places;
}

bool CloseAround(double certificate_gap, std::vector<ScanRun>& runs) {
  if (runs.empty()) return false;
  CutterPoint &first = runs.front().points.front(), &last = runs.back().points.back();
  const Vec3 step = last.center - first.center;  // the same place, each height certified to its own gap
  if (step.norm() > 1e-9 + certificate_gap) return false;
  if (step.z() > 0.0) first = last;
  if (runs.size() == 1) {
    const bool closed = runs.front().points.size() > 3;
    if (closed) runs.front().points.pop_back();
    return closed;
  }
  last = first;
  std::vector<CutterPoint>& points = runs.back().points;
  points.insert(points.end(), runs.front().points.begin() + 1, runs.front().points.end());
  runs.erase(runs.begin());
  return false;
}

}  // namespace patchmill
