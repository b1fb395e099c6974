// The cutter, and how it is driven. Units: mm, mm/min, rpm.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace patchmill {

struct BallEnd {
  double radius = 3.0;  // mm, > 0
};
using Cutter = std::variant<BallEnd>;  // bull nose, flat and taper cutters will follow

enum class Coolant { kOff, kFlood, kMist, kAir };

// A truncated cone of the holder, or a cylinder.
struct HolderSegment {
  double length = 0.0;                                // mm, > 0, along the axis
  double lower_diameter = 0.0, upper_diameter = 0.0;  // mm, > 0
};
inline constexpr double kDefaultHolderClearance = 0.5;  // mm
inline constexpr std::size_t kMaxHolderSegments = 100;

struct Tool {
  int number = 1;
  std::string name;
  Cutter cutter = BallEnd{};
  std::optional<double> flute_length;      // mm
  std::optional<double> shank_diameter;    // mm; the verifier checks a wider one from flute_length up
  std::optional<double> stickout;          // mm, from the tip to the holder
  std::vector<HolderSegment> holder = {};  // from below; needs `stickout`. Empty: unknown
  double holder_clearance = kDefaultHolderClearance;  // mm, kept around the holder and below it
  double spindle_rpm = 0.0;
  double feed = 0.0;         // mm/min
  double plunge_feed = 0.0;  // mm/min
  Coolant coolant = Coolant::kOff;
};

inline double BallRadius(const Tool& tool) { return std::get<BallEnd>(tool.cutter).radius; }

}  // namespace patchmill
