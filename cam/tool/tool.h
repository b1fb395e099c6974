// The cutter, and how it is driven. Units: mm, mm/min, rpm.
#pragma once

#include <optional>
#include <string>
#include <variant>

namespace patchmill {

struct BallEnd {
  double radius = 3.0;  // mm, > 0
};
using Cutter = std::variant<BallEnd>;  // bull nose, flat and taper cutters will follow

enum class Coolant { kOff, kFlood, kMist, kAir };

struct Tool {
  int number = 1;
  std::string name;
  Cutter cutter = BallEnd{};
  std::optional<double> flute_length;    // mm
  std::optional<double> shank_diameter;  // mm; the verifier checks a wider one from flute_length up
  std::optional<double> stickout;        // mm
  double spindle_rpm = 0.0;
  double feed = 0.0;         // mm/min
  double plunge_feed = 0.0;  // mm/min
  Coolant coolant = Coolant::kOff;
};

inline double BallRadius(const Tool& tool) { return std::get<BallEnd>(tool.cutter).radius; }

}  // namespace patchmill
