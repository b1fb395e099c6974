// Finds which parts of a zig-zag line are passes: those with a wanted contact (LineProbe::wanted), or with a
// wanted place within half a step along the line or across it. They end at open edges.
#pragma once

#include <vector>

#include "cam/path/parallel/line_probe.h"

namespace patchmill {

struct Interval {
  double begin = 0.0, end = 0.0;
};

struct ClippedLine {
  LineShape line;
  double rank = 0.0;              // order of the lines: rises with y; parts of one line have the same rank
  std::vector<Interval> keep;     // of t, disjoint, rising; ends on window or edge limits solved to 1e-9 mm
  std::vector<LineProbe> probes;  // the stations, rising in t; FillGap reads their needs
};

// Stations are at most about 0.6 flat step-overs apart in plan and 1.2 in space (where the curve is
// continuous).
ClippedLine ClipLine(const LineProber& prober, const LineShape& line, double rank, const Interval& range);

// Returns the sorted union. Intervals closer than `gap` are joined.
std::vector<Interval> Union(std::vector<Interval> intervals, double gap);

// Returns what lies in both. Both must be sorted and disjoint.
std::vector<Interval> Common(const std::vector<Interval>& a, const std::vector<Interval>& b);

}  // namespace patchmill
